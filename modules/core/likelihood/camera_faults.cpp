#include "core/likelihood/camera_faults.hpp"

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "core/board/what_was_measured.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/estimation/sighting_errors.hpp"

namespace voqcal {
namespace {

using Matrix2Ld = Eigen::Matrix<double, 2, kNumLensErrors>;

// A pixel is linear in each error alone, so that central differences are exact but for rounding.
Matrix2Ld PixelByLens(const CameraModel& camera, const Eigen::Vector3d& point_camera_m) {
  constexpr double kStep = 1e-3;
  Matrix2Ld by_lens;
  for (Eigen::Index i = 0; i < kNumLensErrors; ++i) {
    const LensErrors step = kStep * LensErrors::Unit(i);
    by_lens.col(i) = (CorrectedCamera(camera, step).Project(point_camera_m) -
                      CorrectedCamera(camera, -step).Project(point_camera_m)) /
                     (2 * kStep);
  }
  return by_lens;
}

}  // namespace

CameraFaultTerms ChessboardTurnTerms() {
  CameraFaultTerms terms;
  terms.board_by_faults.setZero(6, kNumChessboardTurns);
  terms.board_by_faults.topRows<kNumChessboardTurns>() = -Eigen::Matrix2d::Identity();
  terms.information.setZero(kNumChessboardTurns, kNumChessboardTurns);
  terms.pull.setZero(kNumChessboardTurns);
  terms.prior_sigmas.setConstant(kNumChessboardTurns, kPriorChessboardTurnRad);
  return terms;
}

CameraFaultTerms LensErrorTerms(const BoardSample& sample,
                                const BoardSpec& board,
                                const CameraModel& camera,
                                double lens_error,
                                double corner_error_px) {
  CameraFaultTerms terms;
  terms.prior_sigmas.setConstant(kNumLensErrors, lens_error);
  terms.board_by_faults.setZero(6, kNumLensErrors);
  terms.information.setZero(kNumLensErrors, kNumLensErrors);
  terms.pull.setZero(kNumLensErrors);
  const std::vector<Eigen::Vector3d> corners_board_m = board.InnerCornersBoardM();
  const std::vector<std::size_t> seen = SeenCorners(sample, corners_board_m.size());
  if (seen.empty()) return terms;
  const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
  const auto num_rows = 2 * static_cast<Eigen::Index>(seen.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> J(num_rows, 6);
  Eigen::Matrix<double, Eigen::Dynamic, kNumLensErrors> L(num_rows, kNumLensErrors);
  Eigen::VectorXd e(num_rows);
  Eigen::Index row = 0;
  for (const std::size_t i : seen) {
    const Eigen::Vector3d arm_m = T_camera_board.linear() * corners_board_m[i];
    const Eigen::Vector3d point_m = T_camera_board.translation() + arm_m;
    Matrix23d J_px_point;
    Matrix36d J_point;
    J_point << -Skew(arm_m), Eigen::Matrix3d::Identity();
    e.segment<2>(row) =
        ProjectWithJacobian(camera, point_m, &J_px_point) - sample.camera.corners_px[i];
    J.middleRows<2>(row) = J_px_point * J_point;
    L.middleRows<2>(row) = PixelByLens(camera, point_m);
    row += 2;
  }
  const Matrix6d of_board = J.transpose() * J;
  terms.board_by_faults = -of_board.ldlt().solve(J.transpose() * L);
  const Eigen::MatrixXd left = L + J * terms.board_by_faults;
  const double weight = 1.0 / (corner_error_px * corner_error_px);
  terms.information = weight * left.transpose() * left;
  terms.pull = -weight * left.transpose() * e;
  return terms;
}

BoardPose CorrectedCameraPose(const BoardSample& sample,
                              const BoardSpec& board,
                              const CameraModel& camera,
                              const LensErrors& errors) {
  const CameraFaultTerms terms =
      LensErrorTerms(sample, board, camera, /*lens_error=*/1.0, /*corner_error_px=*/1.0);
  BoardPose pose = PoseFromTransform(
      PerturbLeft(TransformFromPose(sample.camera.pose), terms.board_by_faults * errors), board);
  pose.covariance = sample.camera.pose.covariance;
  return pose;
}

}  // namespace voqcal
