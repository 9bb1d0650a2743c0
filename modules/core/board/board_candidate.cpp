#include "core/board/board_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/board/board_bend.hpp"
#include "core/board/outline_checks.hpp"
#include "core/board/outline_doubt.hpp"
#include "core/board/outline_edges.hpp"
#include "core/board/outline_fit.hpp"
#include "core/board/patch_view.hpp"
#include "core/board/plane_fit.hpp"
#include "core/board/shade_scale.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinHits = 30;  // fewer cannot measure a board

OutlineModel ModelOf(const BoardSpec& board, const LidarBoardOptions& options, double range_m) {
  const LidarBeamOptions& beam = options.beam;
  OutlineModel model;
  model.width_m = board.width_m;
  model.height_m = board.height_m;
  model.blur_m = beam.blur_m + beam.blur_per_m * range_m;
  model.spill_m = beam.spill_m;
  model.spill_sigma_m = beam.spill_sigma_m;
  model.thickness_m = options.thickness_m;
  model.thickness_sigma_m = options.thickness_sigma_m;
  return model;
}

Eigen::Isometry3d TransformOf(const PlaneFrame& frame, const RectanglePose& pose) {
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d R;
  R.col(0) = std::cos(pose.angle_rad) * frame.e1 + std::sin(pose.angle_rad) * frame.e2;
  R.col(2) = frame.plane.normal;
  R.col(1) = R.col(2).cross(R.col(0));
  T_lidar_board.linear() = R;
  T_lidar_board.translation() = frame.ToLidar(pose.centre_m);
  return T_lidar_board;
}

/// The half-turn of the rectangle whose y axis points up; if that is nearly level, whose x axis
/// does.
RectanglePose Upright(const PlaneFrame& frame, RectanglePose pose) {
  constexpr double kLevel = 0.02;  // of the axis' height: about one degree
  constexpr double kPi = 3.14159265358979323846;
  const Eigen::Matrix3d R = TransformOf(frame, pose).linear();
  const double up = std::abs(R(2, 1)) > kLevel ? R(2, 1) : R(2, 0);
  if (up < 0) pose.angle_rad += kPi;
  return pose;
}

/// OutlineModel::lean of a rectangle in the plane.
Eigen::Vector2d LeanOf(const PlaneFrame& frame, const RectanglePose& pose) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(frame, pose);
  const Eigen::Vector3d ray_board =
      T_lidar_board.linear().transpose() * T_lidar_board.translation();
  return ray_board.head<2>() / std::abs(ray_board.z());
}

/// Everything about one patch while it is measured.
struct Measurement {
  PatchView view;
  double hit_band_m;
  PlaneFrame frame;
  OutlineModel model;
  OutlineFit outline;
  std::vector<std::size_t> board_hits;       // for view.Beam()
  std::vector<Eigen::Vector3d> positions_m;  // of these, dark as far as bright
};

/// The beams around a patch, on its own plane.
Measurement Begin(const PlanarPatch& patch,
                  const BeamIndex& beams,
                  const BoardSpec& board,
                  const LidarBoardOptions& options) {
  PlaneFit plane = patch.plane;
  plane.point_m = patch.middle_m - plane.DistanceM(patch.middle_m) * plane.normal;
  const double diagonal_m = std::hypot(board.width_m, board.height_m);
  const double band_m = options.beam.hit_band_m;
  Measurement m{
      PatchView(beams, plane.point_m, diagonal_m), band_m, PlaneFrame(plane), {}, {}, {}, {}};
  m.model = ModelOf(board, options, plane.point_m.norm());
  m.view.Classify(m.frame, band_m);
  return m;
}

