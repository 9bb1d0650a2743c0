#pragma once

#include <filesystem>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "calibrate/offline_run.hpp"
#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// What both sensors saw of a sample.
struct PosePicture {
  const BoardSample& sample;
  const cv::Mat& image;  ///< 8-bit, 1 or 3 channels (BGR).
  const PointCloud& sweep_lidar_m;
};

/// The whole image at most 720 px wide, the sweep's points on it.
cv::Mat DrawScene(const PosePicture& scene,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar);

/// The board from near: the sweep's points on it, its outline by the camera (green, centre +) and
/// by the lidar (magenta, centre x).
cv::Mat DrawBoard(const PosePicture& scene,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar);

/// Points are coloured by their range, from kNearRangeM (red) to kFarRangeM (blue) on a logarithmic
/// scale (OpenCV's "turbo"), the way and as far as on the dashboard's page.
inline constexpr double kNearRangeM = 1.0;
inline constexpr double kFarRangeM = 30.0;
cv::Vec3b RangeColourBgr(double range_m);

/// Writes the pictures of every sample whose scene is in samples.lcm: NNNN_scene.jpg (by the
/// refined extrinsic), NNNN_before.jpg and NNNN_after.jpg (the board by the average and by the
/// refined one); NNNN is the sample's id. Of the used one of median range besides
/// (MedianRangeScene): NNNN_coloured.jpg, its points in the image's colours, and
/// NNNN_coloured_by_turned.jpg, the same by an extrinsic that is turned by 3 degrees.
/// @throws std::runtime_error naming the file and the cause.
void WriteOverlays(const Rig& rig,
                   const OfflineRun& run,
                   const std::filesystem::path& samples_log,
                   const std::filesystem::path& folder);

}  // namespace voqcal
