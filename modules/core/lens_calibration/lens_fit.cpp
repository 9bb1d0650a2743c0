#include "core/lens_calibration/lens_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "core/camera_detection/planar_pose.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr int kNumFocal = 4;  // fx fy cx cy

CameraModel CameraOf(const CameraModel& frame, const double* parameters) {
  CameraModel camera = frame;
  camera.fx_px = parameters[0];
  camera.fy_px = parameters[1];
  camera.cx_px = parameters[2];
  camera.cy_px = parameters[3];
  for (int i = 0; i < NumDistortion(camera.lens); ++i) {
    camera.distortion[static_cast<std::size_t>(i)] = parameters[kNumFocal + i];
  }
  return camera;
}

std::vector<double> ParametersOf(const CameraModel& camera) {
  std::vector<double> parameters = {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
  for (int i = 0; i < NumDistortion(camera.lens); ++i) {
    parameters.push_back(camera.distortion[static_cast<std::size_t>(i)]);
  }
  return parameters;
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Pixel errors of one view's seen corners:
///     r_i = project(lens, Exp(w) R p_i + t + d) - u_i               r: 2 N, px
/// Parameters: lens, fx fy cx cy and all coefficients; [w_rad; d_m], 6: PerturbLeft of
/// T_camera_board = (R, t).
class ViewErrors : public ceres::CostFunction {
 public:
  ViewErrors(const CameraModel& frame,
             const std::vector<Eigen::Vector3d>& corners_board_m,
             const LensView& view,
             const Eigen::Isometry3d& T_camera_board)
      : frame_(frame), t_camera_board_m_(T_camera_board.translation()) {
    for (std::size_t i = 0; i < corners_board_m.size(); ++i) {
      if (!view.corners_px[i].allFinite()) continue;
      arms_m_.push_back(T_camera_board.linear() * corners_board_m[i]);
      pixels_px_.push_back(view.corners_px[i]);
    }
    set_num_residuals(static_cast<int>(2 * pixels_px_.size()));
    *mutable_parameter_block_sizes() = {kNumFocal + NumDistortion(frame.lens), 6};
  }

  std::size_t num_corners() const { return pixels_px_.size(); }

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override {
    using Jet = ceres::Jet<double, 6>;
    const CameraModel camera = CameraOf(frame_, parameters[0]);
    double* J_lens = jacobians != nullptr ? jacobians[0] : nullptr;
    double* J_pose = jacobians != nullptr ? jacobians[1] : nullptr;
    Eigen::Matrix<Jet, 6, 1> delta;
    for (int k = 0; k < 6; ++k) delta[k] = Jet(parameters[1][k], k);
    for (std::size_t i = 0; i < pixels_px_.size(); ++i) {
      const Eigen::Matrix<Jet, 3, 1> arm = arms_m_[i].cast<Jet>();
      Eigen::Matrix<Jet, 3, 1> point;
      ceres::AngleAxisRotatePoint(delta.data(), arm.data(), point.data());
      point += t_camera_board_m_.cast<Jet>() + delta.tail<3>();
      const Eigen::Vector3d at_m(point[0].a, point[1].a, point[2].a);
      if (!camera.IsProjectable(at_m)) return false;
      const Eigen::Matrix<Jet, 2, 1> pixel = camera.Project(point);
      for (int row = 0; row < 2; ++row) {
        const auto at = 2 * static_cast<Eigen::Index>(i) + row;
        residuals[at] = pixel[row].a - pixels_px_[i][row];
        if (J_pose != nullptr) {
          Eigen::Map<Vector6d>(J_pose + 6 * at) = pixel[row].v;
        }
      }
      if (J_lens != nullptr) {
        const int columns = parameter_block_sizes()[0];
        Eigen::Map<Rows>(J_lens + 2 * static_cast<Eigen::Index>(i) * columns, 2, columns) =
            LensJacobian(camera, at_m);
      }
    }
    return true;
  }

 private:
  // Pixels are linear in the coefficients, or smooth (rational's denominator): differences are as
  // good as derivatives.
  Rows LensJacobian(const CameraModel& camera, const Eigen::Vector3d& point_m) const {
    constexpr double kStep = 1e-5;
    const Eigen::Vector2d pixel = camera.Project(point_m);
    Rows J = Rows::Zero(2, kNumFocal + NumDistortion(camera.lens));
    J(0, 0) = (pixel.x() - camera.cx_px) / camera.fx_px;
    J(1, 1) = (pixel.y() - camera.cy_px) / camera.fy_px;
    J(0, 2) = J(1, 3) = 1;
    CameraModel moved = camera;
    for (int k = 0; k < NumDistortion(camera.lens); ++k) {
      double& coefficient = moved.distortion[static_cast<std::size_t>(k)];
      const double value = coefficient;
      coefficient = value + kStep;
      const Eigen::Vector2d above = moved.Project(point_m);
      coefficient = value - kStep;
      J.col(kNumFocal + k) = (above - moved.Project(point_m)) / (2 * kStep);
      coefficient = value;
    }
    return J;
  }

  CameraModel frame_;
  Eigen::Vector3d t_camera_board_m_;
  std::vector<Eigen::Vector3d> arms_m_;  // R p
  std::vector<Eigen::Vector2d> pixels_px_;
};

// A weak belief that coefficients are small, r_k = kWeight k: where corners do not tell two of them
// apart (the rational model's numerator and denominator, above all) the smallest that fit are
// taken, rather than where a search happens to end. With corners to 0.1 px it is 1 sigma of 2.
constexpr double kWeightPx = 0.05;

class SmallCoefficients : public ceres::CostFunction {
 public:
  explicit SmallCoefficients(int num_coefficients) {
    set_num_residuals(num_coefficients);
    *mutable_parameter_block_sizes() = {kNumFocal + num_coefficients};
  }

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override {
    for (int k = 0; k < num_residuals(); ++k) {
      residuals[k] = kWeightPx * parameters[0][kNumFocal + k];
    }
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Rows> J(jacobians[0], num_residuals(), kNumFocal + num_residuals());
      J.setZero();
      J.rightCols(num_residuals()).diagonal().setConstant(kWeightPx);
    }
    return true;
  }
};

// Minimises over the poses and those of the lens' parameters that are not in `fixed`.
bool Solve(const std::vector<std::unique_ptr<ViewErrors>>& errors,
           const std::vector<int>& fixed,
           double huge_px,
           std::vector<double>* lens,
           std::vector<Vector6d>* poses) {
  SmallCoefficients small(static_cast<int>(lens->size()) - kNumFocal);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddParameterBlock(
      lens->data(),
      static_cast<int>(lens->size()),
      fixed.empty() ? nullptr : new ceres::SubsetManifold(static_cast<int>(lens->size()), fixed));
  problem.AddResidualBlock(&small, nullptr, lens->data());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double huge = huge_px * std::sqrt(static_cast<double>(errors[i]->num_corners()));
    problem.AddResidualBlock(errors[i].get(),
                             huge > 0 ? new ceres::CauchyLoss(huge) : nullptr,
                             lens->data(),
                             (*poses)[i].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 1e-12;
  options.num_threads = 1;  // sums in one order
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() &&
         std::all_of(lens->begin(), lens->end(), [](double x) { return std::isfinite(x); });
}

/// What one view says of the free parameters once its pose has taken what it can.
struct ViewInformation {
  Eigen::MatrixXd A;  // Jl'Jl - Jl'Jp (Jp'Jp)^-1 Jp'Jl
  Eigen::VectorXd u;  // Jl'r: at the minimum Jp'r = 0
  Eigen::MatrixXd J;  // Jl
};

ViewInformation InformationOf(const ViewErrors& errors,
                              const std::vector<double>& lens,
                              const Vector6d& pose,
                              int num_parameters) {
  const auto num_rows = static_cast<Eigen::Index>(errors.num_residuals());
  Eigen::VectorXd r(num_rows);
  Rows J_lens(num_rows, static_cast<Eigen::Index>(lens.size()));
  Rows J_pose(num_rows, 6);
  const double* parameters[] = {lens.data(), pose.data()};
  double* jacobians[] = {J_lens.data(), J_pose.data()};
  errors.Evaluate(parameters, r.data(), jacobians);
  const Eigen::MatrixXd Jl = J_lens.leftCols(num_parameters);
  const Eigen::MatrixXd cross = J_pose.transpose() * Jl;
  const Matrix6d pose_information = J_pose.transpose() * J_pose;
  return {Jl.transpose() * Jl - cross.transpose() * pose_information.ldlt().solve(cross),
          Jl.transpose() * r,
          Jl};
}

/// Inverse of a positive matrix whose rows have different units; infinite if it has none.
Eigen::MatrixXd InverseOrInfinite(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * A *
                                                             scale.asDiagonal());
  if (!(eigen.eigenvalues()(0) > 1e-13)) {
    return Eigen::MatrixXd::Constant(A.rows(), A.cols(), HUGE_VAL);
  }
  return scale.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose() *
         scale.asDiagonal();
}

// s^2 A^-1, s^2 the residuals' variance, times how much more the views pull to all sides than
// independent errors would have them do: their pulls u_v have then the covariance
// s^2 (A_v - A_v A^-1 A_v), so that
//     ratio = sum u_v' A^-1 u_v / (s^2 (L - sum tr((A^-1 A_v)^2)))
// is 1 on average.
Eigen::MatrixXd CovarianceOf(const std::vector<ViewInformation>& views,
                             double sum_px2,
                             std::size_t num_corners) {
  const Eigen::Index num_parameters = views[0].A.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(num_parameters, num_parameters);
  A.diagonal().tail(num_parameters - kNumFocal).setConstant(kWeightPx * kWeightPx);
  for (const ViewInformation& view : views) A += view.A;
  const double dof = 2.0 * static_cast<double>(num_corners) -
                     6.0 * static_cast<double>(views.size()) - static_cast<double>(num_parameters);
  const double variance_px2 = sum_px2 / std::max(1.0, dof);
  const Eigen::MatrixXd inverse = InverseOrInfinite(A);
  if (!inverse.allFinite()) return inverse;
  double pulls_px2 = 0;
  auto num_free = static_cast<double>(num_parameters);
  for (const ViewInformation& view : views) {
    const Eigen::MatrixXd share = inverse * view.A;
    pulls_px2 += view.u.dot(inverse * view.u);
    num_free -= (share * share).trace();
  }
  const double ratio = pulls_px2 / std::max(1e-300, variance_px2 * num_free);
  return variance_px2 * std::max(1.0, ratio) * inverse;
}

// An error d of the parameters moves the seen corners u_i by J_i d, of which a change of scale s
// about their middle m and a shift t take the most by least squares: [s; t] = (X'X)^-1 X'J d, with
// rows X_i = [u_i - m, I].
Eigen::Matrix3d ScaleAndShiftCovariance(const std::vector<ViewInformation>& informations,
                                        const std::vector<LensView>& views,
                                        const Eigen::MatrixXd& covariance) {
  if (!covariance.allFinite()) return Eigen::Matrix3d::Constant(HUGE_VAL);
  std::vector<Eigen::Vector2d> seen_px;
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  for (const LensView& view : views) {
    for (const Eigen::Vector2d& corner_px : view.corners_px) {
      if (!corner_px.allFinite()) continue;
      seen_px.push_back(corner_px);
      middle_px += corner_px;
    }
  }
  middle_px /= static_cast<double>(seen_px.size());
  Eigen::Matrix3d XX = Eigen::Matrix3d::Zero();
  Eigen::MatrixXd XJ = Eigen::MatrixXd::Zero(3, covariance.rows());
  std::size_t i = 0;
  for (const ViewInformation& view : informations) {
    for (Eigen::Index row = 0; row < view.J.rows(); row += 2, ++i) {
      Eigen::Matrix<double, 2, 3> X;
      X << seen_px[i] - middle_px, Eigen::Matrix2d::Identity();
      XX += X.transpose() * X;
      XJ += X.transpose() * view.J.middleRows<2>(row);
    }
  }
  const Eigen::MatrixXd M = XX.ldlt().solve(XJ);
  return M * covariance * M.transpose();
}

bool BringsEveryCornerToAPixel(const CameraModel& camera,
                               const std::vector<Eigen::Vector3d>& corners_board_m,
                               const LensView& view,
                               const Eigen::Isometry3d& T_camera_board) {
  for (std::size_t i = 0; i < corners_board_m.size(); ++i) {
    if (!view.corners_px[i].allFinite()) continue;
    if (!camera.IsInFront(T_camera_board * corners_board_m[i])) return false;
  }
  return true;
}

// Parameters that are not estimated: all from the first `num_free` on, and the principal point
// while the rest is far off.
std::vector<int> FixedOf(const LensForm& form, int num_free, bool is_centre_fixed) {
  std::vector<int> fixed;
  if (is_centre_fixed) fixed = {2, 3};
  for (int i = num_free; i < NumDistortion(form.lens); ++i) fixed.push_back(kNumFocal + i);
  return fixed;
}

}  // namespace

