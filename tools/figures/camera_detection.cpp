// Where the camera board detector finds the board, beside OpenCV's two finders on the same images,
// and how well its covariance tells its error.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/utility.hpp>

#include "core/camera_detection/calibration_target.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "figures/figures.hpp"
#include "files/atomic_file.hpp"
#include "images/png.hpp"
#include "support/camera_scenes.hpp"

namespace voqcal {
namespace {

struct Flags {
  std::string pattern = "chessboard";
  std::uint32_t seed = 1;
  int num_images = 20;
  bool is_ours_alone = false;
  std::string folder;
};

// The same plate with each pattern; cells of markers and tags are equally large.
BoardSpec BoardWith(const std::string& pattern) {
  BoardSpec board = test::TestBoard();
  board.pattern_offset_x_m = 0;  // else a board held upside down would be off by twice this
  board.pattern = pattern;
  board.marker_m = 0.07;  // of charuco
  if (pattern == "aprilgrid") {
    board.num_corners_x = 2 * 4;
    board.num_corners_y = 2 * 6;
    board.square_m = 0.1;
    board.gap_squares = 0.3;
  }
  return board;
}

using Finder = bool (*)(const cv::Mat&, const cv::Size&, std::vector<cv::Point2f>*);

bool FindSb(const cv::Mat& image, const cv::Size& pattern, std::vector<cv::Point2f>* corners) {
  return cv::findChessboardCornersSB(image, pattern, *corners);
}
bool FindClassic(const cv::Mat& image, const cv::Size& pattern, std::vector<cv::Point2f>* corners) {
  return cv::findChessboardCorners(image, pattern, *corners);
}

std::vector<Eigen::Vector2d> CornersBy(Finder find, const cv::Mat& image, const BoardSpec& board) {
  std::vector<cv::Point2f> corners;
  if (!find(image, {board.num_corners_x, board.num_corners_y}, &corners)) return {};
  std::vector<Eigen::Vector2d> corners_px;
  for (const cv::Point2f& corner : corners) corners_px.emplace_back(corner.x, corner.y);
  return corners_px;
}

// Of all images of one kind.
struct Tally {
  int num_images = 0;
  int num_ours = 0;
  int num_sb = 0;
  int num_classic = 0;
  int num_only_theirs = 0;
  int num_wrong = 0;  // ours, but not where the board is
  std::vector<double> seen_shares;
  std::vector<double> squared_errors_px2;
  std::vector<double> errors_m;
  std::vector<double> errors_rad;
  std::vector<double> nees;
};

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<Eigen::Vector2d> TrueCorners(const CameraModel& camera,
                                         const BoardSpec& board,
                                         const Eigen::Isometry3d& T_camera_board) {
  std::vector<Eigen::Vector2d> corners_px;
  for (const Eigen::Vector3d& point_m : board.InnerCornersBoardM()) {
    corners_px.push_back(camera.Project(T_camera_board * point_m));
  }
  return corners_px;
}

// Of the corners seen: how far they are from those of the same number.
std::vector<double> SquaredErrors(const std::vector<Eigen::Vector2d>& found_px,
                                  const std::vector<Eigen::Vector2d>& truth_px) {
  std::vector<double> errors_px2;
  for (std::size_t k = 0; k < truth_px.size(); ++k) {
    if (found_px[k].allFinite()) errors_px2.push_back((found_px[k] - truth_px[k]).squaredNorm());
  }
  return errors_px2;
}

// The same for the half-turn that fits better, where the pattern has one.
std::vector<double> SquaredErrors(const CameraBoard& found,
                                  const CameraModel& camera,
                                  const BoardSpec& board,
                                  const Eigen::Isometry3d& T_camera_board) {
  std::vector<Eigen::Vector2d> truth_px = TrueCorners(camera, board, T_camera_board);
  std::vector<double> same = SquaredErrors(found.corners_px, truth_px);
  if (!TargetOf(board).has_half_turn(board)) return same;
  std::reverse(truth_px.begin(), truth_px.end());
  std::vector<double> turned = SquaredErrors(found.corners_px, truth_px);
  return Mean(same) < Mean(turned) ? same : turned;
}

// As test::AreTheCorners has it.
double MaxErrorPx(const CameraModel& camera,
                  const BoardSpec& board,
                  const Eigen::Isometry3d& T_camera_board) {
  const std::vector<Eigen::Vector2d> truth_px = TrueCorners(camera, board, T_camera_board);
  return std::max(1.0, 0.25 * (truth_px[1] - truth_px[0]).norm());
}

bool AreAllBelow(double max_px, const std::vector<double>& errors_px2) {
  return !errors_px2.empty() &&
         *std::max_element(errors_px2.begin(), errors_px2.end()) < max_px * max_px;
}

// Normalised squared error over its 6 dimensions, of the nearer half-turn.
double Nees(const CameraBoard& found, const Eigen::Isometry3d& T_truth, Vector6d* error) {
  const Eigen::Isometry3d T_same = TransformFromPose(found.pose);
  const Eigen::Isometry3d T_turned = TransformFromPose(TurnedByHalf(found.pose));
  const Vector6d same = DifferenceLeft(T_same, T_truth);
  const Vector6d turned = DifferenceLeft(T_turned, T_truth);
  *error = same.norm() < turned.norm() ? same : turned;
  return error->dot(found.pose.covariance.ldlt().solve(*error)) / 6;
}

void Count(const test::CameraScene& scene,
           const CameraModel& camera,
           const BoardSpec& board,
           const std::string& label,
           bool is_ours_alone,
           Tally* tally) {
  const auto is_right = [&](const std::vector<Eigen::Vector2d>& corners_px) {
    return test::AreTheCorners(corners_px, camera, board, scene.T_camera_board);
  };
  const auto found = DetectCameraBoard(scene.image, camera, board, CameraBoardOptions{});
  const std::vector<double> errors_px2 =
      found ? SquaredErrors(*found, camera, board, scene.T_camera_board) : std::vector<double>();
  const bool is_ours = AreAllBelow(MaxErrorPx(camera, board, scene.T_camera_board), errors_px2);
  const bool is_sb = !is_ours_alone && is_right(CornersBy(FindSb, scene.image, board));
  const bool is_classic = !is_ours_alone && is_right(CornersBy(FindClassic, scene.image, board));
  ++tally->num_images;
  tally->num_ours += is_ours;
  tally->num_sb += is_sb;
  tally->num_classic += is_classic;
  tally->num_wrong += found && !is_ours;
  if (!is_ours && (is_sb || is_classic)) {
    ++tally->num_only_theirs;
    std::printf("  only OpenCV: %s: %s: %s\n",
                label.c_str(),
                found ? "wrong corners" : ToString(found.error().fault).c_str(),
                found ? "" : found.error().detail.c_str());
  }
  if (!is_ours) return;
  tally->seen_shares.push_back(static_cast<double>(errors_px2.size()) /
                               static_cast<double>(found->corners_px.size()));
  tally->squared_errors_px2.push_back(Mean(errors_px2));
  Vector6d error;
  tally->nees.push_back(Nees(*found, scene.T_camera_board, &error));
  tally->errors_rad.push_back(error.head<3>().norm());
  tally->errors_m.push_back(error.tail<3>().norm());
}

void PrintHeader() {
  std::printf("%-14s %6s %6s %6s %7s %12s %6s %7s %9s %10s %10s %6s\n",
              "images",
              "number",
              "ours",
              "SB",
              "classic",
              "only OpenCV",
              "wrong",
              "seen %",
              "corner px",
              "centre mm",
              "angle deg",
              "NEES");
}

void Print(const std::string& kind, bool is_ours_alone, const Tally& tally) {
  const auto theirs = [is_ours_alone](int num) {
    return is_ours_alone ? std::string("-") : std::to_string(num);
  };
  std::printf("%-14s %6d %6d %6s %7s %12s %6d %7.1f %9.3f %10.2f %10.3f %6.2f\n",
              kind.c_str(),
              tally.num_images,
              tally.num_ours,
              theirs(tally.num_sb).c_str(),
              theirs(tally.num_classic).c_str(),
              theirs(tally.num_only_theirs).c_str(),
              tally.num_wrong,
              100 * Mean(tally.seen_shares),
              std::sqrt(Mean(tally.squared_errors_px2)),
              1e3 * Mean(tally.errors_m),
              Mean(tally.errors_rad) * 180 / M_PI,
              Mean(tally.nees));
  std::fflush(stdout);
}

void Rendered(const Flags& flags) {
  const BoardSpec board = BoardWith(flags.pattern);
  const bool is_ours_alone = flags.is_ours_alone || flags.pattern != "chessboard";
  const CameraModel camera = test::TestCamera();
  PrintHeader();
  for (const std::string& kind : test::kCameraSceneKinds) {
    Tally tally;
    for (int i = 0; i < flags.num_images; ++i) {
      const std::uint32_t seed = flags.seed + static_cast<std::uint32_t>(i);
      Count(test::MakeCameraScene(kind, camera, board, seed),
            camera,
            board,
            kind + ", seed " + std::to_string(seed),
            is_ours_alone,
            &tally);
    }
    Print(kind, is_ours_alone, tally);
  }
}

// Where the board truly is in a real image nobody knows: that a finder found one must do.
void Real(const std::string& folder) {
  const BoardSpec board = test::TestBoard();
  int num_images = 0, num_ours = 0, num_sb = 0, num_classic = 0, num_only_theirs = 0;
  std::vector<std::string> files;
  cv::glob(folder + "/*.png", files);
  for (const std::string& file : files) {
    const std::string text = ReadWholeFile(file);
    const cv::Mat image = DecodePng({text.begin(), text.end()});
    const bool is_ours = DetectCameraBoard(image, test::TestCamera(), board, {}).has_value();
    const bool is_sb = !CornersBy(FindSb, image, board).empty();
    const bool is_classic = !CornersBy(FindClassic, image, board).empty();
    ++num_images;
    num_ours += is_ours;
    num_sb += is_sb;
    num_classic += is_classic;
    num_only_theirs += !is_ours && (is_sb || is_classic);
  }
  std::printf("%-14s %6d %6d %6d %7d %12d\n",
              "real session",
              num_images,
              num_ours,
              num_sb,
              num_classic,
              num_only_theirs);
}

}  // namespace

void AddCameraDetection(CLI::App* app) {
  const auto flags = std::make_shared<Flags>();
  CLI::App* figure =
      app->add_subcommand("camera-detection",
                          "Boards found by ours, cv::findChessboardCornersSB and "
                          "cv::findChessboardCorners (asked: none "
                          "that only they find); pose error and NEES (asked: 0.8 to 1.2)");
  figure->add_option("--pattern", flags->pattern, "Printed on the plate of the rendered images")
      ->check(CLI::IsMember({"chessboard", "charuco", "aprilgrid"}))
      ->capture_default_str();
  figure->add_option("--seed", flags->seed, "Of the first image of each kind")
      ->capture_default_str();
  figure->add_option("--images", flags->num_images, "Rendered images of each kind")
      ->capture_default_str();
  figure->add_flag("--ours-alone",
                   flags->is_ours_alone,
                   "Without OpenCV's finders on the rendered images, which take seconds for some");
  figure->add_option("--folder", flags->folder, "Images of the real session (acfr-vlp16/images)")
      ->check(CLI::ExistingDirectory);
  figure->callback([flags] {
    cv::setNumThreads(1);
    Rendered(*flags);
    if (!flags->folder.empty()) Real(flags->folder);
  });
}

}  // namespace voqcal
