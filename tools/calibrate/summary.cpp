#include "calibrate/summary.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace voqcal {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...) {
  char text[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(text, sizeof(text), format, args);
  va_end(args);
  return text;
}

std::string TransformLines(const CalibrationResult& result) {
  const Eigen::Vector3d& t = result.T_camera_lidar.translation();
  Eigen::Quaterniond q(result.T_camera_lidar.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Vector6d sigma = result.covariance.diagonal().cwiseSqrt();
  return Format(
             "T_camera_lidar (p_camera = T_camera_lidar * p_lidar)\n"
             "  translation_m    %9.5f %9.5f %9.5f   1 sigma %.1f %.1f %.1f mm\n",
             t.x(),
             t.y(),
             t.z(),
             1e3 * sigma[3],
             1e3 * sigma[4],
             1e3 * sigma[5]) +
         Format("  quaternion_xyzw  %9.6f %9.6f %9.6f %9.6f   1 sigma %.3f %.3f %.3f deg\n",
                q.x(),
                q.y(),
                q.z(),
                q.w(),
                kDegPerRad * sigma[0],
                kDegPerRad * sigma[1],
                kDegPerRad * sigma[2]);
}

}  // namespace

std::string Summary(const SceneScore& score) {
  return Format(
      "centre %.2f +- %.2f mm (largest %.2f), %.2f +- %.2f px; corners %.1f mm; "
      "normals %.2f deg",
      score.centre_mm.mean,
      score.centre_mm.std,
      score.centre_mm.max,
      score.centre_px.mean,
      score.centre_px.std,
      score.corner_mm.mean,
      score.normal_deg.mean);
}

std::string Summary(const CalibrationResult& result) {
  std::string text = TransformLines(result);
  text += "errors over the scene, mean +- standard deviation of " +
          std::to_string(result.used_ids.size()) + " samples\n";
  text += "  held out   " + Summary(result.held_out) + "\n";
  text += "  in sample  " + Summary(result.in_sample) + "\n";
  text += "  averaged   " + Summary(result.of_average) + "   (" +
          std::to_string(result.averaged.num_kept) + " of " +
          std::to_string(result.averaged.num_sets) + " sets kept)\n";
  for (const RejectedSample& rejected : result.rejected) {
    text += "left out\n  sample " + std::to_string(rejected.id) + ": " + rejected.reason + "\n";
  }
  return text;
}

}  // namespace voqcal
