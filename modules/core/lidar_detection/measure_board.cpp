#include "core/lidar_detection/measure_board.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/lidar/plane_fit.hpp"
#include "core/lidar/shade_scale.hpp"
#include "core/lidar_detection/board_measurement.hpp"
#include "core/lidar_detection/describe_board.hpp"
#include "core/lidar_detection/detection_tolerances.hpp"
#include "core/lidar_detection/lengthened_sides.hpp"
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
  const Eigen::Matrix3d R = TransformOf(frame, pose).linear();
  const double up = std::abs(R(2, 1)) > kLevel ? R(2, 1) : R(2, 0);
  if (up < 0) pose.angle_rad += M_PI;
  return pose;
}

/// OutlineModel::lean of a rectangle in the plane.
Eigen::Vector2d LeanOf(const PlaneFrame& frame, const RectanglePose& pose) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(frame, pose);
  const Eigen::Vector3d ray_board =
      T_lidar_board.linear().transpose() * T_lidar_board.translation();
  return ray_board.head<2>() / std::abs(ray_board.z());
}

/// The cloud's axis that is most in the plane: it turns with the cloud.
Eigen::Vector3d AxisAcross(const PlaneFit& plane, const BeamIndex& beams) {
  const Eigen::Vector3d along_normal = (beams.R_axes_lidar() * plane.normal).cwiseAbs();
  Eigen::Index axis = 0;
  along_normal.minCoeff(&axis);
  return beams.R_axes_lidar().row(axis).transpose();
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
  Measurement m{PatchView(beams, plane.point_m, diagonal_m),
                band_m,
                PlaneFrame(plane, AxisAcross(plane, beams)),
                {},
                {},
                {},
                {},
                {},
                {}};
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

/// How far from the plane its own returns lie: what stands out farther is something else, a post
/// behind it or a hand.
double NoiseBandM(const std::vector<Eigen::Vector3d>& points_m, const PlaneFit& plane) {
  constexpr double kMedianToSigma = 1.4826;  // of a normal distribution
  constexpr double kSigmas = 5.0;
  constexpr double kLeastM = 0.02;  // offsets of single scan lines
  std::vector<double> distances_m;
  distances_m.reserve(points_m.size());
  for (const Eigen::Vector3d& p_m : points_m) distances_m.push_back(std::abs(plane.DistanceM(p_m)));
  const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
  std::nth_element(distances_m.begin(), middle, distances_m.end());
  return std::max(kLeastM, kSigmas * kMedianToSigma * *middle);
}

/// The prior in the plane. Where the outline is measured it must not count, as the extrinsic that
/// it comes from will be judged by the board: it pulls with a tenth of a measured side's strength
/// at most.
ExpectedRectangle ExpectedIn(const PlaneFrame& frame, const BoardPrior& prior) {
  constexpr double kLeastSigma = 0.02;  // metres and radians
  const Eigen::Matrix3d R = prior.T_lidar_board.linear();
  const Eigen::Matrix3d shift_m2 = R.transpose() * prior.covariance.bottomRightCorner<3, 3>() * R;
  const Eigen::Matrix3d turn_rad2 = R.transpose() * prior.covariance.topLeftCorner<3, 3>() * R;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = shift_m2.topLeftCorner<2, 2>();
  covariance(2, 2) = turn_rad2(2, 2);
  covariance.diagonal().array() += kLeastSigma * kLeastSigma;
  const Eigen::Vector3d width_axis = R.col(0);
  return {{frame.ToPlane(prior.T_lidar_board.translation()),
           std::atan2(frame.e2.dot(width_axis), frame.e1.dot(width_axis))},
          covariance.inverse()};
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
  m->hit_band_m = std::min(m->hit_band_m, NoiseBandM(m->positions_m, plane));
  plane.point_m = centre_m - plane.DistanceM(centre_m) * plane.normal;
  m->frame = PlaneFrame(plane, m->frame.e1);
  m->view.Classify(m->frame, m->hit_band_m);
  const double angle_rad = std::atan2(m->frame.e2.dot(width_axis), m->frame.e1.dot(width_axis));
  m->outline.pose = {Eigen::Vector2d::Zero(), angle_rad};
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  return true;
}

/// What is past the sides of the rectangle, and which beams tell of it.
void LookAround(Measurement* m) {
  m->sides =
      LookAtSides(m->view.Outline(), m->view.Blocked(), m->model, m->outline.pose, SpacingM(*m));
  m->telling = TellingBeams(m->view.Outline(), m->model, m->outline.pose, m->sides);
}

/// Takes all the rectangle's points. False if too few are left.
bool Finish(const PointCloud& cloud_lidar_m, Measurement* m) {
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  LookAround(m);
  OpenLengthenedSides(m);
  m->outline = EvaluateOutline(m->telling, m->model, m->outline);
  m->outline = SettleOutline(m->telling, m->model, m->outline);
  if (m->model.expected) m->outline = WithoutExpected(m->model, m->outline);
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

/// Inside every beam counts; outside only those that tell where the board ends.
Agreement AgreementOf(const Measurement& m) {
  Agreement agreement = Compare(m.view.Outline(), m.view.Blocked(), m.model, m.outline.pose);
  agreement.hits_outside =
      Compare(m.telling, m.view.Blocked(), m.model, m.outline.pose).hits_outside;
  return agreement;
}

NoLidarBoard Because(LidarBoardMiss miss) { return {miss, {}}; }

/// Things may touch the board: their hits count less while it is not known where.
OutlineModel AmongThings(OutlineModel model) {
  model.stray_hits = 0.05;
  return model;
}

/// Plane and outline in turns: the outline says which points are the board's, and the plane where
/// the beams meet it; then what is past its sides says which beams tell of it. From where the board
/// is expected they are told at once: what joins it would draw a rough fit away.
std::optional<NoLidarBoard> FitPlaneAndOutline(const PointCloud& cloud_lidar_m,
                                               const BoardPrior* prior,
                                               Measurement* m) {
  // Beams that were first told to be of something else free the outline in later rounds. Unless the
  // board is expected there, more than two bring more of other things up to its likeness.
  const int num_rounds = prior != nullptr ? 6 : 2;
  constexpr double kSettledM = 0.001;
  for (const double first_blur_m : {SearchBlurM(m->model) / 2, 3 * m->model.blur_m}) {
    LookAround(m);
    if (!AgreementOf(*m).IsBoardLike()) return Because(LidarBoardMiss::kSizeMismatch);
    if (!RefinePlane(cloud_lidar_m, m)) return Because(LidarBoardMiss::kNoPlane);
    if (prior != nullptr) {
      m->model.expected = ExpectedIn(m->frame, *prior);
      LookAround(m);
    }
    m->outline = SharpenOutline(prior != nullptr ? m->telling : m->view.Outline(),
                                AmongThings(m->model),
                                m->outline.pose,
                                first_blur_m);
  }
  LookAround(m);
  if (!RefinePlane(cloud_lidar_m, m)) return Because(LidarBoardMiss::kNoPlane);
  if (prior != nullptr) m->model.expected = ExpectedIn(m->frame, *prior);
  for (int i = 0; i < num_rounds; ++i) {
    LookAround(m);
    OpenLengthenedSides(m);
    const Eigen::Vector2d before_m = m->outline.pose.centre_m;
    m->outline = RefineOutline(m->telling, m->model, m->outline.pose);
    if (i > 0 && (m->outline.pose.centre_m - before_m).norm() < kSettledM) break;
  }
  return {};
}

/// What speaks against the patch, or the board at it. Where it is expected, only what contradicts
/// it does.
Expected<MeasuredBoard, NoLidarBoard> Decide(const Measurement& m,
                                             bool is_expected,
                                             const BeamIndex& beams,
                                             const PointCloud& cloud_lidar_m,
                                             const BoardSpec& board,
                                             const LidarBoardOptions& options) {
  const Agreement agreement = AgreementOf(m);
  const double max_unexplained = is_expected ? kMaxUnexplainedIfExpected : kMaxUnexplained;
  if (!agreement.IsBoardLike() || m.outline.Unexplained() > max_unexplained)
    return Because(LidarBoardMiss::kSizeMismatch);
  if (IsSeenFlat(m)) return Because(LidarBoardMiss::kFlat);
  const std::array<OutlineEdge, 4> edges = MeasureEdges(m.telling, m.model, m.outline.pose);
  const std::array<double, 4> lengths_m = EdgeLengthsM(edges, m.model);
  const std::array<bool, 4> is_told = ToldSides(m, beams, edges);
  const std::array<double, 4> true_m = board.EdgeLengthsM();
  const bool is_right_size =
      is_expected
          ? AreLengthsRight(lengths_m, edges, true_m, is_told, kExpectedOfOne, kExpectedOfMean)
          : HasRightSize(m, edges, lengths_m, true_m, is_told);
  if (!is_right_size) return Because(LidarBoardMiss::kSizeMismatch);
  if (auto bent = Bend(m, cloud_lidar_m, options.max_bend_m)) return *bent;
  std::optional<NoLidarBoard> doubt = Doubt(m, agreement, is_told);
  const bool is_whole = std::count(is_told.begin(), is_told.end(), true) == 4;
  const bool is_sure_size =
      is_whole || AreLengthsRight(lengths_m, edges, true_m, is_told, kPairOfOne, kSurePairOfMean);
  if (!doubt && (!is_sure_size || IsLoose(m, options.max_corner_sigma_m)))
    doubt = Because(LidarBoardMiss::kLoose);
  return MeasuredBoard{DescribeBoard(m, lengths_m, cloud_lidar_m, board, options.beam.line_sigma_m),
                       std::move(doubt)};
}

/// The returns where the board is expected, its depth being as uncertain as the prior says.
std::vector<Eigen::Vector3d> ExpectedPointsM(const BoardPrior& prior,
                                             const BeamIndex& beams,
                                             const BoardSpec& board,
                                             double reach_m) {
  const Eigen::Vector3d centre_m = prior.T_lidar_board.translation();
  const double radius_m = std::hypot(board.width_m, board.height_m) / 2 + reach_m;
  std::vector<LidarBeam> cone;
  beams.AppendCone(centre_m.normalized(), std::atan2(radius_m, centre_m.norm()), &cone);
  const Eigen::Isometry3d T_board_lidar = prior.T_lidar_board.inverse();
  const Eigen::Array3d half_m(board.width_m / 2, board.height_m / 2, reach_m);
  std::vector<Eigen::Vector3d> points_m;
  for (const LidarBeam& beam : cone) {
    const Eigen::Vector3d p_m = T_board_lidar * beam.PositionM();
    if ((p_m.array().abs() < half_m).all()) points_m.push_back(beam.PositionM());
  }
  return points_m;
}

/// Three sigma of the prior's centre, and of its tilt at the board's rim.
double ReachM(const BoardPrior& prior, const BoardSpec& board) {
  constexpr double kSigmas = 3.0;
  constexpr double kLeastM = 0.05;
  const double tilt_rad = std::sqrt(prior.covariance.diagonal().head<3>().maxCoeff());
  const double shift_m = std::sqrt(prior.covariance.diagonal().tail<3>().maxCoeff());
  return kLeastM + kSigmas * (shift_m + tilt_rad * std::hypot(board.width_m, board.height_m) / 4);
}

/// Whether pose and prior differ by no more than both allow.
bool FitsIn(const BoardPose& pose, const BoardPrior& prior) {
  constexpr double kMaxSquare = 22.5;  // chi-square of six, one in a thousand
  Vector6d off;
  const Eigen::Isometry3d T_lidar_board = TransformFromPose(pose);
  const Eigen::AngleAxisd turn(T_lidar_board.linear() * prior.T_lidar_board.linear().transpose());
  off << turn.angle() * turn.axis(),
      T_lidar_board.translation() - prior.T_lidar_board.translation();
  const Matrix6d both = pose.covariance + prior.covariance;
  return off.dot(both.ldlt().solve(off)) < kMaxSquare;
}

}  // namespace

Expected<MeasuredBoard, NoLidarBoard> MeasureBoard(const PlanarPatch& patch,
                                                   const BeamIndex& beams,
                                                   const PointCloud& cloud_lidar_m,
                                                   const BoardSpec& board,
                                                   const LidarBoardOptions& options) {
  Measurement m = Begin(patch, beams, board, options);
  if (!CouldShowBoard(m.view.Outline(), m.model)) return Because(LidarBoardMiss::kSizeMismatch);
  m.outline = SearchOutline(m.view.Outline(), AmongThings(m.model), Eigen::Vector2d::Zero());
  if (m.outline.Unexplained() > kMaxUnexplainedRoughly)
    return Because(LidarBoardMiss::kSizeMismatch);
  if (auto none = FitPlaneAndOutline(cloud_lidar_m, nullptr, &m)) return *none;
  m.outline.pose = Upright(m.frame, m.outline.pose);
  if (!Finish(cloud_lidar_m, &m)) return Because(LidarBoardMiss::kNoPlane);
  return Decide(m, false, beams, cloud_lidar_m, board, options);
}

Expected<MeasuredBoard, NoLidarBoard> MeasureExpectedBoard(const BoardPrior& prior,
                                                           const BeamIndex& beams,
                                                           const PointCloud& cloud_lidar_m,
                                                           const BoardSpec& board,
                                                           const LidarBoardOptions& options) {
  const double reach_m = ReachM(prior, board);
  const std::vector<Eigen::Vector3d> points_m = ExpectedPointsM(prior, beams, board, reach_m);
  if (points_m.size() < kMinBoardHits) return Because(LidarBoardMiss::kNoPlane);
  PlanarPatch patch;
  patch.middle_m = prior.T_lidar_board.translation();
  patch.plane.point_m = patch.middle_m;
  patch.plane.normal = prior.T_lidar_board.linear().col(2);
  for (double scale_m = reach_m / 2; scale_m > 0.02; scale_m /= 2) {
    patch.plane = FitPlaneRobustly(points_m, patch.plane, scale_m);
  }
  Measurement m = Begin(patch, beams, board, options);
  const Eigen::Vector3d width_axis = prior.T_lidar_board.linear().col(0);
  m.outline.pose = {Eigen::Vector2d::Zero(),
                    std::atan2(m.frame.e2.dot(width_axis), m.frame.e1.dot(width_axis))};
  m.outline.spill_m = m.model.spill_m;
  m.outline.thickness_m = m.model.thickness_m;
  if (auto none = FitPlaneAndOutline(cloud_lidar_m, &prior, &m)) return *none;
  if (!Finish(cloud_lidar_m, &m)) return Because(LidarBoardMiss::kNoPlane);
  auto decided = Decide(m, true, beams, cloud_lidar_m, board, options);
  if (decided && !FitsIn(decided->board.pose, prior)) return Because(LidarBoardMiss::kNoPlane);
  return decided;
}

}  // namespace voqcal
