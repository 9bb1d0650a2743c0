#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// What an exported transform is between. The parent is the lidar and the child the camera, unless
/// the kinds say otherwise.
struct ExportedExtrinsic {
  /// p_child = T_child_parent * p_parent, metres.
  Eigen::Isometry3d T_child_parent = Eigen::Isometry3d::Identity();
  std::string parent = "lidar";  ///< Name of the lidar's frame.
  std::string child = "camera";  ///< Name of the camera's optical frame.
  std::string parent_kind = "the lidar";
  std::string child_kind = "the camera's optical frame: x right, y down, z forward";
  std::optional<CameraModel> camera;  ///< For formats that carry the lens, and the example's pixel.

  /// One line for each name that some format could not carry; empty if all can.
  std::vector<std::string> Problems() const;
};

/// What the format needs and `extrinsic` has not (mrcal: a camera that is not a fisheye); empty if
/// it can carry it.
std::string FormatProblem(const std::string& format, const ExportedExtrinsic& extrinsic);

/// The names that ExtrinsicText takes, in the order of its documentation.
const std::vector<std::string>& ExportFormats();

/// The extrinsic as other programs take it, each number such that it reads back exactly. Comments
/// say which way round it is, with a point that can be checked by hand.
///
/// - ros, ros2, ros1: the command line of tf2_ros' static_transform_publisher: pose of the camera
///   in the lidar frame, quaternion x y z w. "ros" is the ROS 2 command with that of ROS 1 beside
///   it.
/// - urdf: a fixed joint; pose of the camera in the lidar frame, rpy about the fixed axes x, y, z.
/// - bot_frames: the coordinate_frames block of libbot2's bot_frames; takes the camera's
///   coordinates to the lidar's, quaternion w x y z.
/// - kalibr: an entry of a camchain.yaml; T_cam_lidar takes the lidar's coordinates to the
/// camera's.
/// - opencv: cv::FileStorage YAML; rvec and tvec as cv::projectPoints takes them with lidar points.
/// - autoware: an entry of sensor_kit_calibration.yaml; pose of the camera_link (x forward, y left,
///   z up), in which the optical frame stands turned by rpy -pi/2, 0, -pi/2 (REP 103).
/// - mrcal: a .cameramodel whose reference frame is the lidar's; rt_fromref.
///
/// @throws std::invalid_argument with one line that lists the formats, if `format` is none of them,
///     or with its FormatProblem.
std::string ExtrinsicText(const std::string& format, const ExportedExtrinsic& extrinsic);

/// Parts of these, for what holds several (tree_text.hpp).

/// A frame of the coordinate_frames block.
std::string BotFrame(const ExportedExtrinsic& extrinsic);
/// A camera's lens in a camchain; empty if Kalibr has no such lens.
std::string KalibrLens(const CameraModel& camera);
/// A 4x4 matrix in YAML, a line a row.
std::string ExactRows(const Eigen::Matrix4d& matrix, const std::string& indent);

}  // namespace voqcal
