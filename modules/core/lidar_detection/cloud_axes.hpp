#pragma once

#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// Axes that turn with the cloud: what is searched in them is found whatever frame the lidar's
/// driver uses. z is the direction that beams go in least, the axis of a spinning lidar; x is the
/// longer way of the scene across it; each points to where more of the returns are.
///
/// @return R_axes_lidar; the identity for fewer than three points.
Eigen::Matrix3d CloudAxes(const std::vector<Eigen::Vector3d>& points_lidar_m);

}  // namespace voqcal
