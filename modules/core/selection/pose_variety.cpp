#include "core/selection/pose_variety.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// Twice what a lidar's normals err by; below, their differences are its errors.
constexpr double kLeastAngleRad = 2.0 * M_PI / 180.0;
// About what a lidar's centres err by, which would turn the extrinsic about a shorter line.
constexpr double kLeastExtentM = 0.03;

double LargestAngleRad(const std::vector<const BoardSample*>& samples) {
  double largest_rad = 0.0;
  for (const BoardSample* sample : samples) {
    for (const BoardSample* other : samples) {
      largest_rad = std::max(largest_rad,
                             AngleBetween(sample->camera.pose.normal, other->camera.pose.normal));
    }
  }
  return largest_rad;
}

// RMS extents of the centres along their principal axes, ascending.
Eigen::Vector3d ExtentsM(const std::vector<const BoardSample*>& samples) {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  for (const BoardSample* sample : samples) mean_m += sample->camera.pose.centre_m;
  mean_m /= static_cast<double>(samples.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const BoardSample* sample : samples) {
    const Eigen::Vector3d arm_m = sample->camera.pose.centre_m - mean_m;
    moments += arm_m * arm_m.transpose() / static_cast<double>(samples.size());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

}  // namespace

std::string VarietyProblem(const std::vector<const BoardSample*>& samples) {
  if (samples.size() < 3) {
    return "only " + std::to_string(samples.size()) + " poses: at least 3 are needed";
  }
  if (LargestAngleRad(samples) < kLeastAngleRad) {
    return "all boards are parallel: tilt the board, left and right, up and down";
  }
  const Eigen::Vector3d extents_m = ExtentsM(samples);
  if (extents_m[2] < kLeastExtentM) {
    return "all boards are at one place: move the board about the view, near and far";
  }
  if (extents_m[1] < kLeastExtentM) {
    return "all boards are on one line: move the board to both sides of it";
  }
  return {};
}

}  // namespace voqcal
