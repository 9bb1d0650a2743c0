#include "core/scene/scene_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include "core/format.hpp"
#include "core/parallel.hpp"
#include "core/problems.hpp"
#include "core/scene/scene_cost.hpp"

namespace voqcal {
namespace {

using Sectors = unsigned;  // a bit for each
constexpr Sectors kAllSectors = (1U << kNumSceneSectors) - 1;
constexpr int kNumFolds = 6;

bool IsIn(Sectors sectors, const SceneEdge& edge) { return (sectors >> edge.sector & 1U) != 0; }

// All that stays the same while an extrinsic is refined.
struct Scene {
  std::vector<SceneEdge> edges;
  const CameraModel* camera = nullptr;
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();  // given
  SceneMatrix prior = SceneMatrix::Zero();     // information of the unknowns before the scene
  std::vector<std::vector<EdgeField>> levels;  // of all views, coarse to fine

  const std::vector<EdgeField>& Finest() const { return levels.back(); }
};

// Residuals sqrt(2 k w_i surprise_i), whose half sum of squares is the scene's part of the cost.
class SceneCost final : public ceres::CostFunction {
 public:
  SceneCost(const Scene& scene, const std::vector<EdgeField>& fields, Sectors sectors, double scale)
      : scene_(scene), fields_(fields), scale_(scale) {
    for (const SceneEdge& edge : scene.edges) {
      if (IsIn(sectors, edge)) edges_.push_back(&edge);
    }
    set_num_residuals(static_cast<int>(edges_.size()));
    mutable_parameter_block_sizes()->push_back(kSceneParameters);
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const SceneVector> unknowns(parameters[0]);
    const LeftPerturbation at(scene_.T_camera_lidar, unknowns.head<6>());
    const bool wants_J = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::Matrix<double, 1, kSceneParameters> J;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const double surprise =
          SurpriseAt(*edges_[i], fields_, *scene_.camera, at, unknowns[6], wants_J ? &J : nullptr);
      residuals[i] = std::sqrt(2 * scale_ * edges_[i]->weight * surprise);
      if (!wants_J) continue;
      Eigen::Map<Eigen::Matrix<double, 1, kSceneParameters>> row(jacobians[0] +
                                                                 kSceneParameters * i);
      row = scale_ * edges_[i]->weight / residuals[i] * J;
    }
    return true;
  }

 private:
  const Scene& scene_;
  const std::vector<EdgeField>& fields_;
  double scale_;
  std::vector<const SceneEdge*> edges_;
};

// What was known before: residuals L' x with L L' the information.
class PriorCost final : public ceres::SizedCostFunction<kSceneParameters, kSceneParameters> {
 public:
  explicit PriorCost(const SceneMatrix& information)
      : J_(SceneMatrix(information.llt().matrixL()).transpose()) {}

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const SceneVector> unknowns(parameters[0]);
    Eigen::Map<SceneVector> r(residuals);
    r = J_ * unknowns;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, kSceneParameters, kSceneParameters, Eigen::RowMajor>> J(
        jacobians[0]);
    J = J_;
    return true;
  }

 private:
  SceneMatrix J_;
};

