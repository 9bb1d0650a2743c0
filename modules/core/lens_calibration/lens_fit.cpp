#include "core/lens_calibration/lens_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "core/camera_detection/planar_pose.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/lens_calibration/lens_covariance.hpp"
#include "core/lens_calibration/view_errors.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

// A weak belief that coefficients are small, r_k = kWeight k: where corners do not tell two of them
// apart (the rational model's numerator and denominator, above all) the smallest that fit are
// taken, rather than where a search happens to end. With corners to 0.1 px it is 1 sigma of 2.
constexpr double kWeightPx = 0.05;

class SmallCoefficients final : public ceres::CostFunction {
 public:
  explicit SmallCoefficients(int num_coefficients) {
    set_num_residuals(num_coefficients);
    *mutable_parameter_block_sizes() = {kNumFocal + num_coefficients};
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    for (int k = 0; k < num_residuals(); ++k) {
      residuals[k] = kWeightPx * parameters[0][kNumFocal + k];
    }
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorXd> J(jacobians[0], num_residuals(), kNumFocal + num_residuals());
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
  fit.covariance = LensCovariance(informations, kWeightPx * kWeightPx, sum_px2, num_corners);
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
