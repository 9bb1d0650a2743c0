#include "core/assessment/fault_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

using FaultVector = Eigen::Matrix<double, kNumFaultParameters, 1>;
using ModelVector = Eigen::Matrix<double, kNumModelParameters, 1>;

// Steps of the numeric derivatives: small against what matters, large against rounding.
constexpr double kExtrinsicStep = 1e-5;  // rad and m
const FaultVector kFaultSteps = (FaultVector() << 1e-4, 0.1, 0.1, 1e-4, 1e-4).finished();

// No fit is believed to be better than this: exact data must not make noise levels of zero.
constexpr NoiseLevels kLeastNoise = {2e-4, 5e-4, 5e-4, 5e-4};
constexpr NoiseLevels kFirstNoise = {3e-3, 1e-2, 1e-2, 5e-3};
constexpr std::array<int, kNumResidualKinds> kRowsOfKind = {2, 1, 2, 1};

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

// The camera's board if the camera and the squares are as `fault` says; nothing without corners.
std::optional<Eigen::Isometry3d> CameraBoardWith(const FaultVector& fault,
                                                 const BoardSample& sample,
                                                 const BoardSpec& board,
                                                 const CameraModel& camera) {
  BoardSpec true_board = board;
  true_board.square_m *= 1 + fault[kSquareScale];
  CameraModel true_camera = camera;
  true_camera.fx_px *= 1 + fault[kFocalScale];
  true_camera.fy_px *= 1 + fault[kFocalScale];
  true_camera.cx_px += fault[kPrincipalX];
  true_camera.cy_px += fault[kPrincipalY];
  const auto points_board_m = true_board.InnerCornersBoardM();
  if (sample.camera.corners_px.size() != points_board_m.size()) return std::nullopt;
  const auto fit = FitSeenCorners(true_camera, points_board_m, sample.camera.corners_px);
  if (!fit) return std::nullopt;
  return fit->T_camera_board;
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

FaultEquation MakeEquation(const BoardSample& sample,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar) {
  const BoardPose lidar = LidarPoseInCameraOrder(sample, T_camera_lidar);
  const auto camera_board = [&](const FaultVector& fault) {
    return CameraBoardWith(fault, sample, board, camera)
        .value_or(TransformFromPose(sample.camera.pose));
  };
  const Eigen::Isometry3d T_lidar_board = LidarBoardWithout(0, lidar);
  const Eigen::Isometry3d T_camera_board = camera_board(FaultVector::Zero());
  const auto moved = [&](const Vector6d& delta) {
    return Residual(PerturbLeft(T_camera_lidar, delta), T_lidar_board, T_camera_board);
  };
  const auto faulty = [&](const FaultVector& fault) {
    return Residual(
        T_camera_lidar, LidarBoardWithout(fault[kRangeOffset], lidar), camera_board(fault));
  };
  FaultEquation equation;
  equation.sample_id = sample.id;
  equation.r = moved(Vector6d::Zero());
  for (int i = 0; i < kNumExtrinsicParameters; ++i) {
    const Vector6d step = kExtrinsicStep * Vector6d::Unit(i);
    equation.J.col(i) = (moved(step) - moved(-step)) / (2 * kExtrinsicStep);
  }
  for (int i = 0; i < kNumFaultParameters; ++i) {
    const FaultVector step = kFaultSteps[i] * FaultVector::Unit(i);
    equation.J.col(kNumExtrinsicParameters + i) =
        (faulty(step) - faulty(-step)) / (2 * kFaultSteps[i]);
  }
  return equation;
}

// The columns of the model that are fitted: the extrinsic's and those of the faults.
std::vector<int> Columns(const std::vector<FaultParameter>& faults) {
  std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  for (const FaultParameter fault : faults) columns.push_back(kNumExtrinsicParameters + fault);
  return columns;
}

struct NormalEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

void Add(const FaultEquation& equation,
         const std::vector<int>& columns,
         const NoiseLevels& noise,
         double sign,
         NormalEquations* sum) {
  Eigen::MatrixXd J(6, static_cast<Eigen::Index>(columns.size()));
  Vector6d r = equation.r;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    J.col(static_cast<Eigen::Index>(i)) = equation.J.col(columns[i]);
  }
  for (int row = 0; row < 6; ++row) {
    const double sigma = noise[KindOfRow(row)];
    J.row(row) /= sigma;
    r[row] /= sigma;
  }
  sum->H += sign * J.transpose() * J;
  sum->b -= sign * J.transpose() * r;
}

