#include "core/scene/scene_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/format.hpp"
#include "core/parallel.hpp"
#include "core/problems.hpp"
#include "core/scene/scene_fit.hpp"
#include "core/scene/scene_score.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kProbesRad[] = {
    0.25 * kRadPerDeg, 0.5 * kRadPerDeg, 1.0 * kRadPerDeg, 2.0 * kRadPerDeg};
constexpr double kProbesM[] = {0.025, 0.05, 0.1, 0.2};

Agreement Judge(double asked, double sigma, double max_sigma, double tolerance, double num_sigmas) {
  if (!std::isfinite(asked) || !std::isfinite(sigma)) return Agreement::kCannotTell;
  if (std::abs(asked) > std::max(tolerance, num_sigmas * sigma)) return Agreement::kDisagrees;
  return sigma > max_sigma ? Agreement::kCannotTell : Agreement::kAgrees;
}

// Axes that move the image alike: of such a pair the scene may know neither, but both together.
struct AlikeAxes {
  std::vector<int> axes;
  int turn;  // Of them; negative: none.
};

const AlikeAxes& AlikeOf(int axis) {
  static const AlikeAxes kAlike[] = {{{0, 4}, 0}, {{1, 3}, 1}, {{2}, 2}, {{5}, -1}};
  constexpr int kGroup[] = {0, 1, 2, 1, 0, 3};
  return kAlike[kGroup[axis]];
}

// By what is asked alone: whether that is owed to the axis is asked of those that seem off.
std::array<Agreement, 6> AxesAsAsked(const SceneCheck& check, const SceneCheckOptions& options) {
  std::array<Agreement, 6> axes{};
  for (int i = 0; i < 6; ++i) {
    const bool is_turn = i < 3;
    axes[static_cast<std::size_t>(i)] =
        Judge(check.asked[i],
              check.sigma[i],
              is_turn ? options.max_turn_sigma_rad : options.max_shift_sigma_m,
              is_turn ? options.turn_tolerance_rad : options.shift_tolerance_m,
              options.num_sigmas);
  }
  return axes;
}

void JudgeAll(const SceneFit& fit, const SceneCheckOptions& options, SceneCheck* check) {
  constexpr int kEnoughTurns = 2;  // the third is often open: about the view axis, or the lines
  check->axes = AxesAsAsked(*check, options);
  const auto count = [&](Agreement agreement, int num_axes) {
    return std::count(check->axes.begin(), check->axes.begin() + num_axes, agreement);
  };
  if (count(Agreement::kDisagrees, 6) == 0) {
    if (count(Agreement::kAgrees, 3) >= kEnoughTurns) check->verdict = Agreement::kAgrees;
    return;
  }
  const Eigen::Vector3d chance = ChanceFalls(fit);
  for (int i = 0; i < 6; ++i) {
    Agreement& axis = check->axes[static_cast<std::size_t>(i)];
    if (axis != Agreement::kDisagrees) continue;
    const AlikeAxes& alike = AlikeOf(i);
    const double by_chance = alike.turn < 0 ? chance.maxCoeff() : chance[alike.turn];
    if (GainOf(fit, alike.axes) > options.min_gain_over_chance * by_chance) {
      check->verdict = Agreement::kDisagrees;
    } else {
      axis = Agreement::kCannotTell;
    }
  }
}

std::vector<SceneProbe> Probe(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<SceneProbe> probes;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double size : axis < 3 ? kProbesRad : kProbesM) {
        SceneProbe probe;
        probe.delta[axis] = sign * size;
        probes.push_back(probe);
      }
    }
  }
  ParallelFor(probes.size(), [&](std::size_t i) {
    const Eigen::Isometry3d T_probed = PerturbLeft(T_camera_lidar, probes[i].delta);
    probes[i].score = MeanEdgeRank(views, camera, T_probed);
  });
  return probes;
}

std::string WithError(const char* axis, double value, double sigma, const char* format) {
  return std::string(axis) + Format(format, value) + " +- " + Format(format, sigma);
}

// Three axes of a turn or a shift, each with its standard error.
std::string Axes(const Vector6d& asked, const Vector6d& sigma, int first, double unit) {
  const char* format = first == 0 ? "%.2f" : "%.0f";
  return WithError("x ", unit * asked[first], unit * sigma[first], format) +
         WithError(", y ", unit * asked[first + 1], unit * sigma[first + 1], format) +
         WithError(", z ", unit * asked[first + 2], unit * sigma[first + 2], format);
}

std::string ReasonOf(const SceneCheck& check) {
  const char* const names[] = {"turns about x",
                               "turns about y",
                               "turns about z",
                               "shifts along x",
                               "shifts along y",
                               "shifts along z"};
  std::string text = Format("its edges fit best when turned by %.2f deg (",
                            kDegPerRad * check.asked.head<3>().norm()) +
                     Axes(check.asked, check.sigma, 0, kDegPerRad) +
                     Format(") and shifted by %.0f mm (", 1e3 * check.asked.tail<3>().norm()) +
                     Axes(check.asked, check.sigma, 3, 1e3) + ")";
  std::string open;
  for (std::size_t i = 0; i < check.axes.size(); ++i) {
    if (check.axes[i] == Agreement::kCannotTell)
      open += (open.empty() ? "" : ", ") + std::string(names[i]);
  }
  return open.empty() ? text : text + "; it shows too little of " + open;
}

}  // namespace

std::vector<std::string> SceneCheckOptions::Problems() const {
  ProblemList problems;
  problems.Add(view.Problems());
  problems.RequirePositive("turn_prior_rad", turn_prior_rad);
  problems.RequirePositive("shift_prior_m", shift_prior_m);
  problems.RequirePositive("max_turn_sigma_rad", max_turn_sigma_rad);
  problems.RequirePositive("max_shift_sigma_m", max_shift_sigma_m);
  problems.RequirePositive("turn_tolerance_rad", turn_tolerance_rad);
  problems.RequirePositive("shift_tolerance_m", shift_tolerance_m);
  problems.RequirePositive("num_sigmas", num_sigmas);
  problems.RequirePositive("min_gain_over_chance", min_gain_over_chance);
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

SceneCheck CheckScene(const std::vector<SceneView>& views,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const SceneCheckOptions& options) {
  RequireUsable("SceneCheckOptions", options.Problems());
  Vector6d prior;
  prior << Eigen::Vector3d::Constant(options.turn_prior_rad),
      Eigen::Vector3d::Constant(options.shift_prior_m);
  std::vector<SceneEdge> edges = SceneEdgesInView(views, camera, T_camera_lidar);
  SceneCheck check;
  check.num_scenes = static_cast<int>(views.size());
  check.num_edges = static_cast<int>(edges.size());
  if (check.num_edges < options.refinement.min_edges) {
    check.reason = TooFewEdges(check.num_scenes, check.num_edges);
    return check;
  }
  const SceneFit fit = FitScene(views,
                                std::move(edges),
                                camera,
                                T_camera_lidar,
                                prior.cwiseAbs2().asDiagonal(),
                                options.refinement);
  check.asked = fit.unknowns.head<6>();
  check.sigma = CovarianceOf(fit, options.refinement.shared_error_rad).diagonal().cwiseSqrt();
  JudgeAll(fit, options, &check);
  check.reason = ReasonOf(check);
  check.score = MeanEdgeRank(views, camera, T_camera_lidar);
  check.asked_score = MeanEdgeRank(views, camera, PerturbLeft(T_camera_lidar, check.asked));
  check.probes = Probe(views, camera, T_camera_lidar);
  return check;
}

}  // namespace voqcal
