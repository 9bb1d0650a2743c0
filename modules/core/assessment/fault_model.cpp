#include "core/assessment/fault_model.hpp"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

using FaultJacobian = Eigen::Matrix<double, 6, kNumFaultParameters>;

constexpr double kStep = 1e-5;  // of all numeric derivatives: rad, m, and shares

// The lidar's board if its ranges are too long by `offset_m`: each corner moves along its ray.
Eigen::Isometry3d LidarBoardWithout(double offset_m, const BoardPose& pose) {
  BoardPose moved = pose;
  const auto move = [offset_m](const Eigen::Vector3d& point_m) {
    return Eigen::Vector3d(point_m * (1 - offset_m / point_m.norm()));
  };
  moved.centre_m = move(pose.centre_m);
  for (std::size_t i = 0; i < 4; ++i) moved.corners_m[i] = move(pose.corners_m[i]);
  moved.normal = (moved.corners_m[2] - moved.corners_m[0])
                     .cross(moved.corners_m[3] - moved.corners_m[1])
                     .normalized();
  return TransformFromPose(moved);
}

// Pixels of the corners that were seen, of a board that is where it is and is as `fault` says.
Eigen::VectorXd PixelsWith(const FaultVector& fault,
                           const std::vector<std::size_t>& seen,
                           const Eigen::Isometry3d& T_camera_board,
                           const BoardSpec& board,
                           const CameraModel& camera) {
  const CameraModel true_camera = CameraWith(fault, camera);
  const auto corners_board_m = BoardWith(fault, board).InnerCornersBoardM();
  Eigen::VectorXd pixels(2 * static_cast<Eigen::Index>(seen.size()));
  Eigen::Index row = 0;
  for (const std::size_t i : seen) {
    const Eigen::Vector3d corner_camera_m = T_camera_board * corners_board_m[i];
    pixels.segment<2>(row) = true_camera.Project(corner_camera_m);
    row += 2;
  }
  return pixels;
}

/// How the camera's board answers to faults, and what its corners are left with.
struct CornerAnswer {
  FaultJacobian board_by_fault = FaultJacobian::Zero();  // S, left perturbation
  CornerTerms terms;
};

CornerAnswer AnswerOf(const BoardSample& sample,
                      const Eigen::Isometry3d& T_camera_board,
                      const BoardSpec& board,
                      const CameraModel& camera) {
  CornerAnswer answer;
  const auto corners_board_m = board.InnerCornersBoardM();
  const std::vector<std::size_t> seen = SeenCorners(sample, corners_board_m.size());
  if (seen.size() < 4) return answer;
  const auto num_rows = 2 * static_cast<Eigen::Index>(seen.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> J(num_rows, 6);
  Eigen::Matrix<double, Eigen::Dynamic, kNumFaultParameters> L(num_rows, kNumFaultParameters);
  Eigen::VectorXd e(num_rows);
  Eigen::Index row = 0;
  for (const std::size_t i : seen) {
    const Eigen::Vector3d arm_m = T_camera_board.linear() * corners_board_m[i];
    Matrix23d J_px_point;
    Matrix36d J_point;
    J_point << -Skew(arm_m), Eigen::Matrix3d::Identity();
    e.segment<2>(row) =
        ProjectWithJacobian(camera, T_camera_board.translation() + arm_m, &J_px_point) -
        sample.camera.corners_px[i];
    J.middleRows<2>(row) = J_px_point * J_point;
    row += 2;
  }
  for (int i = 0; i < kNumFaultParameters; ++i) {
    const FaultVector step = kStep * FaultVector::Unit(i);
    L.col(i) = (PixelsWith(step, seen, T_camera_board, board, camera) -
                PixelsWith(-step, seen, T_camera_board, board, camera)) /
               (2 * kStep);
  }
  const Eigen::LDLT<Matrix6d> of_board(J.transpose() * J);
  answer.board_by_fault = -of_board.solve(J.transpose() * L);
  const Eigen::MatrixXd left = L + J * answer.board_by_fault;
  const Eigen::VectorXd left_e = e - J * of_board.solve(J.transpose() * e);
  answer.terms.num_rows = static_cast<int>(num_rows);
  answer.terms.information.bottomRightCorner<kNumFaultParameters, kNumFaultParameters>() =
      left.transpose() * left;
  answer.terms.pull.tail<kNumFaultParameters>() = -left.transpose() * left_e;
  answer.terms.squares = left_e.squaredNorm();
  return answer;
}

// Across x, y and along the camera's ray to the centre; tilt and spin in the board's axes.
Vector6d Residual(const Eigen::Isometry3d& T_camera_lidar,
                  const Eigen::Isometry3d& T_lidar_board,
                  const Eigen::Isometry3d& T_camera_board) {
  const Eigen::Isometry3d T_camera_board_by_lidar = T_camera_lidar * T_lidar_board;
  const Eigen::Vector3d ray = T_camera_board.translation().normalized();
  const Eigen::Vector3d across_x = Eigen::Vector3d::UnitY().cross(ray).normalized();
  const Eigen::Vector3d across_y = ray.cross(across_x);
  const Eigen::Vector3d off_m =
      T_camera_board_by_lidar.translation() - T_camera_board.translation();
  Vector6d r;
  r << across_x.dot(off_m), across_y.dot(off_m), ray.dot(off_m),
      LogSO3(T_camera_board.linear().transpose() * T_camera_board_by_lidar.linear());
  return r;
}

template <typename At>
Eigen::Matrix<double, 6, 6> Derivative(const At& at) {
  Eigen::Matrix<double, 6, 6> J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    J.col(i) = (at(step) - at(-step)) / (2 * kStep);
  }
  return J;
}

