#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// What may be wrong beside the extrinsic, as parameters that are zero if it is not.
enum FaultParameter : int {
  kFocalScale,   ///< The true focal lengths are (1 + value) times those given...
  kFocalXScale,  ///< ...fx alone...
  kFocalYScale,  ///< ...fy alone.
  kPrincipalX,   ///< The true principal point lies so many pixels farther right...
  kPrincipalY,   ///< ...and farther down.
  kDistortion,   ///< The lens' first true coefficient is larger by value; the next four follow.
  kSquareScale = kDistortion + 5,  ///< The true squares are (1 + value) times as large as given.
  kPatternX,     ///< The true pattern lies so many metres farther along the board's x...
  kPatternY,     ///< ...and y.
  kRangeOffset,  ///< The lidar's ranges are too long by so many metres.
  /// All chessboards truly face so many radians farther than they are seen, about the camera's x
  /// (minus SharedErrors' chessboard_turn_x_rad)...
  kChessboardTurnX,
  kChessboardTurnY,  ///< ...and y.
  kNumFaultParameters
};

/// Kinds of residuals, each with a noise level of its own: where the two sensors see the board, and
/// how the camera's corners fit it.
enum ResidualKind : int {
  kAcross,  ///< Centre, across the camera's ray, metres.
  kAlong,   ///< Centre, along it, metres.
  kTilt,    ///< Normal, radians.
  kSpin,    ///< Turn in the board's plane, radians.
  kCorner,  ///< A corner's x or y from where the board's pose puts it, pixels.
  kNumResidualKinds
};

using FaultVector = Eigen::Matrix<double, kNumFaultParameters, 1>;

constexpr int kNumExtrinsicParameters = 6;  // [rotation_rad; translation_m], left (camera) side
constexpr int kNumModelParameters = kNumExtrinsicParameters + kNumFaultParameters;
using ModelVector = Eigen::Matrix<double, kNumModelParameters, 1>;
using ModelMatrix = Eigen::Matrix<double, kNumModelParameters, kNumModelParameters>;

/// What a chessboard's corners tell of the faults once its pose has followed them, to first order:
/// with pixel errors e(p, f) = e + J p + L f by the board's pose p and the faults f, the pose of
/// least squares is p = S f, S = -(J'J)^-1 J'L, which leaves P (e + L f), P = I - J (J'J)^-1 J'.
struct CornerTerms {
  int num_rows = 0;
  ModelMatrix information = ModelMatrix::Zero();  ///< (P L)' P L
  ModelVector pull = ModelVector::Zero();         ///< -(P L)' P e
  double squares = 0.0;                           ///< e' P e
};

/// How one sample's residual changes with everything that may be wrong, to first order about the
/// extrinsic: r(delta, fault) = r + J [delta; fault].
struct FaultEquation {
  std::int64_t sample_id = 0;
  Vector6d r = Vector6d::Zero();  ///< Across x, y; along; tilt x, y; spin.
  Eigen::Matrix<double, 6, kNumModelParameters> J =
      Eigen::Matrix<double, 6, kNumModelParameters>::Zero();
  CornerTerms corners;
};

ResidualKind KindOfRow(int row);

/// The camera that was given, as it truly is if it has these faults.
CameraModel CameraWith(const FaultVector& fault, const CameraModel& given);
/// The board.
BoardSpec BoardWith(const FaultVector& fault, const BoardSpec& given);

/// @param T_camera_lidar  near the truth: residuals are taken to be linear about it.
/// @return one equation a sample. Without corner pixels (features read from a table) the columns of
///     the faults of camera and pattern are zero: nothing can be said of them.
std::vector<FaultEquation> MakeFaultEquations(const std::vector<const BoardSample*>& samples,
                                              const BoardSpec& board,
                                              const CameraModel& camera,
                                              const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