/// Where the hits would be if dark squares read no longer than bright ones: each moves along its
/// ray.
std::vector<Eigen::Vector3d> EvenlyShaded(const Measurement& m,
                                          const PlaneFit& plane,
                                          const PointCloud& cloud_lidar_m) {
  std::vector<Eigen::Vector3d> positions_m = m.view.PositionsM(m.board_hits);
  if (!cloud_lidar_m.has_intensity) return positions_m;
  std::vector<float> intensities;
  std::vector<double> residuals_m;
  for (const std::size_t i : m.board_hits) {
    const LidarBeam& beam = m.view.Beam(i);
    intensities.push_back(cloud_lidar_m.points[beam.point].intensity);
    residuals_m.push_back(plane.DistanceM(beam.PositionM()) / plane.normal.dot(beam.direction));
  }
  const ShadeScale scale = ShadeScaleOf(intensities);
  std::vector<double> shades;
  for (const float intensity : intensities) shades.push_back(scale.ShadeOf(intensity));
  const double dark_step_m = DarkStepM(residuals_m, shades);
  for (std::size_t k = 0; k < positions_m.size(); ++k) {
    positions_m[k] -= dark_step_m * shades[k] * m.view.Beam(m.board_hits[k]).direction;
  }
  return positions_m;
}

/// The plane of the points in the outline, and where the beams meet it. False if too few points are
/// left.
bool RefinePlane(const PointCloud& cloud_lidar_m, Measurement* m) {
  constexpr double kPlaneScaleM = 0.02;  // Cauchy: twice the noise
  constexpr double kMarginM = -0.005;    // the outermost returns are partly of what lies behind
  m->board_hits = m->view.HitsInside(m->frame, m->model, m->outline.pose, kMarginM);
  if (m->board_hits.size() < kMinHits) return false;
  const Eigen::Isometry3d T_lidar_board = TransformOf(m->frame, m->outline.pose);
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Vector3d width_axis = T_lidar_board.linear().col(0);
  m->positions_m = EvenlyShaded(*m, m->frame.plane, cloud_lidar_m);
  PlaneFit plane = FitPlaneRobustly(m->positions_m, m->frame.plane, kPlaneScaleM);
  plane.point_m = centre_m - plane.DistanceM(centre_m) * plane.normal;
  m->frame = PlaneFrame(plane);
  m->view.Classify(m->frame, m->hit_band_m);
  const double angle_rad = std::atan2(m->frame.e2.dot(width_axis), m->frame.e1.dot(width_axis));
  m->outline.pose = {Eigen::Vector2d::Zero(), angle_rad};
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  return true;
}

/// Turns the rectangle upright and takes all its points. False if too few are left.
bool Finish(const PointCloud& cloud_lidar_m, Measurement* m) {
  m->outline.pose = Upright(m->frame, m->outline.pose);
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  m->outline = EvaluateOutline(m->view.Outline(), m->model, m->outline);
  m->outline = SettleOutline(m->view.Outline(), m->model, m->outline);
  m->board_hits = m->view.HitsInside(m->frame, m->model, m->outline.pose, 0.0);
  m->positions_m = EvenlyShaded(*m, m->frame.plane, cloud_lidar_m);
  return m->board_hits.size() >= kMinHits;
}

Agreement AgreementOf(const Measurement& m) {
  return Compare(m.view.Outline(), m.model, m.outline.pose);
}

std::vector<std::uint16_t> RingsOf(const Measurement& m, const PointCloud& cloud_lidar_m) {
  std::vector<std::uint16_t> rings;
  if (!cloud_lidar_m.has_ring) return rings;
  for (const std::size_t i : m.board_hits) {
    rings.push_back(cloud_lidar_m.points[m.view.Beam(i).point].ring);
  }
  return rings;
}

