#include "core/board/what_was_measured.hpp"

#include <Eigen/Eigenvalues>

namespace voqcal {

bool IsWhole(const LidarBoard& board) { return NumMeasuredSides(board) == 4; }

bool IsCentreMeasured(const LidarBoard& board) {
  constexpr double kMaxSigmaM = 0.03;
  if (IsWhole(board)) return true;
  const Eigen::Matrix3d covariance = board.pose.covariance.bottomRightCorner<3, 3>();
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  return eigenvalues[2] <= kMaxSigmaM * kMaxSigmaM;
}

std::vector<std::size_t> SeenCorners(const BoardSample& sample, std::size_t num_corners) {
  std::vector<std::size_t> seen;
  if (sample.camera.corners_px.size() != num_corners) return seen;
  for (std::size_t i = 0; i < num_corners; ++i) {
    if (sample.camera.corners_px[i].allFinite()) seen.push_back(i);
  }
  return seen;
}

}  // namespace voqcal
