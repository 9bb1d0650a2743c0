#pragma once

#include <array>
#include <string>
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
using NoiseLevels = std::array<double, kNumResidualKinds>;

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

/// @param T_camera_lidar  near the truth: residuals are taken to be linear about it.
/// @return one equation a sample. Without corner pixels (features read from a table) the columns of
///     the faults of camera and pattern are zero: nothing can be said of them.
std::vector<FaultEquation> MakeFaultEquations(const std::vector<const BoardSample*>& samples,
                                              const BoardSpec& board,
                                              const CameraModel& camera,
                                              const Eigen::Isometry3d& T_camera_lidar);

/// The extrinsic fitted together with some faults.
struct FaultFit {
  bool is_usable = false;                        ///< False if the samples leave a parameter open.
  ModelVector value = ModelVector::Zero();       ///< Zero where not fitted.
  ModelMatrix covariance = ModelMatrix::Zero();  ///< The same.
  NoiseLevels noise{};
  double log_likelihood = 0;              ///< With these noise levels, but for a constant.
  double mean_error_m = 0;                ///< Of the centres, in space.
  std::vector<double> held_out_errors_m;  ///< The same, each sample left out of the fit in turn.
  double mean_held_out_error_m = 0;

  std::array<double, kNumResidualKinds> squares{};  ///< Sums of squares by kind.

  double Value(FaultParameter fault) const { return value[kNumExtrinsicParameters + fault]; }
  double StandardError(FaultParameter fault) const;
  /// How the extrinsic moves for each unit that the fault is larger: the samples tell their sum.
  Vector6d ExtrinsicBy(FaultParameter fault) const;
};

/// The camera that was given, as `fit` says that it truly is.
CameraModel CameraWith(const FaultFit& fit, const CameraModel& given);
/// The board.
BoardSpec BoardWith(const FaultFit& fit, const BoardSpec& given);

/// Least squares with noise levels of their own for each kind of residual, estimated together with
/// the parameters, which are the extrinsic and `faults`. The chessboards' turn has the prior that
/// the result gives it.
FaultFit FitFaults(const std::vector<FaultEquation>& equations,
                   const std::vector<FaultParameter>& faults);

/// How far each sample's centre stays off in space under `fit`, metres, in order.
std::vector<double> CentreErrorsM(const std::vector<FaultEquation>& equations, const FaultFit& fit);

}  // namespace voqcal
