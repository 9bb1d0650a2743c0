#include "core/board/board_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/board/outline_checks.hpp"
#include "core/board/outline_edges.hpp"
#include "core/board/outline_fit.hpp"
#include "core/board/patch_view.hpp"
#include "core/board/plane_fit.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinHits = 30;  // fewer cannot measure a board

/// The beam across, measured on 30 sweeps of a VLP-16 (1.7 to 3.2 m): hits end 5 mm past the edge
/// whatever the range, and beams turn from hit to miss within 3 to 4 mm. Doubling or halving any of
/// these moves the centres by less than 1 mm.
OutlineModel ModelOf(const BoardSpec& board, double range_m) {
  OutlineModel model;
  model.width_m = board.width_m;
  model.height_m = board.height_m;
  model.blur_m = 0.002 + 0.0005 * range_m;
  model.spill_m = 0.005;
  model.spill_sigma_m = 0.004;
  model.thickness_m = 0.01;  // a plate is a few millimetres thick, a foam board 20 or so
  model.thickness_sigma_m = 0.01;
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
  PlaneFrame frame;
  OutlineModel model;
  OutlineFit outline;
  std::vector<std::size_t> board_hits;  // for view.Beam()
};

/// The beams around a patch, on its own plane.
Measurement Begin(const PlanarPatch& patch, const BeamIndex& beams, const BoardSpec& board) {
  PlaneFit plane = patch.plane;
  plane.point_m = patch.middle_m - plane.DistanceM(patch.middle_m) * plane.normal;
  const double diagonal_m = std::hypot(board.width_m, board.height_m);
  Measurement m{PatchView(beams, plane.point_m, diagonal_m), PlaneFrame(plane), {}, {}, {}};
  m.model = ModelOf(board, plane.point_m.norm());
  m.view.Classify(m.frame);
  return m;
}

/// The plane of the points in the outline, and where the beams meet it. False if too few points are
/// left.
bool RefinePlane(Measurement* m) {
  constexpr double kPlaneScaleM = 0.02;  // Cauchy: twice the noise
  constexpr double kMarginM = -0.005;    // the outermost returns are partly of what lies behind
  m->board_hits = m->view.HitsInside(m->frame, m->model, m->outline.pose, kMarginM);
  if (m->board_hits.size() < kMinHits) return false;
  const Eigen::Isometry3d T_lidar_board = TransformOf(m->frame, m->outline.pose);
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Vector3d width_axis = T_lidar_board.linear().col(0);
  PlaneFit plane =
      FitPlaneRobustly(m->view.PositionsM(m->board_hits), m->frame.plane, kPlaneScaleM);
  plane.point_m = centre_m - plane.DistanceM(centre_m) * plane.normal;
  m->frame = PlaneFrame(plane);
  m->view.Classify(m->frame);
  const double angle_rad = std::atan2(m->frame.e2.dot(width_axis), m->frame.e1.dot(width_axis));
  m->outline.pose = {Eigen::Vector2d::Zero(), angle_rad};
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  return true;
}

/// Turns the rectangle upright and takes all its points. False if too few are left.
bool Finish(Measurement* m) {
  m->outline.pose = Upright(m->frame, m->outline.pose);
  m->model.lean = LeanOf(m->frame, m->outline.pose);
  m->outline = EvaluateOutline(m->view.Outline(), m->model, m->outline);
  m->board_hits = m->view.HitsInside(m->frame, m->model, m->outline.pose, 0.0);
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
                      const PointCloud& cloud_lidar_m) {
  const Eigen::Matrix3d R = T_lidar_board.linear();
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Matrix3d plane = PlaneCovariance(m.view.PositionsM(m.board_hits),
                                                RingsOf(m, cloud_lidar_m),
                                                m.frame.plane,
                                                centre_m,
                                                R.col(0),
                                                R.col(1));
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
  return from_plane * plane * from_plane.transpose() +
         from_outline * outline * from_outline.transpose();
}

LidarBoard Describe(const Measurement& m,
                    const std::array<double, 4>& edge_lengths_m,
                    const PointCloud& cloud_lidar_m,
                    const BoardSpec& board) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  LidarBoard found;
  found.pose = PoseFromTransform(T_lidar_board, board);
  found.pose.covariance = CovarianceOf(T_lidar_board, m, cloud_lidar_m);
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

bool AreLengthsNear(const std::array<double, 4>& measured_m, const std::array<double, 4>& true_m) {
  constexpr double kMaxErrorM = 0.15;  // three times what four scan lines leave open
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(std::abs(measured_m[i] - true_m[i]) <= kMaxErrorM)) return false;
  }
  return true;
}

}  // namespace

Expected<LidarBoard, LidarBoardMiss> MeasureBoard(const PlanarPatch& patch,
                                                  const BeamIndex& beams,
                                                  const PointCloud& cloud_lidar_m,
                                                  const BoardSpec& board) {
  constexpr double kRoughly = 2.0;
  constexpr double kMinCovered = 0.8;
  Measurement m = Begin(patch, beams, board);
  const std::vector<OutlineBeam>& outline_beams = m.view.Outline();
  if (!CouldShowBoard(outline_beams, m.model)) return LidarBoardMiss::kSizeMismatch;
  m.outline = SearchOutline(outline_beams, m.model, Eigen::Vector2d::Zero());
  // Plane and outline in turns: the outline says which points are the board's, and the plane where
  // the beams meet it.
  for (const double first_blur_m : {SearchBlurM(m.model) / 2, 3 * m.model.blur_m, 0.0}) {
    const Agreement agreement = AgreementOf(m);
    if (!agreement.IsBoardLike(kRoughly)) return LidarBoardMiss::kSizeMismatch;
    if (agreement.covered < kMinCovered / kRoughly) return LidarBoardMiss::kOutlineOpen;
    if (!RefinePlane(&m)) return LidarBoardMiss::kNoPlane;
    const bool is_last = first_blur_m == 0.0;
    m.outline = is_last ? RefineOutline(outline_beams, m.model, m.outline.pose)
                        : SharpenOutline(outline_beams, m.model, m.outline.pose, first_blur_m);
  }
  if (!Finish(&m)) return LidarBoardMiss::kNoPlane;
  const Agreement agreement = AgreementOf(m);
  if (!agreement.IsBoardLike()) return LidarBoardMiss::kSizeMismatch;
  const std::array<OutlineEdge, 4> edges = MeasureEdges(m.view.Outline(), m.model, m.outline.pose);
  const bool is_closed = std::all_of(edges.begin(), edges.end(), IsSeen);
  if (!is_closed || agreement.covered < kMinCovered) return LidarBoardMiss::kOutlineOpen;
  const std::array<double, 4> lengths_m = EdgeLengthsM(edges, m.model);
  if (!AreLengthsNear(lengths_m, board.EdgeLengthsM())) return LidarBoardMiss::kSizeMismatch;
  return Describe(m, lengths_m, cloud_lidar_m, board);
}

}  // namespace voqcal
