#pragma once

// Templates of camera_model.hpp, which includes this file.

#include <optional>

#include "core/camera/camera_model.hpp"
#include "core/camera/lens_rows.hpp"

namespace voqcal {

template <typename T>
Eigen::Matrix<T, 2, 1> CameraModel::Project(const Eigen::Matrix<T, 3, 1>& point_camera_m) const {
  const Eigen::Matrix<T, 2, 1> d = detail::WithLens(
      lens, [&](const auto& row) { return detail::ProjectBy(row, distortion, point_camera_m); });
  return {T(fx_px) * d(0) + T(cx_px), T(fy_px) * d(1) + T(cy_px)};
}

template <typename T>
std::optional<Eigen::Matrix<T, 2, 1>> CameraModel::ProjectIfInFront(
    const Eigen::Matrix<T, 3, 1>& point_camera_m) const {
  const auto d = detail::WithLens(lens, [&](const auto& row) {
    return detail::ProjectIfSeenBy(row, distortion, point_camera_m);
  });
  if (!d) return std::nullopt;
  return Eigen::Matrix<T, 2, 1>(T(fx_px) * (*d)(0) + T(cx_px), T(fy_px) * (*d)(1) + T(cy_px));
}

}  // namespace voqcal
