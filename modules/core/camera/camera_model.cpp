#include "core/camera/camera_model.hpp"

#include <cmath>

#include "core/problems.hpp"

namespace voqcal {
namespace {

template <typename... Rows>
std::optional<LensModel> LensNamed(const std::string& name, const std::tuple<Rows...>&) {
  std::optional<LensModel> found;
  const auto compare = [&](const auto& row) {
    if (name == row.kName || name == row.kOtherName) found = row.kLens;
  };
  (compare(Rows{}), ...);
  return found;
}

}  // namespace

std::vector<std::string> CameraModel::Problems() const {
  ProblemList problems;
  problems.RequirePositive("width_px", width_px);
  problems.RequirePositive("height_px", height_px);
  problems.Require(fx_px > 0 && std::isfinite(fx_px), "fx_px must be positive and finite", fx_px);
  problems.Require(fy_px > 0 && std::isfinite(fy_px), "fy_px must be positive and finite", fy_px);
  problems.Require(std::isfinite(cx_px), "cx_px must be finite", cx_px);
  problems.Require(std::isfinite(cy_px), "cy_px must be finite", cy_px);
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    const std::string name = "distortion[" + std::to_string(i) + "]";
    problems.Require(std::isfinite(distortion[i]), name + " must be finite", distortion[i]);
    problems.Require(static_cast<int>(i) < NumDistortion(lens) || distortion[i] == 0.0,
                     name + " must be zero, as " + ToString(lens) + " has " +
                         std::to_string(NumDistortion(lens)) + " coefficients",
                     distortion[i]);
  }
  return problems.lines();
}

bool CameraModel::IsInFront(const Eigen::Vector3d& point_camera_m) const {
  return detail::WithLens(
      lens, [&](const auto& row) { return detail::IsSeenBy(row, distortion, point_camera_m); });
}

bool CameraModel::IsProjectable(const Eigen::Vector3d& point_camera_m) const {
  return detail::WithLens(lens, [&](const auto& row) { return row.IsProjectable(point_camera_m); });
}

bool CameraModel::Contains(const Eigen::Vector2d& pixel_px) const {
  return pixel_px.x() >= -0.5 && pixel_px.x() < width_px - 0.5 &&  //
         pixel_px.y() >= -0.5 && pixel_px.y() < height_px - 0.5;
}

std::optional<Eigen::Vector3d> CameraModel::Unproject(const Eigen::Vector2d& pixel_px) const {
  if (!pixel_px.allFinite()) return std::nullopt;
  const Eigen::Vector2d at((pixel_px.x() - cx_px) / fx_px, (pixel_px.y() - cy_px) / fy_px);
  return detail::WithLens(lens, [&](const auto& row) { return row.Unproject(distortion, at); });
}

std::string ToString(LensModel lens) {
  return detail::WithLens(lens, [](const auto& row) { return std::string(row.kName); });
}

std::optional<LensModel> LensModelFromString(const std::string& name) {
  return LensNamed(name, detail::LensRows{});
}

int NumDistortion(LensModel lens) {
  return detail::WithLens(lens, [](const auto& row) { return row.kNumDistortion; });
}

}  // namespace voqcal
