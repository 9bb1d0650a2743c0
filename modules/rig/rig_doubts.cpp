#include "rig/rig_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <system_error>

#include "core/camera_detection/calibration_target.hpp"
#include "core/format.hpp"
#include "rig/default_rig.hpp"
#include "rig/frame_folder.hpp"
#include "rig/frame_pairing.hpp"
#include "rig/listening_address.hpp"

namespace voqcal {
namespace {

using Lines = std::vector<std::string>;

void Append(const Lines& more, Lines* lines) {
  lines->insert(lines->end(), more.begin(), more.end());
}

// ---- The board ----

/// What would make a length one between the limits.
std::string OtherUnit(double value, double min_m, double max_m) {
  const auto fits = [&](double value_m) { return value_m >= min_m && value_m <= max_m; };
  if (fits(value / 1000)) return Format(": in millimetres? Then give %.6g", value / 1000);
  if (fits(value / 100)) return Format(": in centimetres? Then give %.6g", value / 100);
  return ": measure it, and give metres";
}

void DoubtLength(const char* key, double value_m, double min_m, double max_m, Lines* lines) {
  if (value_m >= min_m && value_m <= max_m) return;
  lines->push_back(Format("board.%s is %.6g: it is in metres, and usually %.4g to %.4g",
                          key,
                          value_m,
                          min_m,
                          max_m) +
                   OtherUnit(value_m, min_m, max_m));
}

/// How far the pattern sticks out of the plate along an axis; negative if it does not.
double Excess(const std::vector<double>& lines_m, double plate_m) {
  return std::max(-lines_m.front(), lines_m.back()) - plate_m / 2;
}

bool IsPatternOnPlate(const BoardSpec& board) {
  constexpr double kRoundingM = 0.001;
  const PrintedPattern printed = TargetOf(board).print(board);
  return Excess(printed.x_lines_m, board.width_m) < kRoundingM &&
         Excess(printed.y_lines_m, board.height_m) < kRoundingM;
}

std::string WhyTooLarge(BoardSpec board) {
  board.pattern_offset_x_m = board.pattern_offset_y_m = 0;
  if (IsPatternOnPlate(board)) return "are pattern_offset_x_m and _y_m right?";
  std::swap(board.width_m, board.height_m);
  if (IsPatternOnPlate(board)) return "are x and y (or width_m and height_m) swapped?";
  return "are corners counted, not squares (tags, of a grid of tags), and is " + SideKeyOf(board) +
         " right?";
}

void DoubtPattern(const BoardSpec& board, Lines* lines) {
  if (IsPatternOnPlate(board)) return;
  const PrintedPattern printed = TargetOf(board).print(board);
  const auto span_m = [](const std::vector<double>& at_m) { return at_m.back() - at_m.front(); };
  lines->push_back(
      Format("board.%s is %.6g: the pattern, %.4g x %.4g m, sticks out of the board, %.4g x "
             "%.4g m (width x height): ",
             SideKeyOf(board).c_str(),
             board.square_m,
             span_m(printed.x_lines_m),
             span_m(printed.y_lines_m),
             board.width_m,
             board.height_m) +
      WhyTooLarge(board));
}

// ---- The camera ----

void DoubtFocalLength(const char* key, double value_px, double image_px, Lines* lines) {
  const double share = value_px / image_px;
  if (share >= 0.1 && share <= 10) return;
  lines->push_back(
      Format("camera.%s is %.6g: it is in pixels, and usually 0.1 to 10 times the "
             "image's side (%g px): in millimetres, or of another image size?",
             key,
             value_px,
             image_px));
}

void DoubtAspect(const CameraModel& camera, Lines* lines) {
  const double ratio = camera.fy_px / camera.fx_px;
  if (ratio > 0.95 && ratio < 1.05) return;
  lines->push_back(
      Format("camera.fy_px is %.6g, %.3g times fx_px (%.6g): pixels are square in "
             "nearly every camera: is one of the two mistyped?",
             camera.fy_px,
             ratio,
             camera.fx_px));
}

bool IsNearMiddle(double centre_px, int side_px, double share) {
  return std::abs(centre_px / side_px - 0.5) < share;
}

/// What would put the principal point near the middle of the image.
std::string WhyOffCentre(const CameraModel& camera) {
  constexpr double kNear = 0.1;
  if (IsNearMiddle(camera.cy_px, camera.width_px, kNear) &&
      IsNearMiddle(camera.cx_px, camera.height_px, kNear)) {
    return "are cx_px and cy_px swapped, or width_px and height_px?";
  }
  const double scale_x = 2 * camera.cx_px / camera.width_px;
  const double scale_y = 2 * camera.cy_px / camera.height_px;
  if (scale_x > 0 && std::abs(scale_y / scale_x - 1) < 0.1) {
    return Format(
        "they fit an image of about %.0f x %.0f px. Look at an image: if it has that size, "
        "width_px and height_px are wrong; else scale all four intrinsics to this size",
        2 * camera.cx_px,
        2 * camera.cy_px);
  }
  return "a typing error, or an image that was cropped?";
}

void DoubtPrincipalPoint(const CameraModel& camera, Lines* lines) {
  constexpr double kFar = 0.2;
  if (IsNearMiddle(camera.cx_px, camera.width_px, kFar) &&
      IsNearMiddle(camera.cy_px, camera.height_px, kFar)) {
    return;
  }
  lines->push_back(Format("camera.cx_px, cy_px are %.6g, %.6g: far from the middle of an image of "
                          "%d x %d px: ",
                          camera.cx_px,
                          camera.cy_px,
                          camera.width_px,
                          camera.height_px) +
                   WhyOffCentre(camera));
}

// Half way to the edges: true calibrations may turn back beyond their outermost corners.
void DoubtLens(const CameraModel& camera, Lines* lines) {
  const double x = (camera.width_px - 1) / 4.0;
  const double y = (camera.height_px - 1) / 4.0;
  const std::array<Eigen::Vector2d, 4> places_px = {Eigen::Vector2d(x, 2 * y),
                                                    Eigen::Vector2d(3 * x, 2 * y),
                                                    Eigen::Vector2d(2 * x, y),
                                                    Eigen::Vector2d(2 * x, 3 * y)};
  for (const Eigen::Vector2d& place_px : places_px) {
    if (camera.Unproject(place_px)) continue;
    lines->push_back(
        Format("camera.distortion: with these coefficients the lens does not even reach "
               "(%.0f, %.0f) px: are they another lens_model's, or in another order?",
               place_px.x(),
               place_px.y()));
    return;
  }
}

/// p1 and p2 are what a lens stands askew: small. Another model's k3 and k4 are not.
void DoubtTangential(const CameraModel& camera, Lines* lines) {
  constexpr double kMax = 0.03;
  if (camera.lens == LensModel::kEquidistant) return;
  const double p1 = camera.distortion[2];
  const double p2 = camera.distortion[3];
  if (std::abs(p1) <= kMax && std::abs(p2) <= kMax) return;
  lines->push_back(
      Format("camera.distortion: p1 and p2 (the third and fourth) are %.4g and %.4g, usually below "
             "%g: are these k1 k2 k3 k4 of an equidistant lens, or is it another order?",
             p1,
             p2,
             kMax));
}

/// Nobody's lens has the example's numbers and no distortion.
void DoubtExample(const CameraModel& camera, Lines* lines) {
  const CameraModel example = ExampleCamera();
  if (camera.width_px != example.width_px || camera.height_px != example.height_px ||
      camera.fx_px != example.fx_px || camera.fy_px != example.fy_px ||
      camera.cx_px != example.cx_px || camera.cy_px != example.cy_px ||
      camera.distortion != example.distortion) {
    return;
  }
  lines->push_back(
      "camera: is the example that check_rig --print-defaults gives: give your camera's numbers, "
      "or leave fx_px and the rest out and have them found by calibrate_lens");
}

void DoubtGuess(const Rig& rig, Lines* lines) {
  constexpr double kMaxM = 10;
  if (!rig.T_camera_lidar_guess) return;
  const double length_m = rig.T_camera_lidar_guess->translation().norm();
  if (length_m <= kMaxM) return;
  lines->push_back(
      Format("camera.T_camera_lidar_guess.translation_m puts the lidar %.4g m from the "
             "camera: it is in metres: in millimetres?",
             length_m));
}

// ---- The lidar's board ----

void DoubtRange(const Rig& rig, Lines* lines) {
  constexpr double kMaxM = 500;
  if (rig.lidar_board_detector.max_range_m <= kMaxM) return;
  lines->push_back(
      Format("lidar_board_detector.max_range_m is %.6g: it is in metres: in "
             "millimetres? Then give %.6g",
             rig.lidar_board_detector.max_range_m,
             rig.lidar_board_detector.max_range_m / 1000));
}

// ---- The drivers ----

void DoubtFile(const char* key, const std::filesystem::path& path, Lines* lines) {
  std::error_code unknown;
  if (path.empty() || std::filesystem::exists(path, unknown)) return;
  lines->push_back(std::string(key) + " is " + path.string() +
                   ": there is no such file (paths are relative to the rig file's folder)");
}

void DoubtFolder(const char* section,
                 const FrameOptions& options,
                 const Lines& endings,
                 Lines* lines) try {
  if (!options.folder.empty()) FrameFolder(options, endings);
} catch (const std::runtime_error& error) {
  lines->push_back(std::string(section) + ".folder: " + error.what() +
                   " (folders are relative to the rig file's own)");
}

void DoubtPairing(const Rig& rig, Lines* lines) try {
  PairingOfDrivers(rig);
} catch (const std::runtime_error& error) {
  lines->push_back(std::string("lidar_driver.folder, camera_driver.folder: ") + error.what());
}

void DoubtSensorFiles(const LidarSensorOptions& sensor, Lines* lines) {
  DoubtFile("lidar_driver.sensor.pcap", sensor.pcap, lines);
  DoubtFile("lidar_driver.sensor.calibration", sensor.calibration, lines);
  DoubtFile("lidar_driver.sensor.bias_from", sensor.bias_from, lines);
}

void DoubtAddress(const LidarSensorOptions& sensor, Lines* lines) {
  if (!sensor.pcap.empty()) return;
  const std::string doubt = AddressDoubt(sensor.address);
  if (!doubt.empty())
    lines->push_back("lidar_driver.sensor.address is " + sensor.address + ": " + doubt);
}

void DoubtVideo(const CameraDriverOptions& camera, Lines* lines) {
  DoubtFile("camera_driver.device", camera.device, lines);
  if (camera.url.find("://") == std::string::npos)
    DoubtFile("camera_driver.url", camera.url, lines);
}

}  // namespace

std::vector<std::string> BoardDoubts(const BoardSpec& board) {
  Lines lines;
  DoubtLength("width_m", board.width_m, 0.1, 5, &lines);
  DoubtLength("height_m", board.height_m, 0.1, 5, &lines);
  DoubtLength(SideKeyOf(board).c_str(), board.square_m, 0.01, 1, &lines);
  DoubtPattern(board, &lines);
  return lines;
}

std::vector<std::string> CameraDoubts(const CameraModel& camera) {
  Lines lines;
  DoubtFocalLength("fx_px", camera.fx_px, camera.width_px, &lines);
  DoubtFocalLength("fy_px", camera.fy_px, camera.height_px, &lines);
  DoubtAspect(camera, &lines);
  DoubtPrincipalPoint(camera, &lines);
  DoubtTangential(camera, &lines);
  DoubtExample(camera, &lines);
  if (lines.empty()) DoubtLens(camera, &lines);
  return lines;
}

std::vector<std::string> DriverDoubts(const Rig& rig) {
  const bool has_clouds = rig.lidar_driver.source == LidarDriverOptions::Source::kFolder;
  const bool has_images = rig.camera_driver.source == CameraDriverOptions::Source::kFolder;
  Lines lines;
  if (has_clouds) DoubtFolder("lidar_driver", rig.lidar_driver, kCloudEndings, &lines);
  if (has_images) DoubtFolder("camera_driver", rig.camera_driver, kImageEndings, &lines);
  if (lines.empty()) DoubtPairing(rig, &lines);
  if (rig.lidar_driver.source == LidarDriverOptions::Source::kSensor) {
    DoubtSensorFiles(rig.lidar_sensor, &lines);
    DoubtAddress(rig.lidar_sensor, &lines);
  }
  if (rig.camera_driver.source == CameraDriverOptions::Source::kVideo) {
    DoubtVideo(rig.camera_driver, &lines);
  }
  return lines;
}

std::vector<std::string> RigDoubts(const Rig& rig) {
  Lines lines = BoardDoubts(rig.board);
  Append(CameraDoubts(rig.camera), &lines);
  DoubtGuess(rig, &lines);
  DoubtRange(rig, &lines);
  Append(DriverDoubts(rig), &lines);
  return lines;
}

}  // namespace voqcal