/// Of [rotation_rad; translation_m], left side. The outline gives the shift in the plane and the
/// turn about the normal; the plane gives the tilts, and an offset that moves the centre along its
/// ray, because the outline was seen along rays. Covers noise, offsets of single scan lines, and
/// the unknown spill and thickness; not what all lines share, nor a board that is bent.
Matrix6d CovarianceOf(const Eigen::Isometry3d& T_lidar_board,
                      const Measurement& m,
                      const PointCloud& cloud_lidar_m,
                      double line_sigma_m) {
  const Eigen::Matrix3d R = T_lidar_board.linear();
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Matrix3d plane = PlaneCovariance(m.positions_m,
                                                RingsOf(m, cloud_lidar_m),
                                                m.frame.plane,
                                                centre_m,
                                                R.col(0),
                                                R.col(1),
                                                line_sigma_m);
  // No board is flatter.
  constexpr double kFlatM = 0.00015;
  const Eigen::Vector3d flat(
      m.model.height_m / std::sqrt(12.0), m.model.width_m / std::sqrt(12.0), 1.0);
  const Eigen::Matrix3d unevenness = (kFlatM * flat.cwiseInverse()).cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d outline = m.outline.PoseCovariance();
  const Eigen::Vector3d ray = centre_m.normalized();
  Eigen::Matrix<double, 6, 3> from_plane = Eigen::Matrix<double, 6, 3>::Zero();
  from_plane.block<3, 1>(0, 0) = R.col(0);
  from_plane.block<3, 1>(0, 1) = R.col(1);
  from_plane.block<3, 1>(3, 2) = ray / ray.dot(R.col(2));
  Eigen::Matrix<double, 6, 3> from_outline = Eigen::Matrix<double, 6, 3>::Zero();
  from_outline.block<3, 1>(3, 0) = R.col(0);
  from_outline.block<3, 1>(3, 1) = R.col(1);
  from_outline.block<3, 1>(0, 2) = R.col(2);
  return from_plane * (plane + unevenness) * from_plane.transpose() +
         from_outline * outline * from_outline.transpose();
}

LidarBoard Describe(const Measurement& m,
                    const std::array<double, 4>& edge_lengths_m,
                    const PointCloud& cloud_lidar_m,
                    const BoardSpec& board,
                    double line_sigma_m) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  LidarBoard found;
  found.pose = PoseFromTransform(T_lidar_board, board);
  found.pose.covariance = CovarianceOf(T_lidar_board, m, cloud_lidar_m, line_sigma_m);
  found.edge_lengths_m = edge_lengths_m;
  found.log_likelihood = m.outline.log_likelihood - LogLikelihoodOfChance(m.view.Outline());
  double sum_squares_m2 = 0.0;
  PointCloud& points = found.points_lidar_m;
  points.has_intensity = cloud_lidar_m.has_intensity;
  points.has_ring = cloud_lidar_m.has_ring;
  points.has_time = cloud_lidar_m.has_time;
  for (const std::size_t i : m.board_hits) {
    const double distance_m = m.frame.plane.DistanceM(m.view.Beam(i).PositionM());
    sum_squares_m2 += distance_m * distance_m;
    points.points.push_back(cloud_lidar_m.points[m.view.Beam(i).point]);
  }
  found.plane_rms_m = std::sqrt(sum_squares_m2 / static_cast<double>(m.board_hits.size()));
  const std::vector<std::uint16_t> rings = RingsOf(m, cloud_lidar_m);
  found.num_beams = static_cast<int>(std::set<std::uint16_t>(rings.begin(), rings.end()).size());
  return found;
}

/// "on the upper left": where `direction_lidar` points in the view of a lidar that looks along
/// `ray`.
std::string SideInView(const Eigen::Vector3d& direction_lidar, const Eigen::Vector3d& ray) {
  constexpr double kEighth = 0.78539816339744831;  // of a turn
  static constexpr std::array<const char*, 8> kNames = {"on the left",
                                                        "on the upper left",
                                                        "at the top",
                                                        "on the upper right",
                                                        "on the right",
                                                        "on the lower right",
                                                        "at the bottom",
                                                        "on the lower left"};
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(ray);
  const Eigen::Vector3d up = ray.cross(left);
  const double angle_rad = std::atan2(direction_lidar.dot(up), direction_lidar.dot(left));
  return kNames[static_cast<std::size_t>(std::lround(angle_rad / kEighth) + 8) % 8];
}

