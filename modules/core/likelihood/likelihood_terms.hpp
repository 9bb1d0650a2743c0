#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/camera_faults.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix312d = Eigen::Matrix<double, 3, 12>;

/// Where the board and the lidar are while the likelihood is evaluated. Derivatives are by
/// [left perturbation of T_camera_lidar; of T_camera_board], 6 + 6, rotation_rad and translation_m.
struct BoardAndLidar {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
};

/// The range at which a ray of the lidar meets the board's plane:
///     range = n . (c - t) / n . v,     v = R u
/// with (R, t) = T_camera_lidar, c and n the board's centre and normal in the camera frame, u the
/// ray's unit direction in the lidar frame. `J` may be null.
double RangeToBoardM(const BoardAndLidar& at,
                     const Eigen::Vector3d& direction_lidar,
                     Vector12d* J_range);

/// The board's plane in the lidar frame, as the points p with a . p = 1: all that returns see of
/// the board and of the extrinsic, for a ray u meets it at the range 1 / (a . u).
///     a = R' n / (n . (c - t))
/// with the names of RangeToBoardM. `J` may be null.
Eigen::Vector3d PlaneInLidar(const BoardAndLidar& at, Matrix312d* J_plane);

/// What the outline in the lidar's sweep fixes whatever its ranges: the rays to the board's centre
/// and along its axes.
struct OutlineRays {
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();  ///< As the detector says.
  /// All sides were measured: such outlines alone tell how far the detector is to be trusted.
  bool is_whole = true;
  /// Of the residual [across_m (2); turn_rad]: the detector's, without model error. Open sides make
  /// it wide.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// @param pose_lidar  with the corners in the camera's order.
OutlineRays OutlineRaysOf(const BoardPose& pose_lidar);

/// How far the board is from where the outline's rays say:
///     across = B' (c + lift z),  turn = (m_x . x / m_x . y0 - m_y . y / m_y . x0) / 2
/// c, x, y: centre and axes of the board in the lidar frame by `at`; c0, x0, y0: the detector's; B:
/// two directions across c0; m_x = c0 x x0 and m_y = c0 x y0, normals of the planes in which the
/// rays hold the axes; z: the lidar's own, across its scan lines. `J` may be null.
Eigen::Vector3d OutlineResidual(const BoardAndLidar& at,
                                const OutlineRays& outline,
                                double lift_m,
                                Matrix312d* J_residual);

/// Its derivative by the lift.
Eigen::Vector3d OutlineByLift(const OutlineRays& outline);

/// One return on the board.
struct BoardReturn {
  Eigen::Vector3d direction_lidar = Eigen::Vector3d::UnitX();
  double range_m = 0.0;
  double shade = 0.0;    ///< ShadeScale's.
  std::size_t ring = 0;  ///< 0 if the cloud has none, or beyond kMaxRings.
};

/// All that one sample says.
struct LikelihoodPose {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();  ///< By the chessboard.
  Matrix6d covariance = Matrix6d::Zero();                            ///< Of it, left side.
  std::array<Eigen::Vector3d, 4> corners_camera_m;  ///< Of the outline, by the chessboard.
  OutlineRays outline;
  std::vector<BoardReturn> returns;
  CameraFaultTerms camera_faults;  ///< Those that are to be estimated; may be empty.
};

/// @param T_camera_lidar  resolves the board's half-turn.
LikelihoodPose MakeLikelihoodPose(const BoardSample& sample,
                                  const ShadeScale& shades,
                                  const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
