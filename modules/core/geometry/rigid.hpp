#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace voqcal {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;  ///< Tangent order: [rotation_rad; translation_m].

/// The matrix with Skew(a) * b == a.cross(b).
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

/// Rotation by |omega_rad| about omega_rad (Rodrigues); exact to rounding also near zero.
Eigen::Matrix3d ExpSO3(const Eigen::Vector3d& omega_rad);

/// The rotation vector of R, length in [0, pi]. Inverse of ExpSO3.
Eigen::Vector3d LogSO3(const Eigen::Matrix3d& R);

/// The rotation matrix nearest to M in the Frobenius norm (SVD, det +1).
/// M of rank < 2 has no unique nearest rotation: the result is then a rotation, but an arbitrary
/// one.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& M);

/// Perturbs T_target_source on its left (target) side, rotation and translation apart:
///     R' = ExpSO3(delta.head<3>()) * R,   t' = t + delta.tail<3>()
/// Every covariance of a transform in voqcal is one of this delta.
Eigen::Isometry3d PerturbLeft(const Eigen::Isometry3d& T_target_source, const Vector6d& delta);

/// The delta with PerturbLeft(T_from, delta) == T_to.
Vector6d DifferenceLeft(const Eigen::Isometry3d& T_from, const Eigen::Isometry3d& T_to);

/// Angle between two directions of any non-zero length, radians in [0, pi], exact near 0 and pi.
double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Angle of the rotation that takes R_a to R_b, radians in [0, pi].
double RotationAngleBetween(const Eigen::Matrix3d& R_a, const Eigen::Matrix3d& R_b);

/// The rotation with the least sum of squared geodesic angles to `rotations` (Karcher mean).
/// @throws std::invalid_argument if `rotations` is empty.
Eigen::Matrix3d MeanRotation(const std::vector<Eigen::Matrix3d>& rotations);

}  // namespace voqcal