void MinimiseAt(const Scene& scene,
                const std::vector<EdgeField>& fields,
                Sectors sectors,
                double scale,
                int max_iterations,
                SceneVector* unknowns) {
  ceres::Problem problem;
  problem.AddResidualBlock(new SceneCost(scene, fields, sectors, scale), nullptr, unknowns->data());
  problem.AddResidualBlock(new PriorCost(scene.prior), nullptr, unknowns->data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // the same sum each time
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-7;
  options.parameter_tolerance = 1e-7;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

// Mean surprise of the edges in the sectors, weighted.
double MeanSurprise(const Scene& scene, Sectors sectors, const SceneVector& unknowns) {
  const LeftPerturbation at(scene.T_camera_lidar, unknowns.head<6>());
  double sum = 0;
  double sum_weights = 0;
  for (const SceneEdge& edge : scene.edges) {
    if (!IsIn(sectors, edge)) continue;
    sum += edge.weight * SurpriseAt(edge, scene.Finest(), *scene.camera, at, unknowns[6], nullptr);
    sum_weights += edge.weight;
  }
  return sum / sum_weights;
}

using SectorGradients = std::array<SceneVector, kNumSceneSectors>;

// Of the weighted sum of surprises, by sector.
SectorGradients GradientsAt(const Scene& scene, const SceneVector& unknowns) {
  const LeftPerturbation at(scene.T_camera_lidar, unknowns.head<6>());
  SectorGradients gradients;
  gradients.fill(SceneVector::Zero());
  Eigen::Matrix<double, 1, kSceneParameters> J;
  for (const SceneEdge& edge : scene.edges) {
    SurpriseAt(edge, scene.Finest(), *scene.camera, at, unknowns[6], &J);
    gradients[static_cast<std::size_t>(edge.sector)] += edge.weight * J.transpose();
  }
  return gradients;
}

SceneVector Sum(const SectorGradients& gradients) {
  SceneVector sum = SceneVector::Zero();
  for (const SceneVector& gradient : gradients) sum += gradient;
  return sum;
}

// About what an edge's blur hides: differences so wide look past the pixels' grain.
SceneVector Steps() {
  SceneVector steps;
  steps << 0.001, 0.001, 0.002, 0.01, 0.01, 0.01, 0.0005;
  return steps;
}

// How the sum bends; made positive.
SceneMatrix CurvatureAt(const Scene& scene, const SceneVector& unknowns) {
  const SceneVector step = Steps();
  SceneMatrix curvature;
  for (int i = 0; i < kSceneParameters; ++i) {
    const SceneVector d = step[i] * SceneVector::Unit(i);
    curvature.col(i) =
        (Sum(GradientsAt(scene, unknowns + d)) - Sum(GradientsAt(scene, unknowns - d))) /
        (2 * step[i]);
  }
  // In units of the steps, so that no unit decides what is small.
  const SceneMatrix scaled =
      step.asDiagonal() * (0.5 * (curvature + curvature.transpose())) * step.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<SceneMatrix> eigen(scaled);
  const SceneVector values = eigen.eigenvalues().cwiseMax(1e-3 * eigen.eigenvalues().maxCoeff());
  const SceneMatrix positive =
      eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  const SceneVector unit = step.cwiseInverse();
  return unit.asDiagonal() * positive * unit.asDiagonal();
}

// The scatter of the parts' gradients about their mean: what the sum's would be by chance.
SceneMatrix ScatterAt(const Scene& scene, const SceneVector& unknowns) {
  const SectorGradients gradients = GradientsAt(scene, unknowns);
  const SceneVector mean = Sum(gradients) / kNumSceneSectors;
  SceneMatrix scatter = SceneMatrix::Zero();
  for (const SceneVector& gradient : gradients) {
    scatter += (gradient - mean) * (gradient - mean).transpose();
  }
  return scatter * kNumSceneSectors / (kNumSceneSectors - 1.0);
}

// The cost's k, and what it is made of.
struct Trust {
  double scale = 0;
  double redundancy = 0;
};

// k such that the gradients of k times the sum scatter as its curvature says, k^2 G = k H, summed
// over the unknowns in units of their steps.
Trust TrustAt(const Scene& scene, const SceneVector& unknowns) {
  const SceneMatrix H = CurvatureAt(scene, unknowns);
  const SceneMatrix G = ScatterAt(scene, unknowns);
  const double gain = 1 / MeanSurprise(scene, kAllSectors, unknowns) - 1;  // a - 1
  Trust trust;
  const SceneVector squares = Steps().cwiseAbs2();
  trust.scale =
      std::min(H.diagonal().dot(squares) / G.diagonal().dot(squares), std::max(gain, 0.0));
  trust.redundancy = gain / trust.scale;
  return trust;
}

SceneVector Solve(
    const Scene& scene, Sectors sectors, double scale, int max_iterations, SceneVector unknowns) {
  for (const auto& fields : scene.levels) {
    MinimiseAt(scene, fields, sectors, scale, max_iterations, &unknowns);
  }
  return unknowns;
}

// Each fold of the sectors by what the others give.
void CrossValidate(const Scene& scene,
                   double scale,
                   int max_iterations,
                   const SceneVector& unknowns,
                   SceneRefinement* refined) {
  std::array<double, kNumFolds> gains{};
  ParallelFor(kNumFolds, [&](std::size_t fold) {
    const Sectors held_out = (1U << fold) | (1U << (fold + kNumFolds));
    SceneVector others = unknowns;
    MinimiseAt(scene, scene.Finest(), kAllSectors & ~held_out, scale, max_iterations, &others);
    SceneVector before = SceneVector::Zero();
    before[6] = others[6];  // the outset is no merit of the extrinsic
    gains[fold] = MeanSurprise(scene, held_out, before) - MeanSurprise(scene, held_out, others);
  });
  double mean = 0;
  for (const double gain : gains) mean += gain / kNumFolds;
  double variance = 0;
  for (const double gain : gains) variance += (gain - mean) * (gain - mean) / (kNumFolds - 1.0);
  refined->held_out_gain = mean;
  refined->held_out_gain_sigma = std::sqrt(variance / kNumFolds);
}

Matrix6d CovarianceAt(const Scene& scene,
                      const SceneVector& unknowns,
                      double scale,
                      double shared_error_rad) {
  const SceneMatrix information = scene.prior + scale * CurvatureAt(scene, unknowns);
  Matrix6d covariance = information.inverse().topLeftCorner<6, 6>();
  // Not beyond what was known without the scene.
  for (int i = 0; i < 3; ++i) {
    const double before = scene.prior.topLeftCorner<6, 6>().inverse()(i, i);
    covariance(i, i) = std::min(before, covariance(i, i) + shared_error_rad * shared_error_rad);
  }
  return covariance;
}

}  // namespace

std::vector<std::string> SceneRefinementOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("min_edges", min_edges);
  problems.Require(!blurs_px.empty(), "blurs_px must not be empty", blurs_px.size());
  for (const double blur_px : blurs_px) problems.RequirePositive("blurs_px", blur_px);
  problems.RequirePositive("outset_prior_rad", outset_prior_rad);
  problems.RequirePositive("shared_error_rad", shared_error_rad);
  problems.Require(min_gain_sigmas >= 0, "min_gain_sigmas must not be negative", min_gain_sigmas);
  problems.RequirePositive("max_iterations", max_iterations);
  return problems.lines();
}

