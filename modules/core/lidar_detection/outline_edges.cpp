#include "core/lidar_detection/outline_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace voqcal {
namespace {

/// A beam near an edge: how far along it (from its middle, counter-clockwise) and how far outside.
struct NearBeam {
  double along_m = 0.0;
  double outside_m = 0.0;
  bool is_hit = false;
};

/// Outward direction and half length of edge `i`, in the rectangle's axes.
struct Side {
  Eigen::Vector2d outward = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::Zero();
  double half_length_m = 0.0;
  double half_depth_m = 0.0;  ///< From the rectangle's centre to the edge.
  double blur_m = 0.0;        ///< OutlineModel's blur_k...
  double grow_m = 0.0;        ///< ...and the grow_k that is expected.
};

std::array<Side, 4> Sides(const OutlineModel& model) {
  const double x = model.width_m / 2;
  const double y = model.height_m / 2;
  const Eigen::Vector2d stretch = model.Stretch();
  const Eigen::Vector4d lean = model.SideLean();
  const Eigen::Vector2d blur_m = model.blur_m * stretch;
  const Eigen::Vector2d spill_m = model.spill_m * stretch;
  const auto grow_m = [&](int axis, int side) {
    return spill_m[axis] + model.thickness_m * lean[side];
  };
  return {Side{OutwardOf(0), {1, 0}, x, y, blur_m.y(), grow_m(1, 3)},
          Side{OutwardOf(1), {0, 1}, y, x, blur_m.x(), grow_m(0, 0)},
          Side{OutwardOf(2), {-1, 0}, x, y, blur_m.y(), grow_m(1, 2)},
          Side{OutwardOf(3), {0, -1}, y, x, blur_m.x(), grow_m(0, 1)}};
}

/// How far from an edge a beam still says something of it.
double WindowM(const OutlineModel& model) { return std::min(model.width_m, model.height_m) / 4; }

/// How far outside a miss still does, as scan lines may be so far apart; a hit there may be of
/// something else.
double FarthestMissM(const OutlineModel& model) { return 2 * WindowM(model); }

std::array<std::vector<NearBeam>, 4> BeamsNear(const std::vector<OutlineBeam>& beams,
                                               const OutlineModel& model,
                                               const RectanglePose& pose,
                                               const std::array<Side, 4>& sides) {
  const double window_m = WindowM(model);
  const double farthest_miss_m = FarthestMissM(model);
  // Near a corner the neighbouring edge decides too.
  const double corner_m = std::max(3 * model.blur_m, window_m / 4);
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  std::array<std::vector<NearBeam>, 4> near;
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    for (std::size_t i = 0; i < 4; ++i) {
      const double outside_m = sides[i].outward.dot(q_m) - sides[i].half_depth_m;
      if (outside_m < -window_m || outside_m > (beam.is_hit ? window_m : farthest_miss_m)) continue;
      const double along_m = sides[i].along.dot(q_m);
      if (std::abs(along_m) > sides[i].half_length_m - corner_m) continue;
      near[i].push_back({along_m, outside_m, beam.is_hit});
    }
  }
  return near;
}

OutlineEdge CountEdge(const std::vector<NearBeam>& near, double window_m) {
  OutlineEdge edge;
  edge.reach_m = -window_m;
  for (const NearBeam& beam : near) {
    (beam.is_hit ? edge.num_hits : edge.num_misses) += 1;
    if (beam.is_hit) edge.reach_m = std::max(edge.reach_m, beam.outside_m);
  }
  return edge;
}

