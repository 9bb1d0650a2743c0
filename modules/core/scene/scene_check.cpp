#include "core/scene/scene_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/format.hpp"
#include "core/median.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kNumSectors = 12;
using Sectors = unsigned;  // a bit for each
constexpr Sectors kAllSectors = (1U << kNumSectors) - 1;
constexpr double kFirstStepRad = 0.32 * kRadPerDeg;  // of the climb to the peak
constexpr double kProbesRad[] = {
    0.25 * kRadPerDeg, 0.5 * kRadPerDeg, 1.0 * kRadPerDeg, 2.0 * kRadPerDeg};
constexpr double kProbesM[] = {0.025, 0.05, 0.1, 0.2};

struct Edge {
  Eigen::Vector3d position_lidar_m;
  const SceneView* view;
  int sector;
};

// Pixel coordinates in the reduced image: its pixel (0, 0) covers the first `reduction` pixels.
Eigen::Vector2d Reduced(const Eigen::Vector2d& pixel_px, double reduction) {
  return ((pixel_px.array() + 0.5) / reduction - 0.5).matrix();
}

// Rank at a place between pixels, 0 to 1; negative outside the image and on the board.
double RankAt(const SceneView& view, const Eigen::Vector2d& pixel_px) {
  const Eigen::Vector2d at = Reduced(pixel_px, view.reduction);
  const double left = std::floor(at.x());
  const double top = std::floor(at.y());
  const bool is_inside = left >= 0 && top >= 0 && left + 1 < view.edge_rank.cols &&
                         top + 1 < view.edge_rank.rows;  // false for NaN
  if (!is_inside) return -1;
  const int x = static_cast<int>(left);
  const int y = static_cast<int>(top);
  const uchar* upper = view.edge_rank.ptr<uchar>(y) + x;
  const uchar* lower = view.edge_rank.ptr<uchar>(y + 1) + x;
  if (upper[0] == 0 || upper[1] == 0 || lower[0] == 0 || lower[1] == 0) return -1;
  const double fx = at.x() - left;
  const double fy = at.y() - top;
  const double rank =
      (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) + fy * ((1 - fx) * lower[0] + fx * lower[1]);
  return (rank - 1) / 254;
}

double RankOf(const Edge& edge, const CameraModel& camera, const Eigen::Isometry3d& T) {
  const Eigen::Vector3d position_camera_m = T * edge.position_lidar_m;
  if (!camera.IsInFront(position_camera_m)) return -1;
  return RankAt(*edge.view, camera.Project(position_camera_m));
}

// The edges that the image shows, in sectors of equally many by azimuth.
std::vector<Edge> EdgesInView(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<Edge> edges;
  for (const SceneView& view : views) {
    for (const DepthEdge& seen : view.edges) {
      const Edge edge = {seen.position_lidar_m.cast<double>(), &view, 0};
      if (RankOf(edge, camera, T_camera_lidar) >= 0) edges.push_back(edge);
    }
  }
  const auto azimuth = [&T_camera_lidar](const Edge& edge) {
    const Eigen::Vector3d p = T_camera_lidar * edge.position_lidar_m;
    return std::atan2(p.x(), p.z());
  };
  std::stable_sort(edges.begin(), edges.end(), [&azimuth](const Edge& a, const Edge& b) {
    return azimuth(a) < azimuth(b);
  });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges[i].sector = static_cast<int>(i * kNumSectors / edges.size());
  }
  return edges;
}

double Score(const std::vector<Edge>& edges,
             const CameraModel& camera,
             const Eigen::Isometry3d& T_camera_lidar,
             Sectors counted = kAllSectors) {
  double sum = 0;
  int num_seen = 0;
  for (const Edge& edge : edges) {
    if ((counted >> edge.sector & 1U) == 0) continue;
    const double rank = RankOf(edge, camera, T_camera_lidar);
    if (rank < 0) continue;
    sum += rank;
    ++num_seen;
  }
  return num_seen == 0 ? 0 : sum / num_seen;
}

Eigen::Isometry3d Turned(const Eigen::Isometry3d& T_camera_lidar, const Eigen::Vector3d& turn_rad) {
  Vector6d delta = Vector6d::Zero();
  delta.head<3>() = turn_rad;
  return PerturbLeft(T_camera_lidar, delta);
}

// Climbs from `turn_rad`, axis by axis, with steps that halve from `step_rad`.
Eigen::Vector3d Climb(const std::vector<Edge>& edges,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      Eigen::Vector3d turn_rad,
                      double step_rad,
                      Sectors counted = kAllSectors) {
  constexpr double kLastStepRad = 0.01 * kRadPerDeg;
  constexpr double kFarthestRad = 3 * kRadPerDeg;
  const auto score_at = [&](const Eigen::Vector3d& turn) {
    return Score(edges, camera, Turned(T_camera_lidar, turn), counted);
  };
  double best = score_at(turn_rad);
  for (; step_rad > kLastStepRad; step_rad /= 2) {
    for (bool is_climbing = true; is_climbing;) {
      is_climbing = false;
      for (int i = 0; i < 6; ++i) {
        const Eigen::Vector3d there =
            turn_rad + (i % 2 == 0 ? step_rad : -step_rad) * Eigen::Vector3d::Unit(i / 2);
        if (there.norm() > kFarthestRad) continue;
        const double score = score_at(there);
        if (score <= best) continue;
        best = score;
        turn_rad = there;
        is_climbing = true;
      }
    }
  }
  return turn_rad;
}

