#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// How well an extrinsic puts the background's depth edges on edges of the images: the mean rank, 0
/// to 1, of the image's gradient under them. 0.5 is chance.
///
/// After Levinson and Thrun, Automatic Online Calibration of Cameras and Lasers (RSS 2013), which
/// scores depth edges on image edges; ranks instead of strengths let no single bright edge decide.
/// @return NaN if no edge lies in an image.
double MeanEdgeRank(const std::vector<SceneView>& views,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
