// Where the camera board detector finds the board, beside OpenCV's two finders on the same images,
// and how well its covariance tells its error.

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

#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "figures/figures.hpp"
#include "files/atomic_file.hpp"
#include "images/png.hpp"
#include "support/camera_scenes.hpp"

namespace voqcal {
namespace {

struct Flags {
  std::uint32_t seed = 1;
  int num_images = 20;
  bool is_ours_alone = false;
  std::string folder;
};

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
  std::vector<double> errors_m;
  std::vector<double> errors_rad;
  std::vector<double> nees;
};

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
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
  const bool is_ours = found && is_right(found->corners_px);
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
  Vector6d error;
  tally->nees.push_back(Nees(*found, scene.T_camera_board, &error));
  tally->errors_rad.push_back(error.head<3>().norm());
  tally->errors_m.push_back(error.tail<3>().norm());
}

void PrintHeader() {
  std::printf("%-14s %6s %6s %6s %7s %12s %6s %10s %10s %6s\n",
              "images",
              "number",
              "ours",
              "SB",
              "classic",
              "only OpenCV",
              "wrong",
              "centre mm",
              "angle deg",
              "NEES");
}

void Print(const std::string& kind, bool is_ours_alone, const Tally& tally) {
  const auto theirs = [is_ours_alone](int num) {
    return is_ours_alone ? std::string("-") : std::to_string(num);
  };
  std::printf("%-14s %6d %6d %6s %7s %12s %6d %10.2f %10.3f %6.2f\n",
              kind.c_str(),
              tally.num_images,
              tally.num_ours,
              theirs(tally.num_sb).c_str(),
              theirs(tally.num_classic).c_str(),
              theirs(tally.num_only_theirs).c_str(),
              tally.num_wrong,
              1e3 * Mean(tally.errors_m),
              Mean(tally.errors_rad) * 180 / M_PI,
              Mean(tally.nees));
  std::fflush(stdout);
}

void Rendered(const Flags& flags) {
  BoardSpec board = test::TestBoard();
  board.pattern_offset_x_m = 0;  // else a board held upside down would be off by twice this
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
            flags.is_ours_alone,
            &tally);
    }
    Print(kind, flags.is_ours_alone, tally);
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