/// Whether the sensor looks past each edge. A cloud that was cropped to the board shows hardly
/// anything past any: then its hits alone must do.
std::array<bool, 4> CoveredPast(const std::array<OutlineEdge, 4>& edges,
                                const Measurement& m,
                                const BeamIndex& beams) {
  constexpr double kPastM = 0.1;
  constexpr int kFewMisses = 4;  // for each of so many hits
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  const Eigen::Vector2d half_m(m.model.width_m / 2, m.model.height_m / 2);
  int num_hits = 0;
  int num_misses = 0;
  for (const OutlineEdge& edge : edges) {
    num_hits += edge.num_hits;
    num_misses += edge.num_misses;
  }
  const bool is_cropped = kFewMisses * num_misses < num_hits;
  std::array<bool, 4> is_covered{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d outward = OutwardOf(i);
    const Eigen::Vector2d past_m = outward.cwiseProduct(half_m) + kPastM * outward;
    is_covered[i] =
        is_cropped || beams.Covers(T_lidar_board * Eigen::Vector3d(past_m.x(), past_m.y(), 0.0));
  }
  return is_covered;
}

/// "on the left", seen from the lidar: where an edge of the rectangle is.
std::string SideOf(const Measurement& m, std::size_t edge) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  const Eigen::Vector2d outward = OutwardOf(edge);
  const Eigen::Vector3d outward_lidar =
      T_lidar_board.linear() * Eigen::Vector3d(outward.x(), outward.y(), 0.0);
  return SideInView(outward_lidar, T_lidar_board.translation());
}

/// The side on which the outline is open, and what is there instead; nothing if it is closed.
std::optional<NoLidarBoard> OpenSide(const Measurement& m,
                                     const BeamIndex& beams,
                                     const std::array<OutlineEdge, 4>& edges,
                                     const Agreement& agreement,
                                     double slack) {
  constexpr double kMaxShortM = 0.05;   // hits of a closed outline come so near its edge...
  constexpr double kMaxSpacings = 1.5;  // ...or as near as the beams are to each other
  const double spacing_m = std::sqrt(m.model.width_m * m.model.height_m /
                                     static_cast<double>(std::max(m.board_hits.size(), kMinHits)));
  const double max_short_m = std::max(kMaxShortM, kMaxSpacings * spacing_m);
  const std::optional<std::size_t> edge =
      OpenEdge(edges, CoveredPast(edges, m, beams), agreement, max_short_m, slack);
  if (!edge) return {};
  const bool is_hidden = IsHidden(m.view.BlockedM(), m.model, m.outline.pose, *edge);
  return NoLidarBoard{is_hidden ? LidarBoardMiss::kHidden : LidarBoardMiss::kCutOff,
                      SideOf(m, *edge)};
}

/// That the board is certainly bent, and by how much; nothing if it may be flat.
std::optional<NoLidarBoard> Bend(const Measurement& m,
                                 const PointCloud& cloud_lidar_m,
                                 double max_bend_m) {
  constexpr double kCertain = 5.0;  // standard errors, themselves of a dozen scan lines
  const Eigen::Isometry3d T_board_lidar = TransformOf(m.frame, m.outline.pose).inverse();
  std::vector<Eigen::Vector3d> points_board_m = m.positions_m;
  for (Eigen::Vector3d& point_m : points_board_m) point_m = T_board_lidar * point_m;
  const BoardBend bend =
      MeasureBend(points_board_m, RingsOf(m, cloud_lidar_m), m.model.width_m, m.model.height_m);
  if (bend.bend_m - kCertain * bend.sigma_m <= max_bend_m) return {};
  std::ostringstream detail;
  detail << "by " << std::lround(bend.bend_m * 1e3) << " mm";
  return NoLidarBoard{LidarBoardMiss::kBent, detail.str()};
}

