#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "result/rig_extrinsics.hpp"

namespace voqcal {

/// The names that TreeText takes, in the order of its documentation.
const std::vector<std::string>& TreeFormats();

/// A rig's sensors as other programs take them, each by its name, as ExtrinsicText does it of one
/// pair.
///
/// - ros, ros2, ros1: a command line of tf2_ros' static_transform_publisher for each sensor but the
///   reference: its pose in the reference's frame.
/// - urdf: a whole robot: a link for each sensor, and a fixed joint from the reference to each.
/// - bot_frames: the coordinate_frames block; each frame is relative to the reference.
/// - kalibr: a camchain.yaml of the cameras; T_cn_cnm1 takes the coordinates of the camera before
///   to the camera's, T_cam_lidar those of the first lidar.
/// - json: each sensor's kind, its pose in the reference's frame as rig_extrinsics.yaml has it, and
///   a camera's lens as the rig file has it.
///
/// @param cameras  lenses by the cameras' names, for formats that have one.
/// @throws std::invalid_argument with one line that lists the formats, if `format` is none of them.
std::string TreeText(const std::string& format,
                     const SensorTree& tree,
                     const std::map<std::string, CameraModel>& cameras);

/// The cameras of the tree whose lens a camchain goes without: it is not among `cameras`, or Kalibr
/// has no such lens.
std::vector<std::string> CamerasWithoutKalibrLens(
    const SensorTree& tree, const std::map<std::string, CameraModel>& cameras);

}  // namespace voqcal
