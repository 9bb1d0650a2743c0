#include "calibrate/lens_of_result.hpp"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/option_section.hpp"
#include "result/result_file.hpp"
#include "rig/camera_section.hpp"

namespace voqcal {
namespace {

std::optional<CameraModel> CameraOf(const std::filesystem::path& extrinsic) {
  const std::filesystem::path file = ResultFileAt(extrinsic);
  YamlDocument document(file.string(), ReadWholeFile(file));
  OptionSection top(&document);
  const bool is_ours = top.Has("made_from");
  if (!is_ours || !top.Has("camera")) return std::nullopt;  // or of an earlier version
  CameraModel camera;
  std::optional<Eigen::Isometry3d> no_guess;
  ReadCamera(&top, &camera, &no_guess, nullptr);
  document.ThrowIfWrong();
  return camera;
}

/// Over the image, where both lenses have rays.
double LargestAngleRad(const CameraModel& a, const CameraModel& b) {
  constexpr int kNumSteps = 8;
  double largest_rad = 0.0;
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int j = 0; j <= kNumSteps; ++j) {
      const Eigen::Vector2d pixel_px((a.width_px - 1.0) * i / kNumSteps,
                                     (a.height_px - 1.0) * j / kNumSteps);
      const auto ray_a = a.Unproject(pixel_px);
      const auto ray_b = b.Unproject(pixel_px);
      if (ray_a && ray_b) largest_rad = std::max(largest_rad, AngleBetween(*ray_a, *ray_b));
    }
  }
  return largest_rad;
}

}  // namespace

std::string LensDoubt(const std::filesystem::path& extrinsic, const CameraModel& camera) {
  constexpr double kRoundingRad = 1e-5;  // a hundredth of a pixel
  const std::optional<CameraModel> made_with = CameraOf(extrinsic);
  if (!made_with) return "";
  const std::string file = ResultFileAt(extrinsic).string();
  if (made_with->width_px != camera.width_px || made_with->height_px != camera.height_px) {
    return Format("%s was made with images of %d x %d px, the rig file has %d x %d",
                  file.c_str(),
                  made_with->width_px,
                  made_with->height_px,
                  camera.width_px,
                  camera.height_px);
  }
  const double angle_rad = LargestAngleRad(*made_with, camera);
  if (angle_rad < kRoundingRad) return "";
  return Format(
      "%s was made with another lens than the rig file's: rays differ by up to %.3g deg (fx_px "
      "%.6g "
      "and %.6g, cx_px %.6g and %.6g, cy_px %.6g and %.6g). An extrinsic goes with its lens: take "
      "that one, or calibrate again",
      file.c_str(),
      kDegPerRad * angle_rad,
      made_with->fx_px,
      camera.fx_px,
      made_with->cx_px,
      camera.cx_px,
      made_with->cy_px,
      camera.cy_px);
}

}  // namespace voqcal