std::vector<SceneProbe> Probe(const std::vector<Edge>& edges,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<SceneProbe> probes;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double size : axis < 3 ? kProbesRad : kProbesM) {
        SceneProbe probe;
        probe.delta[axis] = sign * size;
        probe.score = Score(edges, camera, PerturbLeft(T_camera_lidar, probe.delta));
        probes.push_back(probe);
      }
    }
  }
  return probes;
}

// Where to climb from: the best of the turns that were probed.
Eigen::Vector3d BestTurn(const SceneCheck& check) {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  double best = check.score;
  for (const SceneProbe& probe : check.probes) {
    if (!probe.delta.tail<3>().isZero() || probe.score <= best) continue;
    best = probe.score;
    turn_rad = probe.delta.head<3>();
  }
  return turn_rad;
}

// Half of the sectors, so that any two halves share half of theirs: the quadratic residues modulo
// 11, turned (Paley's construction of a Hadamard matrix), as balanced half-samples take them.
Sectors Half(int turn) {
  Sectors half = 1U << (kNumSectors - 1);
  for (const int residue : {1, 3, 4, 5, 9}) half |= 1U << ((residue + turn) % 11);
  return half;
}

constexpr int kNumHalves = 11;

// Balanced half-samples (McCarthy, Pseudo-replication: half samples, 1969): the peaks of halves of
// the scene scatter about the whole scene's as that does about the truth. Poses share the scene
// that stands still, so they are not independent; parts of the scene are.
Eigen::Vector3d Sigma(const std::vector<Edge>& edges,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const Eigen::Vector3d& peak_rad) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < kNumHalves; ++i) {
    const Eigen::Vector3d half_peak_rad =
        Climb(edges, camera, T_camera_lidar, peak_rad, kFirstStepRad, Half(i));
    sum += (half_peak_rad - peak_rad).cwiseAbs2();
  }
  return (sum / kNumHalves).cwiseSqrt();
}

// Between the scan lines that edges lie on; 0 where these are too dense to be told apart.
double LineSpacingRad(const std::vector<Edge>& edges) {
  constexpr double kGapRad = 0.3 * kRadPerDeg;
  std::vector<double> elevations_rad;
  for (const Edge& edge : edges) {
    elevations_rad.push_back(std::asin(edge.position_lidar_m.normalized().z()));
  }
  std::sort(elevations_rad.begin(), elevations_rad.end());
  std::vector<double> gaps_rad;
  for (std::size_t i = 1; i < elevations_rad.size(); ++i) {
    const double gap_rad = elevations_rad[i] - elevations_rad[i - 1];
    if (gap_rad > kGapRad) gaps_rad.push_back(gap_rad);
  }
  return gaps_rad.empty() ? 0.0 : Median(gaps_rad);
}

// What halves of the scene do not show, as they share it: an edge that crosses the lines ends
// anywhere between two, so that turns across the lines by up to their spacing s look alike.
// Uniform: s / sqrt(12) for one edge, by the root of their number less for as many as there are
// sectors.
Eigen::Vector3d LineSigma(const std::vector<Edge>& edges, const Eigen::Isometry3d& T_camera_lidar) {
  const double sigma_rad = LineSpacingRad(edges) / std::sqrt(12.0 * kNumSectors);
  Eigen::Vector3d ahead = Eigen::Vector3d::Zero();
  for (const Edge& edge : edges) ahead += (T_camera_lidar * edge.position_lidar_m).normalized();
  return sigma_rad * T_camera_lidar.linear().col(2).cross(ahead).normalized().cwiseAbs();
}

// Whether it is the axis at all that the peak is owed to: between scan lines lie plateaus, on which
// the peak strays far and the halves' peaks with it, for next to no score.
Eigen::Vector3d GainSigmas(const std::vector<Edge>& edges,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const Eigen::Vector3d& peak_rad) {
  Eigen::Vector3d sigmas;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d back_rad = peak_rad;
    back_rad[axis] = 0;
    const auto gain_of = [&](Sectors counted) {
      return Score(edges, camera, Turned(T_camera_lidar, peak_rad), counted) -
             Score(edges, camera, Turned(T_camera_lidar, back_rad), counted);
    };
    const double gain = gain_of(kAllSectors);
    double sum = 0;
    for (int i = 0; i < kNumHalves; ++i) sum += std::pow(gain_of(Half(i)) - gain, 2);
    sigmas[axis] = gain > 0 ? gain / std::sqrt(sum / kNumHalves) : 0;
  }
  return sigmas;
}

