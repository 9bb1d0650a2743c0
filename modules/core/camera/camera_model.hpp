#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// How rays become pixels, by OpenCV's (and ROS') names and coefficient orders.
enum class LensModel {
  kEquidistant,  ///< Fisheye: k1 k2 k3 k4. OpenCV's cv::fisheye, ROS' "equidistant".
  kPlumbBob,     ///< k1 k2 p1 p2 k3. ROS' "plumb_bob".
  kRational,     ///< k1 k2 p1 p2 k3 k4 k5 k6. ROS' "rational_polynomial".
};

/// A central camera. Camera frame: x right, y down, z forward; pixel (0, 0) is the centre of the
/// top-left pixel.
struct CameraModel {
  LensModel lens = LensModel::kPlumbBob;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 8> distortion{};  ///< In the order of `lens`; the unused rest is zero.

  /// One line for each broken constraint, with its value; empty if the model is usable.
  std::vector<std::string> Problems() const;

  /// Pixel of a point in the camera frame. The caller has checked IsInFront.
  /// A template so that Ceres can differentiate it.
  template <typename T>
  Eigen::Matrix<T, 2, 1> Project(const Eigen::Matrix<T, 3, 1>& point_camera_m) const;

  /// The same where IsInFront, for less than both; nothing elsewhere.
  template <typename T>
  std::optional<Eigen::Matrix<T, 2, 1>> ProjectIfInFront(
      const Eigen::Matrix<T, 3, 1>& point_camera_m) const;

  /// True where the lens brings the point's ray to a pixel: within the angles that it takes (below
  /// 90 degrees off the axis, equidistant below 180), and on the branch where the radial polynomial
  /// still grows with the angle.
  bool IsInFront(const Eigen::Vector3d& point_camera_m) const;

  /// True where Project is defined and smooth: cheap, and says nothing of the branch.
  bool IsProjectable(const Eigen::Vector3d& point_camera_m) const;

  /// True if the pixel lies in the image.
  bool Contains(const Eigen::Vector2d& pixel_px) const;

  /// The unit ray of a pixel, in the camera frame; nothing where the lens model cannot be inverted.
  std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& pixel_px) const;
};

/// "equidistant", "plumb_bob", "rational".
std::string ToString(LensModel lens);
/// Also takes ROS' "rational_polynomial" and "fisheye". Nothing for an unknown name.
std::optional<LensModel> LensModelFromString(const std::string& name);
/// How many distortion coefficients the model has: 4, 5 or 8.
int NumDistortion(LensModel lens);

}  // namespace voqcal

#include "core/camera/camera_model_impl.hpp"  // CameraModel::Project
