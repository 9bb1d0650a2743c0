#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/cost_function.h>

#include "core/camera/camera_model.hpp"
#include "core/lens_calibration/lens_view.hpp"

namespace voqcal {

/// A lens as the solver has it: fx fy cx cy, then all coefficients of its model.
constexpr int kNumFocal = 4;
std::vector<double> ParametersOf(const CameraModel& camera);
/// Model and image size are `frame`'s.
CameraModel CameraOf(const CameraModel& frame, const double* parameters);

/// As ceres lays a Jacobian out.
using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Pixel errors of one view's seen corners p_i, at u_i:
///     r_i = project(lens, T p_i) - u_i               r: 2 N, px
/// Parameters: a lens; a perturbation of T_camera_board, [w_rad; d_m] as LeftPerturbation has it.
class ViewErrors final : public ceres::CostFunction {
 public:
  ViewErrors(const CameraModel& frame,
             const std::vector<Eigen::Vector3d>& corners_board_m,
             const LensView& view,
             const Eigen::Isometry3d& T_camera_board);

  std::size_t num_corners() const { return pixels_px_.size(); }

  /// False where a corner is behind the camera.
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  CameraModel frame_;
  Eigen::Isometry3d T_camera_board_;
  std::vector<Eigen::Vector3d> corners_board_m_;
  std::vector<Eigen::Vector2d> pixels_px_;
};

}  // namespace voqcal
