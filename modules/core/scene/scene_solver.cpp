#include "core/scene/scene_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include "core/parallel.hpp"

namespace voqcal {
namespace {

// Residuals sqrt(2 k w_i surprise_i), whose half sum of squares is the scene's part of the cost.
class SceneCost final : public ceres::CostFunction {
 public:
  SceneCost(const SceneProblem& scene,
            const std::vector<EdgeField>& fields,
            Sectors sectors,
            double scale)
      : scene_(scene),
        fields_(fields),
        scale_(scale),
        edges_(EdgesIn(scene, sectors)),
        patches_(edges_.size()) {
    set_num_residuals(static_cast<int>(edges_.size()));
    mutable_parameter_block_sizes()->push_back(kSceneParameters);
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const SceneVector> unknowns(parameters[0]);
    const EdgeLookup lookup{fields_,
                            scene_.camera,
                            LeftPerturbation(scene_.T_camera_lidar, unknowns.head<6>()),
                            unknowns[6]};
    double* J_rows = jacobians != nullptr ? jacobians[0] : nullptr;
    constexpr std::size_t kEdgesAtOnce = 1000;  // waking a thread costs about as much as so many
    ParallelFor((edges_.size() + kEdgesAtOnce - 1) / kEdgesAtOnce, [&](std::size_t part) {
      const std::size_t begin = part * kEdgesAtOnce;
      EvaluateEdges(
          begin, std::min(edges_.size(), begin + kEdgesAtOnce), lookup, residuals, J_rows);
    });
    return true;
  }

 private:
  void EvaluateEdges(std::size_t begin,
                     std::size_t end,
                     const EdgeLookup& lookup,
                     double* residuals,
                     double* J_rows) const {
    double* J_of_surprises = J_rows != nullptr ? J_rows + kSceneParameters * begin : nullptr;
    SurprisesAt(
        &edges_[begin], end - begin, lookup, &patches_[begin], residuals + begin, J_of_surprises);
    for (std::size_t i = begin; i < end; ++i) {
      const double weight = scale_ * edges_[i]->weight;
      residuals[i] = std::sqrt(2 * weight * residuals[i]);
      if (J_rows == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 1, kSceneParameters>> row(J_rows + kSceneParameters * i);
      row *= weight / residuals[i];
    }
  }

  const SceneProblem& scene_;
  const std::vector<EdgeField>& fields_;
  double scale_;
  std::vector<const SceneEdge*> edges_;
  mutable std::vector<EdgeField::Patch> patches_;  // Ceres asks for one Evaluate at a time
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

}  // namespace

void MinimiseAt(const SceneProblem& scene,
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

}  // namespace voqcal
