#include "rig/refiner_section.hpp"

#include <string>

#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadSceneRefinement(YamlSection* refiner, SceneRefinementOptions* options) {
  YamlSection section = refiner->Section("scene");
  section.Read("min_edges", &options->min_edges);
  section.ReadDegrees("outset_prior_deg", &options->outset_prior_rad);
  section.ReadDegrees("shared_error_deg", &options->shared_error_rad);
  section.Read("min_gain_sigmas", &options->min_gain_sigmas);
  section.Read("max_iterations", &options->max_iterations);
  CheckAndClose(*options, &section);
}

void ReadLikelihood(YamlSection* refiner, LikelihoodOptions* options) {
  YamlSection section = refiner->Section("likelihood");
  section.Read("common_prior_m", &options->common_prior_m);
  section.Read("dark_step_prior_m", &options->dark_step_prior_m);
  section.Read("ring_prior_m", &options->ring_prior_m);
  section.Read("outline_lift_prior_m", &options->outline_lift_prior_m);
  section.Read("outline_rise_prior", &options->outline_rise_prior);
  section.Read("outline_error_m", &options->outline_error_m);
  section.ReadDegrees("outline_error_deg", &options->outline_error_rad);
  section.Read("camera_error_m", &options->camera_error_m);
  section.ReadDegrees("camera_error_deg", &options->camera_error_rad);
  section.Read("focal_length_error", &options->focal_length_error);
  section.Read("principal_point_error_px", &options->principal_point_error_px);
  section.Read("board_size_error", &options->board_size_error);
  section.Read("lens_error", &options->lens_error);
  section.Read("corner_error_px", &options->corner_error_px);
  section.Read("max_iterations", &options->max_iterations);
  CheckAndClose(*options, &section);
}

}  // namespace

void ReadExtrinsicRefiner(YamlSection* top, RefinerOptions* options) {
  YamlSection section = top->Section("extrinsic_refiner");
  std::string method = "automatic";
  section.Read("method", &method);
  options->method = RefineMethodFromString(method);
  if (!options->method && method != "automatic") {
    section.AddError("method", "must be automatic, joint, likelihood, reprojection or average");
  }
  section.Read("centre_weight", &options->reprojection.centre_weight);
  section.Read("corner_weight", &options->reprojection.corner_weight);
  section.Read("huber_px", &options->reprojection.huber_px);
  section.Read("range_offset_m", &options->reprojection.range_offset_m);
  section.Read("max_iterations", &options->reprojection.max_iterations);
  ReadLikelihood(&section, &options->likelihood);
  ReadSceneRefinement(&section, &options->scene);
  CheckAndClose(options->reprojection, &section);
}

}  // namespace voqcal