/// Whether the beams leave the rectangle too free, or free to be turned.
bool IsLoose(const Measurement& m, double max_sigma_m) {
  constexpr double kMayTurn = 0.25;  // of it: with less, no board was ever found turned
  const double sigma_m = CornerSigmaM(m.outline, m.model);
  if (sigma_m > max_sigma_m) return true;
  return sigma_m > kMayTurn * max_sigma_m && HasTurnedRival(m.view.Outline(), m.model, m.outline);
}

NoLidarBoard Because(LidarBoardMiss miss) { return {miss, {}}; }

}  // namespace

Expected<LidarBoard, NoLidarBoard> MeasureBoard(const PlanarPatch& patch,
                                                const BeamIndex& beams,
                                                const PointCloud& cloud_lidar_m,
                                                const BoardSpec& board,
                                                const LidarBoardOptions& options) {
  constexpr double kRoughly = 2.0;
  // Of a beam, in nats. Real boards leave 0.03; windows, doors and people 0.3 and more.
  constexpr double kMaxUnexplained = 0.25;
  Measurement m = Begin(patch, beams, board, options);
  const std::vector<OutlineBeam>& outline_beams = m.view.Outline();
  if (!CouldShowBoard(outline_beams, m.model)) return Because(LidarBoardMiss::kSizeMismatch);
  m.outline = SearchOutline(outline_beams, m.model, Eigen::Vector2d::Zero());
  if (m.outline.Unexplained() > kRoughly * kMaxUnexplained)
    return Because(LidarBoardMiss::kSizeMismatch);
  // Plane and outline in turns: the outline says which points are the board's, and the plane where
  // the beams meet it.
  for (const double first_blur_m : {SearchBlurM(m.model) / 2, 3 * m.model.blur_m, 0.0}) {
    const Agreement agreement = AgreementOf(m);
    if (!agreement.IsBoardLike(kRoughly)) return Because(LidarBoardMiss::kSizeMismatch);
    const auto edges = CountEdges(outline_beams, m.model, m.outline.pose);
    if (auto open = OpenSide(m, beams, edges, agreement, kRoughly)) return *open;
    if (!RefinePlane(cloud_lidar_m, &m)) return Because(LidarBoardMiss::kNoPlane);
    const bool is_last = first_blur_m == 0.0;
    m.outline = is_last ? RefineOutline(outline_beams, m.model, m.outline.pose)
                        : SharpenOutline(outline_beams, m.model, m.outline.pose, first_blur_m);
  }
  if (!Finish(cloud_lidar_m, &m)) return Because(LidarBoardMiss::kNoPlane);
  const Agreement agreement = AgreementOf(m);
  if (!agreement.IsBoardLike() || m.outline.Unexplained() > kMaxUnexplained)
    return Because(LidarBoardMiss::kSizeMismatch);
  const std::array<OutlineEdge, 4> edges = MeasureEdges(outline_beams, m.model, m.outline.pose);
  if (auto open = OpenSide(m, beams, edges, agreement, 1.0)) return *open;
  if (const auto edge = ScreenedEdge(outline_beams, m.view.BlockedM(), m.model, m.outline.pose)) {
    return NoLidarBoard{LidarBoardMiss::kHidden, SideOf(m, *edge)};
  }
  const std::array<double, 4> lengths_m = EdgeLengthsM(edges, m.model);
  if (!AreLengthsRight(lengths_m, edges, board.EdgeLengthsM()))
    return Because(LidarBoardMiss::kSizeMismatch);
  if (IsLoose(m, options.max_corner_sigma_m)) return Because(LidarBoardMiss::kLoose);
  if (auto bent = Bend(m, cloud_lidar_m, options.max_bend_m)) return *bent;
  return Describe(m, lengths_m, cloud_lidar_m, board, options.beam.line_sigma_m);
}

}  // namespace voqcal
