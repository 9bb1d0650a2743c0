#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Where the camera sees each point of a sweep; nothing where there is no return, outside of the
/// image, and where a nearer surface hides it.
///
/// A sweep shows a surface by points with gaps between them, as wide as its scan lines are apart:
/// hidden is what has nearer points on both sides, left and right or above and below. Nearer is by
/// more than 0.1 m and than 2 % of the range (5 % where the next points are 0.04 rad away): less is
/// noise, or the walls of a corner. So what is beside a surface is in sight, but for what is within
/// 0.01 rad of an upright or level edge.
std::vector<std::optional<Eigen::Vector2d>> PixelsInSight(const PointCloud& cloud_lidar_m,
                                                          const CameraModel& camera,
                                                          const Eigen::Isometry3d& T_camera_lidar);

/// A point that the camera sees, and the image's colour there.
struct ColouredPoint {
  Eigen::Vector3d position_lidar_m;
  cv::Vec3b colour_bgr;
};

/// The points in sight, in the order of the cloud.
///
/// @param image  the camera's whole image, at its size or another; 8-bit, BGR.
std::vector<ColouredPoint> PointsInColour(const PointCloud& cloud_lidar_m,
                                          const cv::Mat& image,
                                          const CameraModel& camera,
                                          const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
