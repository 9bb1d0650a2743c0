#include "core/scene/scene_agreement.hpp"

#include <algorithm>
#include <cmath>

#include "core/problems.hpp"

namespace voqcal {
namespace {

Agreement Judge(double asked, double sigma, double max_sigma, double tolerance, double num_sigmas) {
  if (!std::isfinite(asked) || !std::isfinite(sigma)) return Agreement::kCannotTell;
  if (std::abs(asked) > std::max(tolerance, num_sigmas * sigma)) return Agreement::kDisagrees;
  return sigma > max_sigma ? Agreement::kCannotTell : Agreement::kAgrees;
}

Agreement OfAll(const std::array<Agreement, 6>& axes) {
  const auto is = [](Agreement wanted) {
    return [wanted](Agreement each) { return each == wanted; };
  };
  if (std::any_of(axes.begin(), axes.end(), is(Agreement::kDisagrees))) {
    return Agreement::kDisagrees;
  }
  const bool knows_a_turn = std::any_of(axes.begin(), axes.begin() + 3, is(Agreement::kAgrees));
  return knows_a_turn ? Agreement::kAgrees : Agreement::kCannotTell;
}

}  // namespace

std::vector<std::string> SceneAgreementOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("turn_prior_rad", turn_prior_rad);
  problems.RequirePositive("shift_prior_m", shift_prior_m);
  problems.RequirePositive("max_turn_sigma_rad", max_turn_sigma_rad);
  problems.RequirePositive("max_shift_sigma_m", max_shift_sigma_m);
  problems.RequirePositive("turn_tolerance_rad", turn_tolerance_rad);
  problems.RequirePositive("shift_tolerance_m", shift_tolerance_m);
  problems.RequirePositive("num_sigmas", num_sigmas);
  problems.Add(refinement.Problems());
  return problems.lines();
}

std::string ToString(Agreement agreement) {
  switch (agreement) {
    case Agreement::kAgrees:
      return "agrees";
    case Agreement::kDisagrees:
      return "disagrees";
    case Agreement::kCannotTell:
      return "cannot tell";
  }
  return "unknown";
}

SceneAgreement CheckAgreement(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar,
                              const SceneAgreementOptions& options) {
  RequireUsable("SceneAgreementOptions", options.Problems());
  Vector6d prior;
  prior << Eigen::Vector3d::Constant(options.turn_prior_rad),
      Eigen::Vector3d::Constant(options.shift_prior_m);
  SceneAgreement agreement;
  agreement.axes.fill(Agreement::kCannotTell);
  agreement.sigma = prior;
  agreement.refinement = RefineByScene(
      views, camera, T_camera_lidar, prior.cwiseAbs2().asDiagonal(), options.refinement);
  const SceneRefinement& refined = agreement.refinement;
  if (refined.num_edges < options.refinement.min_edges) return agreement;
  agreement.asked = refined.move;
  agreement.sigma = refined.move_covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 6; ++i) {
    const bool is_turn = i < 3;
    agreement.axes[static_cast<std::size_t>(i)] =
        Judge(agreement.asked[i],
              agreement.sigma[i],
              is_turn ? options.max_turn_sigma_rad : options.max_shift_sigma_m,
              is_turn ? options.turn_tolerance_rad : options.shift_tolerance_m,
              options.num_sigmas);
  }
  agreement.all = OfAll(agreement.axes);
  return agreement;
}

}  // namespace voqcal