FaultEquation MakeEquation(const BoardSample& sample,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar) {
  const BoardPose lidar = LidarPoseInCameraOrder(sample, T_camera_lidar);
  const Eigen::Isometry3d T_lidar_board = LidarBoardWithout(0, lidar);
  const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
  const CornerAnswer camera_answer = AnswerOf(sample, T_camera_board, board, camera);
  FaultEquation equation;
  equation.sample_id = sample.id;
  equation.corners = camera_answer.terms;
  equation.r = Residual(T_camera_lidar, T_lidar_board, T_camera_board);
  equation.J.leftCols<6>() = Derivative([&](const Vector6d& delta) {
    return Residual(PerturbLeft(T_camera_lidar, delta), T_lidar_board, T_camera_board);
  });
  equation.J.rightCols<kNumFaultParameters>() =
      Derivative([&](const Vector6d& delta) {
        return Residual(T_camera_lidar, T_lidar_board, PerturbLeft(T_camera_board, delta));
      }) *
      camera_answer.board_by_fault;
  const auto with_turn = [&](double turn_x_rad, double turn_y_rad) {
    Eigen::Isometry3d turned = T_camera_board;
    turned.linear() = ExpSO3({turn_x_rad, turn_y_rad, 0.0}) * T_camera_board.linear();
    return Residual(T_camera_lidar, T_lidar_board, turned);
  };
  equation.J.col(kNumExtrinsicParameters + kChessboardTurnX) =
      (with_turn(kStep, 0.0) - with_turn(-kStep, 0.0)) / (2 * kStep);
  equation.J.col(kNumExtrinsicParameters + kChessboardTurnY) =
      (with_turn(0.0, kStep) - with_turn(0.0, -kStep)) / (2 * kStep);
  const auto with_offset = [&](double offset_m) {
    return Residual(T_camera_lidar, LidarBoardWithout(offset_m, lidar), T_camera_board);
  };
  equation.J.col(kNumExtrinsicParameters + kRangeOffset) =
      (with_offset(kStep) - with_offset(-kStep)) / (2 * kStep);
  return equation;
}

}  // namespace

CameraModel CameraWith(const FaultVector& fault, const CameraModel& given) {
  CameraModel camera = given;
  camera.fx_px *= 1 + fault[kFocalScale] + fault[kFocalXScale];
  camera.fy_px *= 1 + fault[kFocalScale] + fault[kFocalYScale];
  camera.cx_px += fault[kPrincipalX];
  camera.cy_px += fault[kPrincipalY];
  for (int i = 0; i < kSquareScale - kDistortion; ++i) {
    if (i < NumDistortion(camera.lens)) {
      camera.distortion[static_cast<std::size_t>(i)] += fault[kDistortion + i];
    }
  }
  return camera;
}

BoardSpec BoardWith(const FaultVector& fault, const BoardSpec& given) {
  BoardSpec board = given;
  board.square_m *= 1 + fault[kSquareScale];
  board.pattern_offset_x_m += fault[kPatternX];
  board.pattern_offset_y_m += fault[kPatternY];
  return board;
}

ResidualKind KindOfRow(int row) {
  constexpr std::array<ResidualKind, 6> kKinds = {kAcross, kAcross, kAlong, kTilt, kTilt, kSpin};
  return kKinds[static_cast<std::size_t>(row)];
}

std::vector<FaultEquation> MakeFaultEquations(const std::vector<const BoardSample*>& samples,
                                              const BoardSpec& board,
                                              const CameraModel& camera,
                                              const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<FaultEquation> equations;
  for (const BoardSample* sample : samples) {
    if (!IsCentreMeasured(sample->lidar)) continue;
    equations.push_back(MakeEquation(*sample, board, camera, T_camera_lidar));
  }
  return equations;
}

}  // namespace voqcal