// How much higher the peak is than turns and shifts so large that nothing fits.
double Contrast(const SceneCheck& check) {
  double sum = 0;
  int num_far = 0;
  for (const SceneProbe& probe : check.probes) {
    const bool is_far = probe.delta.head<3>().norm() > 0.9 * kProbesRad[3] ||
                        probe.delta.tail<3>().norm() > 0.9 * kProbesM[3];
    if (!is_far) continue;
    sum += probe.score;
    ++num_far;
  }
  return check.peak_score - sum / num_far;
}

void Judge(const SceneCheckOptions& options, SceneCheck* check) {
  const Eigen::Vector3d offset_deg = check->offset_rad / kRadPerDeg;
  const Eigen::Vector3d sigma_deg = check->sigma_rad / kRadPerDeg;
  const std::string where = Format("x %.2f +- %.2f, y %.2f +- %.2f, z %.2f +- %.2f deg",
                                   offset_deg.x(),
                                   sigma_deg.x(),
                                   offset_deg.y(),
                                   sigma_deg.y(),
                                   offset_deg.z(),
                                   sigma_deg.z());
  bool is_off = false;
  bool may_be_off = false;
  std::string open;
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma_rad = check->sigma_rad[axis];
    const bool seems_off = std::abs(check->offset_rad[axis]) >
                           std::max(options.tolerance_rad, options.num_sigmas * sigma_rad);
    const bool is_sure = check->gain_sigmas[axis] >= options.min_gain_sigmas;
    if (sigma_rad > options.max_sigma_rad || (seems_off && !is_sure)) {
      open += "xyz"[axis];
      may_be_off = may_be_off || seems_off;
    } else {
      is_off = is_off || seems_off;
    }
  }
  if (open.size() > 1 || Contrast(*check) < options.min_contrast) {
    check->reason = "the sensors share too few sharp edges (best turn: " + where + ")";
    return;
  }
  if (is_off) {
    check->verdict = SceneVerdict::kDisagrees;
  } else if (!may_be_off) {
    check->verdict = SceneVerdict::kAgrees;
  }
  check->reason = Format("its edges fit best when turned by %.2f deg (", offset_deg.norm()) +
                  where + Format("), %.0f mm at 10 m", 1e4 * check->offset_rad.head<2>().norm());
  if (!open.empty()) check->reason += "; too little shows a turn about " + open;
}

}  // namespace

std::vector<std::string> SceneCheckOptions::Problems() const {
  ProblemList problems;
  problems.Add(view.Problems());
  problems.RequirePositive("min_edges", min_edges);
  problems.RequirePositive("min_contrast", min_contrast);
  problems.RequirePositive("max_sigma_rad", max_sigma_rad);
  problems.RequirePositive("tolerance_rad", tolerance_rad);
  problems.RequirePositive("num_sigmas", num_sigmas);
  problems.RequirePositive("min_gain_sigmas", min_gain_sigmas);
  return problems.lines();
}

std::string ToString(SceneVerdict verdict) {
  switch (verdict) {
    case SceneVerdict::kNotJudged:
      return "not judged";
    case SceneVerdict::kAgrees:
      return "agrees";
    case SceneVerdict::kDisagrees:
      return "disagrees";
  }
  return "unknown";
}

SceneCheck CheckScene(const std::vector<SceneView>& views,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const Eigen::Isometry3d& T_camera_lidar_averaged,
                      const SceneCheckOptions& options) {
  RequireUsable("SceneCheckOptions", options.Problems());
  const std::vector<Edge> edges = EdgesInView(views, camera, T_camera_lidar);
  SceneCheck check;
  check.num_scenes = static_cast<int>(views.size());
  check.num_edges = static_cast<int>(edges.size());
  if (check.num_edges < options.min_edges) {
    check.reason = views.empty() ? "no scene was kept with the samples"
                                 : Format("only %d depth edges lie in the images", check.num_edges);
    return check;
  }
  check.score = Score(edges, camera, T_camera_lidar);
  check.averaged_score = Score(edges, camera, T_camera_lidar_averaged);
  check.probes = Probe(edges, camera, T_camera_lidar);
  check.offset_rad = Climb(edges, camera, T_camera_lidar, BestTurn(check), kFirstStepRad);
  check.peak_score = Score(edges, camera, Turned(T_camera_lidar, check.offset_rad));
  const Eigen::Vector3d of_halves = Sigma(edges, camera, T_camera_lidar, check.offset_rad);
  check.sigma_rad =
      (of_halves.cwiseAbs2() + LineSigma(edges, T_camera_lidar).cwiseAbs2()).cwiseSqrt();
  check.gain_sigmas = GainSigmas(edges, camera, T_camera_lidar, check.offset_rad);
  Judge(options, &check);
  return check;
}

}  // namespace voqcal
