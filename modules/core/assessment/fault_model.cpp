#include "core/assessment/fault_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/estimation/sighting_errors.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

using FaultVector = Eigen::Matrix<double, kNumFaultParameters, 1>;
using FaultJacobian = Eigen::Matrix<double, 6, kNumFaultParameters>;

constexpr double kStep = 1e-5;  // of all numeric derivatives: rad, m, and shares

// No fit is believed to be better than this: exact data must not make noise levels of zero.
constexpr NoiseLevels kLeastNoise = {2e-4, 5e-4, 5e-4, 5e-4, 0.02};
constexpr NoiseLevels kFirstNoise = {3e-3, 1e-2, 1e-2, 5e-3, 0.3};
constexpr std::array<int, kCorner> kRowsOfKind = {2, 1, 2, 1};
// 1 sigma of the parameters that have a prior, the same as the result's: the others are free.
struct Prior {
  FaultParameter fault;
  double sigma;
};
constexpr std::array<Prior, 2> kPriors = {Prior{kChessboardTurnX, kPriorChessboardTurnRad},
                                          Prior{kChessboardTurnY, kPriorChessboardTurnRad}};
// Neighbouring corners err alike, by what no lens model has: so many tell as much as all of them.
constexpr double kIndependentCorners = 0.1;

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
  const double weight = sign * kIndependentCorners / (noise[kCorner] * noise[kCorner]);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    sum->b[row] += weight * equation.corners.pull[columns[i]];
    for (std::size_t k = 0; k < columns.size(); ++k) {
      sum->H(row, static_cast<Eigen::Index>(k)) +=
          weight * equation.corners.information(columns[i], columns[k]);
    }
  }
}

NormalEquations SumOf(const std::vector<FaultEquation>& equations,
                      const std::vector<int>& columns,
                      const NoiseLevels& noise) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  NormalEquations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const FaultEquation& equation : equations) Add(equation, columns, noise, 1, &sum);
  for (const Prior& prior : kPriors) {
    const auto column =
        std::find(columns.begin(), columns.end(), kNumExtrinsicParameters + prior.fault);
    if (column == columns.end()) continue;
    const Eigen::Index i = column - columns.begin();
    sum.H(i, i) += 1 / (prior.sigma * prior.sigma);
  }
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

ModelVector Scattered(const Eigen::VectorXd& fitted, const std::vector<int>& columns) {
  ModelVector all = ModelVector::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all[columns[i]] = fitted[static_cast<Eigen::Index>(i)];
  }
  return all;
}

ModelMatrix Scattered(const Eigen::MatrixXd& fitted, const std::vector<int>& columns) {
  ModelMatrix all = ModelMatrix::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all.col(columns[i]) =
        Scattered(Eigen::VectorXd(fitted.col(static_cast<Eigen::Index>(i))), columns);
  }
  return all;
}

double NumRows(const std::vector<FaultEquation>& equations, std::size_t kind) {
  if (kind != kCorner) return kRowsOfKind[kind] * static_cast<double>(equations.size());
  double num = 0;
  for (const FaultEquation& equation : equations)
    num += kIndependentCorners * equation.corners.num_rows;
  return num;
}

std::array<double, kNumResidualKinds> SquaresOf(const std::vector<FaultEquation>& equations,
                                                const ModelVector& value) {
  std::array<double, kNumResidualKinds> squares{};
  for (const FaultEquation& equation : equations) {
    const Vector6d left = equation.r + equation.J * value;
    for (int row = 0; row < 6; ++row) squares[KindOfRow(row)] += left[row] * left[row];
    const CornerTerms& corners = equation.corners;
    squares[kCorner] += kIndependentCorners * (corners.squares - 2 * corners.pull.dot(value) +
                                               value.dot(corners.information * value));
  }
  return squares;
}

double CentreErrorM(const FaultEquation& equation, const ModelVector& value) {
  return (equation.r + equation.J * value).head<3>().norm();
}

// Infinite where the other samples leave a parameter open.
std::vector<double> HeldOutErrorsM(const std::vector<FaultEquation>& equations,
                                   const std::vector<int>& columns,
                                   const NoiseLevels& noise) {
  const NormalEquations all = SumOf(equations, columns, noise);
  std::vector<double> errors_m;
  for (const FaultEquation& equation : equations) {
    NormalEquations others = all;
    Add(equation, columns, noise, -1, &others);
    const auto inverse = InverseOf(others.H);
    errors_m.push_back(
        inverse ? CentreErrorM(equation, Scattered(Eigen::VectorXd(*inverse * others.b), columns))
                : std::numeric_limits<double>::infinity());
  }
  return errors_m;
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

double FaultFit::StandardError(FaultParameter fault) const {
  const int i = kNumExtrinsicParameters + fault;
  return std::sqrt(covariance(i, i));
}

Vector6d FaultFit::ExtrinsicBy(FaultParameter fault) const {
  const int i = kNumExtrinsicParameters + fault;
  return covariance.block<6, 1>(0, i) / covariance(i, i);
}

CameraModel CameraWith(const FaultFit& fit, const CameraModel& given) {
  return CameraWith(FaultVector(fit.value.tail<kNumFaultParameters>()), given);
}

BoardSpec BoardWith(const FaultFit& fit, const BoardSpec& given) {
  return BoardWith(FaultVector(fit.value.tail<kNumFaultParameters>()), given);
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
    fit.value = Scattered(Eigen::VectorXd(*inverse * sum.b), columns);
    fit.covariance = Scattered(*inverse, columns);
    fit.squares = SquaresOf(equations, fit.value);
    fit.log_likelihood = 0;
    for (const Prior& prior : kPriors) {
      fit.log_likelihood -= 0.5 * std::pow(fit.Value(prior.fault) / prior.sigma, 2);
    }
    for (std::size_t kind = 0; kind < fit.noise.size(); ++kind) {
      const double num_rows = NumRows(equations, kind);
      if (num_rows == 0) continue;
      fit.noise[kind] = std::max(kLeastNoise[kind], std::sqrt(fit.squares[kind] / num_rows));
      fit.log_likelihood -= num_rows * std::log(fit.noise[kind]) +
                            fit.squares[kind] / (2 * fit.noise[kind] * fit.noise[kind]);
    }
  }
  fit.is_usable = true;
  for (const double error_m : CentreErrorsM(equations, fit)) {
    fit.mean_error_m += error_m / num_samples;
  }
  fit.held_out_errors_m = HeldOutErrorsM(equations, columns, fit.noise);
  for (const double error_m : fit.held_out_errors_m) {
    fit.mean_held_out_error_m += error_m / num_samples;
  }
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
