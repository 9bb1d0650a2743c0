#include "core/lidar_detection/measure_board.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/lidar/plane_fit.hpp"
#include "core/lidar/shade_scale.hpp"
#include "core/lidar_detection/board_measurement.hpp"
#include "core/lidar_detection/outline_checks.hpp"
#include "core/lidar_detection/outline_doubt.hpp"
#include "core/lidar_detection/outline_edges.hpp"
#include "core/lidar_detection/outline_fit.hpp"
#include "core/lidar_detection/patch_view.hpp"
#include "core/lidar_detection/refusals.hpp"

namespace voqcal {
namespace {

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
  if (m->board_hits.size() < kMinBoardHits) return false;
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
  return m->board_hits.size() >= kMinBoardHits;
}

/// Whether the rays meet the plane at less than 20 degrees: then scan lines are three times as far
/// apart on it, and offsets between them tilt and stretch what is seen. Floors and tables are seen
/// so.
bool IsSeenFlat(const Measurement& m) {
  constexpr double kMinSine = 0.34;
  const Eigen::Vector3d ray = TransformOf(m.frame, m.outline.pose).translation().normalized();
  return -ray.dot(m.frame.plane.normal) < kMinSine;
}

Agreement AgreementOf(const Measurement& m) {
  return Compare(m.view.Outline(), m.view.BlockedM(), m.model, m.outline.pose);
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
    if (!agreement.IsBoardLike()) return Because(LidarBoardMiss::kSizeMismatch);
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
  if (IsSeenFlat(m)) return Because(LidarBoardMiss::kFlat);
  if (auto unproven = UnprovenSide(m)) return *unproven;
  const std::array<double, 4> lengths_m = EdgeLengthsM(edges, m.model);
  if (!HasRightSize(m, edges, lengths_m, board.EdgeLengthsM()))
    return Because(LidarBoardMiss::kSizeMismatch);
  if (IsLoose(m, options.max_corner_sigma_m)) return Because(LidarBoardMiss::kLoose);
  if (auto bent = Bend(m, cloud_lidar_m, options.max_bend_m)) return *bent;
  return Describe(m, lengths_m, cloud_lidar_m, board, options.beam.line_sigma_m);
}

}  // namespace voqcal