std::string ToString(const LensForm& form) {
  std::string name = ToString(form.lens);
  return form.num_free == NumDistortion(form.lens)
             ? name
             : name + Format(" with %d coefficients", form.num_free);
}

LensForm WholeForm(LensModel lens) { return {lens, NumDistortion(lens)}; }

const std::vector<LensForm>& LensForms() {
  static const std::vector<LensForm> kForms = {{LensModel::kPlumbBob, 2},
                                               WholeForm(LensModel::kEquidistant),
                                               WholeForm(LensModel::kPlumbBob),
                                               WholeForm(LensModel::kRational)};
  return kForms;
}

double LensFit::Sigma(int parameter) const { return std::sqrt(covariance(parameter, parameter)); }

std::optional<LensFit> FitLens(const LensForm& form,
                               const std::vector<Eigen::Vector3d>& corners_board_m,
                               const std::vector<LensView>& views,
                               const CameraModel& start,
                               double huge_px) {
  CameraModel frame = start;
  frame.lens = form.lens;
  std::fill(frame.distortion.begin() + form.num_free, frame.distortion.end(), 0.0);
  std::vector<Eigen::Isometry3d> T_camera_board;
  std::vector<std::unique_ptr<ViewErrors>> errors;
  for (const LensView& view : views) {
    const auto pose = FitSeenCorners(frame, corners_board_m, view.corners_px);
    if (!pose) return {};
    T_camera_board.push_back(pose->T_camera_board);
    errors.push_back(
        std::make_unique<ViewErrors>(frame, corners_board_m, view, pose->T_camera_board));
  }
  std::vector<double> lens = ParametersOf(frame);
  std::vector<Vector6d> poses(views.size(), Vector6d::Zero());
  const int num_first = std::min(2, form.num_free);
  if (!Solve(errors, FixedOf(form, num_first, true), huge_px, &lens, &poses) ||
      !Solve(errors, FixedOf(form, form.num_free, false), huge_px, &lens, &poses)) {
    return {};
  }

  LensFit fit;
  fit.form = form;
  fit.camera = CameraOf(frame, lens.data());
  if (!fit.camera.Problems().empty()) return {};
  std::vector<ViewInformation> informations;
  double sum_px2 = 0;
  std::size_t num_corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    fit.T_camera_board.push_back(PerturbLeft(T_camera_board[i], poses[i]));
    Eigen::VectorXd residuals(errors[i]->num_residuals());
    const double* parameters[] = {lens.data(), poses[i].data()};
    errors[i]->Evaluate(parameters, residuals.data(), nullptr);
    sum_px2 += residuals.squaredNorm();
    num_corners += errors[i]->num_corners();
    fit.view_rms_px.push_back(
        BringsEveryCornerToAPixel(fit.camera, corners_board_m, views[i], fit.T_camera_board.back())
            ? std::sqrt(residuals.squaredNorm() / static_cast<double>(errors[i]->num_corners()))
            : HUGE_VAL);
    informations.push_back(InformationOf(*errors[i], lens, poses[i], form.NumParameters()));
  }
  fit.rms_px = std::sqrt(sum_px2 / static_cast<double>(num_corners));
  fit.covariance = CovarianceOf(informations, sum_px2, num_corners);
  const Eigen::Vector3d scale_and_shift =
      ScaleAndShiftCovariance(informations, views, fit.covariance).diagonal().cwiseSqrt();
  fit.scale_sigma = scale_and_shift[0];
  fit.shift_sigma_px = std::max(scale_and_shift[1], scale_and_shift[2]);
  return fit;
}

