#include "core/guidance/expected_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "core/estimation/left_perturbation.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/lidar_bias.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// A covariance that is still regular where nothing is known: a metre, a radian.
constexpr double kLeastInformation = 1.0;
static_assert(kMaxRings == 256, "Problems() says so");

double AzimuthRad(const Eigen::Vector3d& point_m) { return std::atan2(point_m.y(), point_m.x()); }

double ElevationRad(const Eigen::Vector3d& point_m) {
  return std::atan2(point_m.z(), point_m.head<2>().norm());
}

// Angles of view that a board covers, azimuths counted from its centre's.
struct ViewBounds {
  double min_azimuth_rad = std::numeric_limits<double>::infinity();
  double max_azimuth_rad = -std::numeric_limits<double>::infinity();
  double min_elevation_rad = std::numeric_limits<double>::infinity();
  double max_elevation_rad = -std::numeric_limits<double>::infinity();
};

ViewBounds BoundsOf(const BoardPose& pose_lidar) {
  ViewBounds bounds;
  for (const Eigen::Vector3d& corner_m : pose_lidar.corners_m) {
    const double azimuth_rad =
        std::remainder(AzimuthRad(corner_m) - AzimuthRad(pose_lidar.centre_m), 2.0 * M_PI);
    bounds.min_azimuth_rad = std::min(bounds.min_azimuth_rad, azimuth_rad);
    bounds.max_azimuth_rad = std::max(bounds.max_azimuth_rad, azimuth_rad);
    bounds.min_elevation_rad = std::min(bounds.min_elevation_rad, ElevationRad(corner_m));
    bounds.max_elevation_rad = std::max(bounds.max_elevation_rad, ElevationRad(corner_m));
  }
  return bounds;
}

// The returns of one row on the board, thinned: where they lie, in lidar and board.
struct Row {
  std::vector<Eigen::Vector3d> points_lidar_m;
  std::vector<Eigen::Vector2d> points_board_m;
};

class RowCaster {
 public:
  RowCaster(const Eigen::Isometry3d& T_lidar_board, const BoardSpec& board, double column_step_rad)
      : T_lidar_board_(T_lidar_board),
        T_board_lidar_(T_lidar_board.inverse()),
        half_size_m_(board.width_m / 2, board.height_m / 2),
        step_rad_(kExpectedThinning * column_step_rad) {}

  Row Cast(double elevation_rad, const ViewBounds& bounds) const {
    const double centre_azimuth_rad = AzimuthRad(T_lidar_board_.translation());
    const Eigen::Vector3d normal = T_lidar_board_.linear().col(2);
    const double plane_m = normal.dot(T_lidar_board_.translation());
    Row row;
    for (double azimuth_rad = bounds.min_azimuth_rad; azimuth_rad <= bounds.max_azimuth_rad;
         azimuth_rad += step_rad_) {
      const double absolute_rad = centre_azimuth_rad + azimuth_rad;
      const Eigen::Vector3d ray(std::cos(elevation_rad) * std::cos(absolute_rad),
                                std::cos(elevation_rad) * std::sin(absolute_rad),
                                std::sin(elevation_rad));
      const Eigen::Vector3d point_lidar_m = plane_m / normal.dot(ray) * ray;
      const Eigen::Vector2d point_board_m = (T_board_lidar_ * point_lidar_m).head<2>();
      if ((point_board_m.cwiseAbs() - half_size_m_).maxCoeff() > 0.0) continue;
      row.points_lidar_m.push_back(point_lidar_m);
      row.points_board_m.push_back(point_board_m);
    }
    return row;
  }

 private:
  Eigen::Isometry3d T_lidar_board_;
  Eigen::Isometry3d T_board_lidar_;
  Eigen::Vector2d half_size_m_;
  double step_rad_;
};

// Of [x; y; turn; spill; thickness]: where the rectangle is in its plane, how far hits end past its
// edges, and how thick the plate is (see OutlineModel, board/outline_fit.hpp).
using OutlineVector = Eigen::Matrix<double, 5, 1>;
using OutlineInformation = Eigen::Matrix<double, 5, 5>;

