#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How two sensors of a rig stand to each other, as a calibration of the two says.
struct SensorPair {
  std::string from;
  std::string to;
  /// p_to = T_to_from * p_from, metres.
  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (side `to`).
  Matrix6d covariance = Matrix6d::Zero();
};

/// Whether it can be joined to others: it is finite, its covariance positive definite.
bool IsDefinite(const SensorPair& pair);

/// What a pair is called wherever it needs a name: its folder, its channels, its lines.
/// "front_left".
std::string PairName(const std::string& from, const std::string& to);

/// The same, seen from the other side.
SensorPair Reversed(const SensorPair& pair);

/// T_to_from of two sensors that stand in one reference frame, and how it moves with either:
///     T_to_from = T_reference_to^-1 T_reference_from
/// each perturbed on its own left.
struct RelativePose {
  RelativePose(const Eigen::Isometry3d& T_reference_from, const Eigen::Isometry3d& T_reference_to);

  Eigen::Isometry3d T_to_from;
  Matrix6d J_from;
  Matrix6d J_to;
};

}  // namespace voqcal
