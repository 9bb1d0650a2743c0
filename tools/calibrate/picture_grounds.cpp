#include "calibrate/picture_grounds.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

/// The nearest whole number. What is almost beside the camera projects beyond any picture.
int ToInt(double coordinate) {
  constexpr double kFarOut = 1 << 26;
  return static_cast<int>(std::lround(std::clamp(coordinate, -kFarOut, kFarOut)));
}

cv::Mat Cut(const cv::Mat& image, const PictureView& view) {
  cv::Mat cut;
  const int method = view.scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC;
  const auto scaled = [&view](int px) { return std::max(1, ToInt(view.scale * px)); };
  cv::resize(image(view.part_px),
             cut,
             {scaled(view.part_px.width), scaled(view.part_px.height)},
             0,
             0,
             method);
  if (cut.channels() == 1) cv::cvtColor(cut, cut, cv::COLOR_GRAY2BGR);
  return cut;
}

/// The board with a margin.
PictureView NearView(const std::vector<Eigen::Vector2d>& outline_px, const cv::Size& image_size) {
  constexpr double kMargin = 0.25;  // of the board's size, on each side
  constexpr double kSizePx = 400;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& pixel_px : outline_px) box.extend(pixel_px);
  const double side_px = (1 + 2 * kMargin) * box.sizes().maxCoeff();
  const Eigen::Vector2d corner_px = box.center() - Eigen::Vector2d::Constant(side_px / 2);
  PictureView view;
  view.part_px =
      cv::Rect(ToInt(corner_px.x()), ToInt(corner_px.y()), ToInt(side_px), ToInt(side_px)) &
      cv::Rect({}, image_size);
  view.scale = kSizePx / side_px;
  return view;
}

}  // namespace

std::vector<Eigen::Vector2d> OutlinePx(const BoardPose& pose,
                                       const Eigen::Isometry3d& T_camera_sensor,
                                       const CameraModel& camera) {
  std::vector<Eigen::Vector3d> points_camera_m;
  for (const Eigen::Vector3d& corner_m : pose.corners_m) {
    points_camera_m.push_back(T_camera_sensor * corner_m);
  }
  points_camera_m.push_back(T_camera_sensor * pose.centre_m);
  std::vector<Eigen::Vector2d> pixels_px;
  for (const Eigen::Vector3d& point_camera_m : points_camera_m) {
    if (!camera.IsInFront(point_camera_m)) return {};
    pixels_px.push_back(camera.Project<double>(point_camera_m));
  }
  return pixels_px;
}

PictureGrounds GroundsOf(const BoardSample& sample,
                         const cv::Mat& image,
                         const CameraModel& camera) {
  constexpr double kMaxWidthPx = 720;
  PictureGrounds grounds;
  grounds.scene_view = {cv::Rect({}, image.size()), std::min(1.0, kMaxWidthPx / image.cols)};
  grounds.scene = Cut(image, grounds.scene_view);
  grounds.by_camera_px = OutlinePx(sample.camera.pose, Eigen::Isometry3d::Identity(), camera);
  if (grounds.by_camera_px.empty()) return grounds;
  grounds.board_view = NearView(grounds.by_camera_px, image.size());
  if (!grounds.board_view.part_px.empty()) grounds.board = Cut(image, grounds.board_view);
  return grounds;
}

void KeptGrounds::Add(const BoardSample& sample, const cv::Mat& image) {
  PictureGrounds grounds = GroundsOf(sample, image, camera_);
  const std::lock_guard<std::mutex> lock(adding_);
  grounds_[{sample.id, sample.utime}] = std::move(grounds);
}

const PictureGrounds* KeptGrounds::Of(const BoardSample& sample) const {
  const auto found = grounds_.find({sample.id, sample.utime});
  return found == grounds_.end() ? nullptr : &found->second;
}

}  // namespace voqcal
