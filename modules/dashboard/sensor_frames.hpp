#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"
#include "dashboard/slot.hpp"
#include "rig/dashboard_options.hpp"
#include "voqcal/image_t.hpp"

namespace voqcal {

/// An image as the page gets it.
struct PageImage {
  std::int64_t utime = 0;
  int width_px = 0;  ///< Of the original...
  int height_px = 0;
  std::string type;   ///< "image/jpeg" or "image/png".
  std::string bytes;  ///< ...which may be larger than these.
};

/// A JPEG or PNG that is small enough as it came, anything else halved until it fits and as JPEG.
/// @throws std::runtime_error if it contradicts itself (RequireSound) or cannot be decoded.
PageImage ForPage(const image_t& image, const DashboardOptions& options);

/// The image with the board that was found in it and nowhere else.
/// @param board_json  CameraBoardJson of this very image; empty: none is known.
FramePtr ImageFrame(const PageImage& image, const std::string& board_json);

/// A sweep for the page, thinned evenly over its scan lines, and where its points fall in the
/// image: of the points that PixelsInSight says it shows.
///
/// Payload: n x (x, y, z) as int16, in units of the header's scale_m, in the lidar frame; then, if
/// `T_camera_lidar` is known, n x (u, v) as int16, pixels of the original image, or -32768 twice
/// for a point that the camera does not see.
FramePtr CloudFrame(const PointCloud& cloud_lidar_m,
                    std::int64_t utime,
                    const std::optional<Eigen::Isometry3d>& T_camera_lidar,
                    const CameraModel& camera,
                    const DashboardOptions& options);

}  // namespace voqcal
