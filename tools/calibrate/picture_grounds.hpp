#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// A part of an image, scaled: pixel (0, 0) is the centre of the top-left pixel in both.
struct PictureView {
  cv::Rect part_px;
  double scale = 1.0;

  Eigen::Vector2d ToPicture(const Eigen::Vector2d& pixel_px) const {
    return {(pixel_px.x() - part_px.x + 0.5) * scale - 0.5,
            (pixel_px.y() - part_px.y + 0.5) * scale - 0.5};
  }
};

/// What a sample's pictures are drawn on.
struct PictureGrounds {
  PictureView scene_view;
  cv::Mat scene;  ///< The whole image, at most 720 px wide.
  PictureView board_view;
  cv::Mat board;                              ///< From near; empty if it does not show.
  std::vector<Eigen::Vector2d> by_camera_px;  ///< The board's corners and centre; empty likewise.
};

/// @param image  8-bit, 1 or 3 channels (BGR).
PictureGrounds GroundsOf(const BoardSample& sample,
                         const cv::Mat& image,
                         const CameraModel& camera);

/// The board's corners and centre in the image; nothing if one of them is not in front.
std::vector<Eigen::Vector2d> OutlinePx(const BoardPose& pose,
                                       const Eigen::Isometry3d& T_camera_sensor,
                                       const CameraModel& camera);

/// The grounds of a session's samples, 1.5 MB each: made while the image is decoded for its edges,
/// as to decode it again for the report takes as long as to draw on it.
class KeptGrounds {
 public:
  explicit KeptGrounds(const CameraModel& camera) : camera_(camera) {}

  /// May be called by several threads at once.
  void Add(const BoardSample& sample, const cv::Mat& image);
  /// Null if they were not added.
  const PictureGrounds* Of(const BoardSample& sample) const;

 private:
  CameraModel camera_;
  std::mutex adding_;
  std::map<std::pair<std::int64_t, std::int64_t>, PictureGrounds> grounds_;  // by id and utime
};

}  // namespace voqcal
