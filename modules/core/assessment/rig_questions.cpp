#include "core/assessment/rig_questions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/assessment/suspects.hpp"
#include "core/board/half_turn.hpp"
#include "core/format.hpp"

namespace voqcal {
namespace {

// The rig file, with something else in it.
RigQuestion AskAbout(const std::string& cause,
                     const std::string& claim,
                     const std::string& line,
                     const std::function<void(BoardSpec*, CameraModel*)>& change) {
  return {cause, claim, "give " + line + " in the rig file", [change](GivenSession* session) {
            change(&session->board, &session->camera);
            SeeBoardsAgain(session);
          }};
}

void AskAboutLens(const CameraModel& camera, std::vector<RigQuestion>* questions) {
  const auto& d = camera.distortion;
  const bool is_straight = std::all_of(d.begin(), d.end(), [](double k) { return k == 0.0; });
  const auto ask = [&](const char* cause, const char* claim, const CameraModel& other) {
    std::string line = DistortionLine(other);
    if (other.lens != camera.lens)
      line = "camera.lens_model: " + ToString(other.lens) + ", " + line;
    questions->push_back(
        AskAbout(cause, claim, line, [other](BoardSpec*, CameraModel* said) { *said = other; }));
  };
  CameraModel other = camera;
  other.lens =
      camera.lens == LensModel::kEquidistant ? LensModel::kPlumbBob : LensModel::kEquidistant;
  std::fill(other.distortion.begin() + 4, other.distortion.end(), 0.0);
  ask("lens model", "the lens follows another model", other);
  if (is_straight) return;
  other = camera;
  other.distortion = {};
  if (camera.lens == LensModel::kEquidistant) other.lens = LensModel::kPlumbBob;  // a pinhole
  ask("rectified images", "the images are rectified already", other);
  for (std::size_t i = 0; i < d.size(); ++i) other.distortion[i] = -d[i];
  ask("distortion", "the coefficients' signs are turned", other);
  if (camera.lens == LensModel::kEquidistant) return;
  other = camera;
  other.distortion = {d[0], d[1], d[3], d[4], d[2], d[5], d[6], d[7]};
  ask("distortion", "the coefficients are in another order, k1 k2 k3 p1 p2", other);
}

// Intrinsics go with one image size: their principal point is near its middle.
void AskAboutImageSize(const CameraModel& camera, std::vector<RigQuestion>* questions) {
  constexpr double kFarOff = 0.2;  // of the image's width, from its middle: no lens sits so askew
  constexpr std::array<double, 8> kScales = {0.25, 1.0 / 3, 0.5, 2.0 / 3, 1.5, 2.0, 3.0, 4.0};
  const double middle_px = 0.5 * (camera.width_px - 1);
  if (std::abs(camera.cx_px - middle_px) < kFarOff * camera.width_px) return;
  // A pixel's middle has whole coordinates: the image begins half a pixel before 0.
  const auto scaled = [](double px, double scale) { return scale * (px + 0.5) - 0.5; };
  const auto off = [&](double scale) { return std::abs(scaled(camera.cx_px, scale) - middle_px); };
  const double scale = *std::min_element(
      kScales.begin(), kScales.end(), [&](double a, double b) { return off(a) < off(b); });
  CameraModel other = camera;
  for (double* number : {&other.fx_px, &other.fy_px}) *number *= scale;
  for (double* number : {&other.cx_px, &other.cy_px}) *number = scaled(*number, scale);
  questions->push_back(AskAbout("image size",
                                "the intrinsics are those of images of another size",
                                Format("camera.fx_px: %g, fy_px: %g, cx_px: %g, cy_px: %g",
                                       other.fx_px,
                                       other.fy_px,
                                       other.cx_px,
                                       other.cy_px),
                                [other](BoardSpec*, CameraModel* said) { *said = other; }));
}

void AskAboutPattern(const BoardSpec& board, std::vector<RigQuestion>* questions) {
  const double x_m = board.pattern_offset_x_m;
  const double y_m = board.pattern_offset_y_m;
  for (const auto& [sign_x, sign_y] : {std::pair{-1, 1}, std::pair{1, -1}, std::pair{-1, -1}}) {
    if ((sign_x < 0 && x_m == 0.0) || (sign_y < 0 && y_m == 0.0)) continue;
    const double other_x_m = sign_x * x_m;
    const double other_y_m = sign_y * y_m;
    questions->push_back(AskAbout(
        "sign of the pattern offset",
        "the pattern lies to the other side of the plate's centre",
        Format("board.pattern_offset_x_m: %g, pattern_offset_y_m: %g", other_x_m, other_y_m),
        [=](BoardSpec* said, CameraModel*) {
          said->pattern_offset_x_m = other_x_m;
          said->pattern_offset_y_m = other_y_m;
        }));
  }
  if (IsSquare(board.width_m, board.height_m)) return;
  questions->push_back({"pattern across the plate",
                        "the pattern lies across the plate",
                        Format("swap board.num_corners_x and num_corners_y (%d and %d), or width_m "
                               "and height_m, in the rig file",
                               board.num_corners_x,
                               board.num_corners_y),
                        LayPatternAcross});
}

void AskAboutSensors(std::vector<RigQuestion>* questions) {
  questions->push_back(
      {"mirrored sensor",
       "one sensor's data are mirrored: only a reflection takes the lidar's boards "
       "to the camera's",
       "publish clouds in a right-handed frame (x forward, y left, z up) and images "
       "as they are seen",
       MirrorLidar});
  for (const int by : {1, -1}) {
    questions->push_back(
        {"shifted pairs",
         Format("each image fits the sweep of the pair %s it", by > 0 ? "after" : "before"),
         "check how images and sweeps are numbered or stamped",
         [by](GivenSession* session) { ShiftPairs(-by, session); }});
  }
}

void AskAboutSquares(const BoardSpec& board, std::vector<RigQuestion>* questions) {
  for (const double scale : {0.1, 10.0}) {
    const double square_m = scale * board.square_m;
    questions->push_back(
        AskAbout("board's squares",
                 "the squares' decimal point is off by one",
                 Format("board.square_m: %g", square_m),
                 [square_m](BoardSpec* said, CameraModel*) { said->square_m = square_m; }));
  }
}

}  // namespace

std::vector<RigQuestion> QuestionsAboutLens(const CameraModel& camera) {
  std::vector<RigQuestion> questions;
  AskAboutLens(camera, &questions);
  AskAboutImageSize(camera, &questions);
  return questions;
}

std::vector<RigQuestion> QuestionsAboutNumbers(const CameraModel& given,
                                               const CameraModel& fitted) {
  std::vector<RigQuestion> questions;
  const auto ask = [&](const char* cause,
                       const std::string& line,
                       const std::function<void(CameraModel*)>& take) {
    CameraModel other = given;
    take(&other);
    questions.push_back(AskAbout(cause,
                                 std::string("the ") + cause + " is wrong",
                                 "about " + line,
                                 [other](BoardSpec*, CameraModel* said) { *said = other; }));
  };
  ask("focal length fx", Format("camera.fx_px: %.0f", fitted.fx_px), [&](CameraModel* other) {
    other->fx_px = fitted.fx_px;
  });
  ask("focal length fy", Format("camera.fy_px: %.0f", fitted.fy_px), [&](CameraModel* other) {
    other->fy_px = fitted.fy_px;
  });
  ask("focal length",
      Format("camera.fx_px: %.0f, fy_px: %.0f", fitted.fx_px, fitted.fy_px),
      [&](CameraModel* other) {
        other->fx_px = fitted.fx_px;
        other->fy_px = fitted.fy_px;
      });
  ask("principal point",
      Format("camera.cx_px: %.0f, cy_px: %.0f", fitted.cx_px, fitted.cy_px),
      [&](CameraModel* other) {
        other->cx_px = fitted.cx_px;
        other->cy_px = fitted.cy_px;
      });
  ask("distortion", DistortionLine(fitted), [&](CameraModel* other) {
    other->distortion = fitted.distortion;
  });
  return questions;
}

RigQuestion QuestionAboutSquares(const BoardSpec& board, double scale) {
  const double square_m = scale * board.square_m;
  const auto change = [square_m](BoardSpec* said, CameraModel*) { said->square_m = square_m; };
  RigQuestion question = AskAbout("board's squares", "the squares' size is wrong", "", change);
  question.remedy = "give " + SquaresLine(square_m);
  return question;
}

std::vector<RigQuestion> QuestionsAbout(const BoardSpec& board, const CameraModel& camera) {
  std::vector<RigQuestion> questions = QuestionsAboutLens(camera);
  AskAboutPattern(board, &questions);
  AskAboutSquares(board, &questions);
  AskAboutSensors(&questions);
  return questions;
}

}  // namespace voqcal