/// Fisher scoring of [offset; slope] in p = L((offset + slope * along + grow - outside) / blur).
void FitLine(const std::vector<NearBeam>& near,
             const OutlineModel& model,
             const Side& side,
             double window_m,
             OutlineEdge* edge) {
  constexpr int kNumIterations = 20;
  const double keep = 1.0 - model.stray_hits - model.stray_misses;
  Eigen::Vector2d line = Eigen::Vector2d::Zero();
  double largest_step_m = window_m / 4;
  double last_step_m = 0.0;
  for (int i = 0; i < kNumIterations; ++i) {
    // Weak pull (window: 1 sigma) so that an edge seen at one place only keeps the rectangle's
    // slope.
    Eigen::Matrix2d H = Eigen::Vector2d(1 / (window_m * window_m), 1 / 0.01).asDiagonal();
    Eigen::Vector2d g = -H * line;
    for (const NearBeam& beam : near) {
      const double t =
          (line[0] + line[1] * beam.along_m + side.grow_m - beam.outside_m) / side.blur_m;
      const double L = 1.0 / (1.0 + std::exp(-t));
      const double p_hit = model.stray_hits + keep * L;
      const Eigen::Vector2d J = keep * L * (1 - L) / side.blur_m * Eigen::Vector2d(1, beam.along_m);
      g += J / (beam.is_hit ? p_hit : p_hit - 1.0);
      H += J * J.transpose() / (p_hit * (1.0 - p_hit));
    }
    Eigen::Vector2d step = H.ldlt().solve(g);
    // Between two scan lines there is hardly any curvature: steps would go to and fro.
    if (step[0] * last_step_m < 0) largest_step_m /= 2;
    step[0] = std::clamp(step[0], -largest_step_m, largest_step_m);
    last_step_m = step[0];
    step[1] = std::clamp(step[1], -0.1, 0.1);
    line += step;
    edge->offset_sigma_m = std::sqrt(H.inverse()(0, 0));
    if (step.norm() < 1e-6) break;  // a micrometre
  }
  edge->offset_m = line[0];
  edge->slope = line[1];
}

OutlineEdge MeasureEdge(const std::vector<NearBeam>& near,
                        const OutlineModel& model,
                        const Side& side,
                        double window_m) {
  OutlineEdge edge = CountEdge(near, window_m);
  if (edge.num_misses == 0) {  // nothing behind it to show its end: the hits' reach is all there is
    edge.offset_m = edge.reach_m - side.grow_m;
    edge.offset_sigma_m = window_m;
    return edge;
  }
  FitLine(near, model, side, window_m, &edge);
  return edge;
}

}  // namespace

Eigen::Vector2d OutwardOf(std::size_t edge) {
  const std::array<Eigen::Vector2d, 4> outward = {-Eigen::Vector2d::UnitY(),
                                                  Eigen::Vector2d::UnitX(),
                                                  Eigen::Vector2d::UnitY(),
                                                  -Eigen::Vector2d::UnitX()};
  return outward[edge];
}

std::array<OutlineEdge, 4> MeasureEdges(const std::vector<OutlineBeam>& beams,
                                        const OutlineModel& model,
                                        const RectanglePose& pose) {
  const std::array<Side, 4> sides = Sides(model);
  const auto near = BeamsNear(beams, model, pose, sides);
  std::array<OutlineEdge, 4> edges;
  for (std::size_t i = 0; i < 4; ++i) {
    edges[i] = MeasureEdge(near[i], model, sides[i], WindowM(model));
  }
  return edges;
}

std::array<double, 4> EdgeLengthsM(const std::array<OutlineEdge, 4>& edges,
                                   const OutlineModel& model) {
  const std::array<Side, 4> sides = Sides(model);
  std::array<Eigen::Vector2d, 4> corners_m;  // corner i is where edges i - 1 and i meet
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Matrix2d A;
    Eigen::Vector2d b;
    for (const int row : {0, 1}) {
      const std::size_t k = row == 0 ? (i + 3) % 4 : i;
      A.row(row) = (sides[k].outward - edges[k].slope * sides[k].along).transpose();
      b[row] = sides[k].half_depth_m + edges[k].offset_m;
    }
    corners_m[i] = A.partialPivLu().solve(b);
  }
  std::array<double, 4> lengths_m{};
  for (std::size_t i = 0; i < 4; ++i) lengths_m[i] = (corners_m[(i + 1) % 4] - corners_m[i]).norm();
  return lengths_m;
}

}  // namespace voqcal