NormalEquations SumOf(const std::vector<FaultEquation>& equations,
                      const std::vector<int>& columns,
                      const NoiseLevels& noise) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  NormalEquations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const FaultEquation& equation : equations) Add(equation, columns, noise, 1, &sum);
  return sum;
}

// Nothing if the equations leave a parameter open. Columns are scaled to unit length first, as
// their units differ.
std::optional<Eigen::MatrixXd> InverseOf(const Eigen::MatrixXd& H) {
  constexpr double kLeastShare = 1e-9;  // of a column that is not a combination of the others
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return std::nullopt;
  const Eigen::MatrixXd unit =
      scale.cwiseInverse().asDiagonal() * H * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> solver(unit);
  if (!(solver.vectorD().minCoeff() > kLeastShare)) return std::nullopt;
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));
  return Eigen::MatrixXd(scale.cwiseInverse().asDiagonal() * inverse *
                         scale.cwiseInverse().asDiagonal());
}

ModelVector Scattered(const Eigen::VectorXd& fitted, const std::vector<int>& columns, double rest) {
  ModelVector all = ModelVector::Constant(rest);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all[columns[i]] = fitted[static_cast<Eigen::Index>(i)];
  }
  return all;
}

std::array<double, kNumResidualKinds> SquaresOf(const std::vector<FaultEquation>& equations,
                                                const ModelVector& value) {
  std::array<double, kNumResidualKinds> squares{};
  for (const FaultEquation& equation : equations) {
    const Vector6d left = equation.r + equation.J * value;
    for (int row = 0; row < 6; ++row) squares[KindOfRow(row)] += left[row] * left[row];
  }
  return squares;
}

double CentreErrorM(const FaultEquation& equation, const ModelVector& value) {
  return (equation.r + equation.J * value).head<3>().norm();
}

double HeldOutErrorM(const std::vector<FaultEquation>& equations,
                     const std::vector<int>& columns,
                     const NoiseLevels& noise) {
  const NormalEquations all = SumOf(equations, columns, noise);
  double sum_m = 0;
  for (const FaultEquation& equation : equations) {
    NormalEquations others = all;
    Add(equation, columns, noise, -1, &others);
    const auto inverse = InverseOf(others.H);
    if (!inverse) return std::numeric_limits<double>::infinity();
    sum_m += CentreErrorM(equation, Scattered(*inverse * others.b, columns, 0));
  }
  return sum_m / static_cast<double>(equations.size());
}

}  // namespace

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

FaultFit FitFaults(const std::vector<FaultEquation>& equations,
                   const std::vector<FaultParameter>& faults) {
  constexpr int kNumRounds = 20;  // the levels settle to a per mille within about ten
  const std::vector<int> columns = Columns(faults);
  const double num_samples = static_cast<double>(equations.size());
  FaultFit fit;
  fit.noise = kFirstNoise;
  for (int round = 0; round < kNumRounds; ++round) {
    const NormalEquations sum = SumOf(equations, columns, fit.noise);
    const auto inverse = InverseOf(sum.H);
    if (!inverse) return {};
    fit.value = Scattered(*inverse * sum.b, columns, 0);
    fit.standard_error = Scattered(
        inverse->diagonal().cwiseSqrt(), columns, std::numeric_limits<double>::quiet_NaN());
    fit.squares = SquaresOf(equations, fit.value);
    fit.log_likelihood = 0;
    for (std::size_t kind = 0; kind < fit.noise.size(); ++kind) {
      const double num_rows = num_samples * kRowsOfKind[kind];
      fit.noise[kind] = std::max(kLeastNoise[kind], std::sqrt(fit.squares[kind] / num_rows));
      fit.log_likelihood -= num_rows * std::log(fit.noise[kind]) +
                            fit.squares[kind] / (2 * fit.noise[kind] * fit.noise[kind]);
    }
  }
  fit.is_usable = true;
  for (const double error_m : CentreErrorsM(equations, fit)) {
    fit.mean_error_m += error_m / num_samples;
  }
  fit.mean_held_out_error_m = HeldOutErrorM(equations, columns, fit.noise);
  return fit;
}

std::vector<double> CentreErrorsM(const std::vector<FaultEquation>& equations,
                                  const FaultFit& fit) {
  std::vector<double> errors_m;
  for (const FaultEquation& equation : equations) {
    errors_m.push_back(CentreErrorM(equation, fit.value));
  }
  return errors_m;
}

}  // namespace voqcal
