#include "core/lens_calibration/view_errors.hpp"

#include "core/estimation/left_perturbation.hpp"

namespace voqcal {
namespace {

// By fx fy cx cy and the coefficients. Pixels are linear in the latter, or smooth (rational's
// denominator): differences are as good as derivatives.
RowMajorXd LensJacobian(const CameraModel& camera, const Eigen::Vector3d& point_camera_m) {
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d pixel_px = camera.Project(point_camera_m);
  RowMajorXd J = RowMajorXd::Zero(2, kNumFocal + NumDistortion(camera.lens));
  J(0, 0) = (pixel_px.x() - camera.cx_px) / camera.fx_px;
  J(1, 1) = (pixel_px.y() - camera.cy_px) / camera.fy_px;
  J(0, 2) = J(1, 3) = 1;
  CameraModel moved = camera;
  for (int k = 0; k < NumDistortion(camera.lens); ++k) {
    double& coefficient = moved.distortion[static_cast<std::size_t>(k)];
    const double value = coefficient;
    coefficient = value + kStep;
    const Eigen::Vector2d above_px = moved.Project(point_camera_m);
    coefficient = value - kStep;
    J.col(kNumFocal + k) = (above_px - moved.Project(point_camera_m)) / (2 * kStep);
    coefficient = value;
  }
  return J;
}

}  // namespace

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

ViewErrors::ViewErrors(const CameraModel& frame,
                       const std::vector<Eigen::Vector3d>& corners_board_m,
                       const LensView& view,
                       const Eigen::Isometry3d& T_camera_board)
    : frame_(frame), T_camera_board_(T_camera_board) {
  for (std::size_t i = 0; i < corners_board_m.size(); ++i) {
    if (!view.corners_px[i].allFinite()) continue;
    corners_board_m_.push_back(corners_board_m[i]);
    pixels_px_.push_back(view.corners_px[i]);
  }
  set_num_residuals(static_cast<int>(2 * pixels_px_.size()));
  *mutable_parameter_block_sizes() = {kNumFocal + NumDistortion(frame.lens), 6};
}

bool ViewErrors::Evaluate(const double* const* parameters,
                          double* residuals,
                          double** jacobians) const {
  const CameraModel camera = CameraOf(frame_, parameters[0]);
  const LeftPerturbation at(T_camera_board_, Eigen::Map<const Vector6d>(parameters[1]));
  double* J_lens = jacobians != nullptr ? jacobians[0] : nullptr;
  double* J_pose = jacobians != nullptr ? jacobians[1] : nullptr;
  const int num_lens = parameter_block_sizes()[0];
  for (std::size_t i = 0; i < pixels_px_.size(); ++i) {
    const Eigen::Vector3d point_camera_m = at.T_camera_lidar() * corners_board_m_[i];
    if (!camera.IsProjectable(point_camera_m)) return false;
    const auto row = 2 * static_cast<Eigen::Index>(i);
    Matrix23d J_point;
    Eigen::Map<Eigen::Vector2d>(residuals + row) =
        ProjectWithJacobian(camera, point_camera_m, J_pose != nullptr ? &J_point : nullptr) -
        pixels_px_[i];
    if (J_pose != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>>(J_pose + 6 * row) =
          J_point * at.PointJacobian(point_camera_m);
    }
    if (J_lens != nullptr) {
      Eigen::Map<RowMajorXd>(J_lens + num_lens * row, 2, num_lens) =
          LensJacobian(camera, point_camera_m);
    }
  }
  return true;
}

}  // namespace voqcal