OutlineInformation PriorInformation(const LidarBoardOptions& detector) {
  OutlineVector sigmas(1.0, 1.0, 1.0, detector.beam.spill_sigma_m, detector.thickness_sigma_m);
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// @param lean  how far the lidar's ray moves in the plane for each metre below the face.
OutlineInformation InformationOfEnds(const Row& row,
                                     const BoardSpec& board,
                                     const Eigen::Vector2d& lean,
                                     const LidarBeamOptions& beam) {
  const Eigen::Vector2d along = row.points_board_m.back() - row.points_board_m.front();
  const double num_gaps = kExpectedThinning * static_cast<double>(row.points_board_m.size() - 1);
  const double spacing_m = along.norm() / num_gaps;
  const double blur_m = beam.blur_m + beam.blur_per_m * row.points_lidar_m.front().norm();
  const double sigma_along_m = std::sqrt(spacing_m * (blur_m + spacing_m / 12.0));
  const Eigen::Vector2d u = along.normalized();
  OutlineInformation information = OutlineInformation::Zero();
  for (const Eigen::Vector2d& p : {row.points_board_m.front(), row.points_board_m.back()}) {
    const Eigen::Vector2d inside_m =
        Eigen::Vector2d(board.width_m / 2, board.height_m / 2) - p.cwiseAbs();
    const Eigen::Vector2d e = inside_m.x() < inside_m.y()
                                  ? Eigen::Vector2d(std::copysign(1.0, p.x()), 0.0)
                                  : Eigen::Vector2d(0.0, std::copysign(1.0, p.y()));
    // An edge along the row is found no better than the row's returns are apart.
    const double sigma_m = std::max(std::abs(e.dot(u)), 0.1) * sigma_along_m;
    OutlineVector g;
    g << e, p.x() * e.y() - p.y() * e.x(), 1.0, std::max(-e.dot(lean), 0.0);
    information += g * g.transpose() / (sigma_m * sigma_m);
  }
  return information;
}

// Of [rotation; translation] on the lidar's side: what is in the board's plane.
Matrix6d InPlaneCovariance(const OutlineInformation& information,
                           const Eigen::Matrix3d& R_lidar_board) {
  const OutlineInformation covariance = information.inverse();
  Eigen::Matrix<double, 6, 3> J = Eigen::Matrix<double, 6, 3>::Zero();
  J.block<3, 1>(0, 2) = R_lidar_board.col(2);
  J.block<3, 2>(3, 0) = R_lidar_board.leftCols<2>();
  return J * covariance.topLeftCorner<3, 3>() * J.transpose();
}

LidarBoard ExpectedLidarBoard(const Eigen::Isometry3d& T_lidar_board,
                              const BoardSpec& board,
                              const SensorExpectation& expectation) {
  LidarBoard lidar;
  lidar.pose = PoseFromTransform(T_lidar_board, board);
  lidar.edge_lengths_m = board.EdgeLengthsM();
  lidar.points_lidar_m.has_ring = true;
  const ViewBounds bounds = BoundsOf(lidar.pose);
  const RowCaster caster(T_lidar_board, board, expectation.column_step_rad);
  const Eigen::Vector3d ray_board = T_lidar_board.linear().transpose() * lidar.pose.centre_m;
  const Eigen::Vector2d lean = -ray_board.head<2>() / ray_board.z();
  OutlineInformation information = PriorInformation(expectation.detector);
  for (int i = 0; i < expectation.num_rows; ++i) {
    const double elevation_rad = expectation.min_elevation_rad + i * expectation.RowStepRad();
    if (elevation_rad < bounds.min_elevation_rad) continue;
    if (elevation_rad > bounds.max_elevation_rad) break;
    const Row row = caster.Cast(elevation_rad, bounds);
    if (row.points_lidar_m.size() < 2) continue;
    ++lidar.num_beams;
    for (const Eigen::Vector3d& point_m : row.points_lidar_m) {
      LidarPoint point;
      point.position_m = point_m.cast<float>();
      point.ring = static_cast<std::uint16_t>(i);
      lidar.points_lidar_m.points.push_back(point);
    }
    information += InformationOfEnds(row, board, lean, expectation.detector.beam);
  }
  lidar.pose.covariance = InPlaneCovariance(information, T_lidar_board.linear());
  return lidar;
}

CameraBoard ExpectedCameraBoard(const Eigen::Isometry3d& T_camera_board,
                                const BoardSpec& board,
                                const CameraModel& camera,
                                double corner_noise_px) {
  CameraBoard seen;
  seen.pose = PoseFromTransform(T_camera_board, board);
  Matrix6d information = Matrix6d::Zero();
  for (const Eigen::Vector3d& corner_board_m : board.InnerCornersBoardM()) {
    const Eigen::Vector3d corner_camera_m = T_camera_board * corner_board_m;
    Matrix23d J_px_point;
    seen.corners_px.push_back(ProjectWithJacobian(camera, corner_camera_m, &J_px_point));
    Matrix36d J_point;
    J_point << -Skew(corner_camera_m - seen.pose.centre_m), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> J = J_px_point * J_point;
    information += J.transpose() * J;
  }
  information.diagonal().array() += kLeastInformation;
  seen.pose.covariance =
      corner_noise_px * corner_noise_px * information.llt().solve(Matrix6d::Identity());
  return seen;
}

}  // namespace

std::vector<std::string> SensorExpectation::Problems() const {
  ProblemList problems;
  problems.Require(min_elevation_rad >= -M_PI / 2,
                   "min_elevation_deg must be at least -90",
                   kDegPerRad * min_elevation_rad);
  problems.Require(max_elevation_rad <= M_PI / 2,
                   "max_elevation_deg must be at most 90",
                   kDegPerRad * max_elevation_rad);
  problems.Require(max_elevation_rad > min_elevation_rad,
                   "max_elevation_deg must exceed min_elevation_deg",
                   kDegPerRad * max_elevation_rad);
  problems.Require(max_azimuth_rad > 0.0 && max_azimuth_rad <= M_PI,
                   "max_azimuth_deg must be within 0 and 180",
                   kDegPerRad * max_azimuth_rad);
  problems.Require(num_rows >= 2, "num_rows must be at least 2", num_rows);
  // An offset of each row is an unknown of a dense equation.
  problems.Require(
      num_rows <= static_cast<int>(kMaxRings), "num_rows must be at most 256", num_rows);
  problems.Require(column_step_rad > 0.0 && column_step_rad < 0.1,
                   "column_step_deg must be within 0 and 5",
                   kDegPerRad * column_step_rad);
  problems.RequirePositive("corner_noise_px", corner_noise_px);
  return problems.lines();
}

BoardSample ExpectedSample(const Eigen::Isometry3d& T_camera_board,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const SensorExpectation& expectation) {
  BoardSample sample;
  sample.lidar = ExpectedLidarBoard(T_camera_lidar.inverse() * T_camera_board, board, expectation);
  sample.camera = ExpectedCameraBoard(T_camera_board, board, camera, expectation.corner_noise_px);
  return sample;
}

}  // namespace voqcal
