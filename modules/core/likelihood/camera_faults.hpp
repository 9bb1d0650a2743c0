#pragma once

#include <Eigen/Core>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/lens_errors.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// What one chessboard says of faults of the camera that all chessboards share, to first order:
/// all of LensErrors (LensErrorTerms), these and the board's (CovarianceByRigErrors), or the turn
/// that stands for the lens (ChessboardTurnTerms). With pixel errors
///     e(p, l) = e0 + J p + L l
/// of all corners by the board's pose p (left perturbation) and the faults l, the pose with the
/// least squares moves by S l, S = -(J'J)^-1 J'L, and what is left of the corners' errors is
///     e0 + (L + J S) l
/// No rows or columns: no faults of the camera are asked for.
struct CameraFaultTerms {
  Eigen::Matrix<double, 6, Eigen::Dynamic> board_by_faults;  ///< S.
  Eigen::MatrixXd information;                               ///< Of l, by what is left...
  Eigen::VectorXd pull;                                      ///< ...minus its gradient at l = 0.
  Eigen::VectorXd prior_sigmas;  ///< Of l: shares, metres (pattern) or radians (the turn).

  Eigen::Index NumFaults() const { return pull.size(); }
};

constexpr Eigen::Index kNumChessboardTurns = 2;

/// Of SharedErrors' chessboard_turn about the camera's x and y, radians, which stands for errors of
/// the intrinsics where these are not asked for: the extrinsic then goes with the intrinsics as
/// given. The corners tell nothing of it.
CameraFaultTerms ChessboardTurnTerms();

/// Of LensErrors.
///
/// @param lens_error       1 sigma of each of LensErrors, before the corners speak.
/// @param corner_error_px  1 sigma of each corner in x and in y.
/// @return zeros if the sample has no corners' pixels (features read from a table).
CameraFaultTerms LensErrorTerms(const BoardSample& sample,
                                const BoardSpec& board,
                                const CameraModel& camera,
                                double lens_error,
                                double corner_error_px);

/// Where the camera sees the board if its intrinsics have these errors; its covariance stays.
BoardPose CorrectedCameraPose(const BoardSample& sample,
                              const BoardSpec& board,
                              const CameraModel& camera,
                              const LensErrors& errors);

}  // namespace voqcal
