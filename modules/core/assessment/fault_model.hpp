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
  kFocalScale,   ///< The true focal lengths are (1 + value) times those given.
  kPrincipalX,   ///< The true principal point lies so many pixels farther right...
  kPrincipalY,   ///< ...and farther down.
  kSquareScale,  ///< The true squares are (1 + value) times as large as given.
  kRangeOffset,  ///< The lidar's ranges are too long by so many metres.
  kNumFaultParameters
};

/// Kinds of residuals, each with a noise level of its own: where the two sensors see the board.
enum ResidualKind : int {
  kAcross,  ///< Centre, across the camera's ray, metres.
  kAlong,   ///< Centre, along it, metres.
  kTilt,    ///< Normal, radians.
  kSpin,    ///< Turn in the board's plane, radians.
  kNumResidualKinds
};
using NoiseLevels = std::array<double, kNumResidualKinds>;

constexpr int kNumExtrinsicParameters = 6;  // [rotation_rad; translation_m], left (camera) side
constexpr int kNumModelParameters = kNumExtrinsicParameters + kNumFaultParameters;

/// How one sample's residual changes with everything that may be wrong, to first order about the
/// extrinsic: r(delta, fault) = r + J [delta; fault].
struct FaultEquation {
  std::int64_t sample_id = 0;
  Vector6d r = Vector6d::Zero();  ///< Across x, y; along; tilt x, y; spin.
  Eigen::Matrix<double, 6, kNumModelParameters> J;
};

ResidualKind KindOfRow(int row);

/// @param T_camera_lidar  near the truth: residuals are taken to be linear about it.
/// @return one equation a sample. Without corner pixels (features read from a table) the columns of
///     the camera's faults are zero: nothing can be said of them.
std::vector<FaultEquation> MakeFaultEquations(const std::vector<const BoardSample*>& samples,
                                              const BoardSpec& board,
                                              const CameraModel& camera,
                                              const Eigen::Isometry3d& T_camera_lidar);

/// The extrinsic fitted together with some faults.
struct FaultFit {
  bool is_usable = false;  ///< False if the samples leave a parameter open.
  Eigen::Matrix<double, kNumModelParameters, 1> value;           ///< Zero where not fitted.
  Eigen::Matrix<double, kNumModelParameters, 1> standard_error;  ///< NaN where not fitted.
  NoiseLevels noise{};
  double log_likelihood = 0;         ///< With these noise levels, but for a constant.
  double mean_error_m = 0;           ///< Of the centres, in space.
  double mean_held_out_error_m = 0;  ///< The same, each sample left out of the fit in turn.

  std::array<double, kNumResidualKinds> squares{};  ///< Sums of squares by kind.
};

/// Least squares with noise levels of their own for each kind of residual, estimated together with
/// the parameters, which are the extrinsic and `faults`.
FaultFit FitFaults(const std::vector<FaultEquation>& equations,
                   const std::vector<FaultParameter>& faults);

/// How far each sample's centre stays off in space under `fit`, metres, in order.
std::vector<double> CentreErrorsM(const std::vector<FaultEquation>& equations, const FaultFit& fit);

}  // namespace voqcal