SceneRefinement RefineByScene(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar,
                              const Matrix6d& covariance,
                              const SceneRefinementOptions& options) {
  RequireUsable("SceneRefinementOptions", options.Problems());
  SceneRefinement refined;
  refined.T_camera_lidar = T_camera_lidar;
  refined.covariance = covariance;
  Scene scene;
  scene.edges = SceneEdgesInView(views, camera, T_camera_lidar);
  scene.camera = &camera;
  scene.T_camera_lidar = T_camera_lidar;
  refined.num_scenes = static_cast<int>(views.size());
  refined.num_edges = static_cast<int>(scene.edges.size());
  if (refined.num_edges < options.min_edges) {
    refined.reason = views.empty()
                         ? "no scene was kept with the samples"
                         : Format("only %d depth edges lie in the images", refined.num_edges);
    return refined;
  }
  scene.prior.topLeftCorner<6, 6>() = covariance.inverse();
  scene.prior(6, 6) = 1 / (options.outset_prior_rad * options.outset_prior_rad);
  for (const double blur_px : options.blurs_px) {
    scene.levels.push_back(MakeEdgeFields(views, blur_px));
  }

  constexpr int kTrustRounds = 2;
  SceneVector unknowns = SceneVector::Zero();
  refined.surprise_before = MeanSurprise(scene, kAllSectors, unknowns);
  Trust trust = TrustAt(scene, unknowns);
  for (int round = 0; round < kTrustRounds; ++round) {
    unknowns = Solve(scene, kAllSectors, trust.scale, options.max_iterations, unknowns);
    trust = TrustAt(scene, unknowns);
  }
  MinimiseAt(scene, scene.Finest(), kAllSectors, trust.scale, options.max_iterations, &unknowns);
  refined.redundancy = trust.redundancy;
  refined.outset_rad = unknowns[6];
  refined.surprise_after = MeanSurprise(scene, kAllSectors, unknowns);
  refined.move = unknowns.head<6>();
  refined.move_covariance = CovarianceAt(scene, unknowns, trust.scale, options.shared_error_rad);
  refined.move_chi2 = refined.move.dot(scene.prior.topLeftCorner<6, 6>() * refined.move);
  CrossValidate(scene, trust.scale, options.max_iterations, unknowns, &refined);
  const std::string gain = Format("parts of the scene left out fit %s by %.4f +- %.4f",
                                  refined.held_out_gain > 0 ? "better" : "worse",
                                  std::abs(refined.held_out_gain),
                                  refined.held_out_gain_sigma);
  if (!(refined.held_out_gain > options.min_gain_sigmas * refined.held_out_gain_sigma)) {
    refined.reason = "the boards alone decide: " + gain;
    return refined;
  }
  refined.is_used = true;
  refined.T_camera_lidar = PerturbLeft(T_camera_lidar, refined.move);
  refined.covariance = refined.move_covariance;
  refined.reason = gain;
  return refined;
}

}  // namespace voqcal