std::optional<CameraModel> StartLens(LensModel lens,
                                     const cv::Size& image_px,
                                     const std::vector<Eigen::Vector3d>& corners_board_m,
                                     const std::vector<LensView>& views) {
  constexpr double kShortest = 0.25;  // of the image's longer side
  constexpr int kNumHalfOctaves = 9;
  std::optional<CameraModel> best;
  double least_px = HUGE_VAL;
  for (int i = 0; i < kNumHalfOctaves; ++i) {
    CameraModel camera;
    camera.lens = lens;
    camera.width_px = image_px.width;
    camera.height_px = image_px.height;
    camera.fx_px = camera.fy_px =
        kShortest * std::pow(2.0, 0.5 * i) * std::max(image_px.width, image_px.height);
    camera.cx_px = (image_px.width - 1) / 2.0;
    camera.cy_px = (image_px.height - 1) / 2.0;
    std::vector<double> rms_px;
    for (const LensView& view : views) {
      const auto pose = FitSeenCorners(camera, corners_board_m, view.corners_px);
      rms_px.push_back(pose ? pose->reprojection_rms_px : HUGE_VAL);
    }
    const double median_px = Median(rms_px);
    if (median_px < least_px) {
      least_px = median_px;
      best = camera;
    }
  }
  return best;
}

}  // namespace voqcal
