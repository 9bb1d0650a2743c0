#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Pictures of what one sensor saw, without an extrinsic.

/// An image, at most 720 px wide; with the board's outline, if there is one.
cv::Mat DrawImage(const cv::Mat& image,
                  const std::optional<BoardPose>& board_camera,
                  const CameraModel& camera);

/// A sweep as the lidar sees it, all around or as far as it sees: azimuth to the left, elevation
/// upwards, coloured by range (RangeColourBgr); with the board's outline, if there is one.
cv::Mat DrawSweep(const PointCloud& sweep_lidar_m, const std::optional<BoardPose>& board_lidar);

/// The same from near, about that board.
cv::Mat DrawSweepNear(const PointCloud& sweep_lidar_m, const BoardPose& board_lidar);

}  // namespace voqcal
