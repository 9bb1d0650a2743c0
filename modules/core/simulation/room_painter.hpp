#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/camera/camera_model.hpp"
#include "core/simulation/pixel_rays.hpp"
#include "core/simulation/room.hpp"

namespace voqcal {

/// The empty room as the camera sees it.
struct RoomPicture {
  cv::Mat bgr;      ///< CV_32FC3, grey levels of 255.
  cv::Mat range_m;  ///< CV_32F: to the nearest of each pixel's corners.
};

/// Paints the room, anti-aliased: pixels whose corners differ, or may miss a thin line, are sampled
/// 4 x 4. Black where the lens model cannot be inverted.
RoomPicture PaintRoom(const Room& room,
                      const CameraModel& camera,
                      const PixelRays& rays,
                      const Eigen::Isometry3d& T_lidar_camera);

}  // namespace voqcal
