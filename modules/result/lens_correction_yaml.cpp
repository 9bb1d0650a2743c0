#include "result/lens_correction_yaml.hpp"

#include <vector>

#include "files/number_text.hpp"
#include "files/transform_yaml.hpp"
#include "result/assessment_yaml.hpp"
#include "result/camera_yaml.hpp"

namespace voqcal {
namespace {

std::string ErrorLine(const LensEstimate& lens, LensError error, double reach_px) {
  const bool is_observable = lens.is_observable[static_cast<std::size_t>(error)];
  return "    " + std::string(ToString(error)) +
         "_px: {value: " + NumberText(reach_px * lens.errors[error]) +
         ", standard_error: " + NumberText(reach_px * lens.standard_errors[error]) +
         ", status: " + (is_observable ? "estimated" : "unobservable") + "}\n";
}

}  // namespace

std::string LensCorrectionYaml(const LensCorrection& correction, const std::string& which_to_take) {
  if (!correction.IsUsable()) {
    return "lens_correction: {status: none, reason: " + QuotedYaml(correction.problem) + "}\n";
  }
  const double reach_px = LensReachPx(correction.camera);
  std::string text =
      "# Not used for anything above or below: for who can correct the intrinsics too.\n"
      "lens_correction:  # what the samples say of the intrinsics that the rig file gives\n"
      "  status: estimated\n"
      "  which_to_take: " +
      QuotedYaml(which_to_take) +
      "\n"
      "  errors:  # how far each moves a point that is half the image's width from the middle\n";
  for (Eigen::Index i = 0; i < kNumLensErrors; ++i) {
    text += ErrorLine(correction.errors, static_cast<LensError>(i), reach_px);
  }
  return text + "  camera:  # with these errors taken out\n" +
         CameraYaml(correction.camera, "    ") +
         "  T_camera_lidar:  # goes with this camera only; T_camera_lidar above with the rig "
         "file's\n" +
         TransformYaml(correction.T_camera_lidar, "    ") +
         "  # of it, if the board is exactly right: rotation_rad, then translation_m, on the\n"
         "  # left (camera) side\n"
         "  covariance:\n" +
         RowsYaml(correction.covariance, "    ") +
         "  held_out:  # each sample by extrinsic, intrinsics and lidar_bias estimated without "
         "it\n" +
         ScoreYaml(correction.held_out);
}

}  // namespace voqcal
