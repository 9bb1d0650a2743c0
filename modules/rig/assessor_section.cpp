#include "rig/assessor_section.hpp"

#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadSceneCheck(YamlSection* assessor, SceneCheckOptions* options) {
  YamlSection section = assessor->Section("scene_check");
  // Of an earlier check, which knew turns alone.
  section.PassOver("min_contrast", "min_gain_over_chance");
  section.PassOver("min_gain_sigmas", "min_gain_over_chance");
  section.PassOver("max_sigma_deg", "max_turn_sigma_deg");
  section.PassOver("tolerance_deg", "turn_tolerance_deg");
  section.Read("min_edges", &options->refinement.min_edges);
  section.Read("min_gain_over_chance", &options->min_gain_over_chance);
  section.ReadDegrees("turn_prior_deg", &options->turn_prior_rad);
  section.Read("shift_prior_m", &options->shift_prior_m);
  section.ReadDegrees("max_turn_sigma_deg", &options->max_turn_sigma_rad);
  section.Read("max_shift_sigma_m", &options->max_shift_sigma_m);
  section.ReadDegrees("turn_tolerance_deg", &options->turn_tolerance_rad);
  section.Read("shift_tolerance_m", &options->shift_tolerance_m);
  section.Read("num_sigmas", &options->num_sigmas);
  section.Read("min_jump_m", &options->view.edges.min_jump_m);
  section.ReadDegrees("max_step_deg", &options->view.edges.max_step_rad);
  section.Read("board_margin_m", &options->view.board_margin_m);
  section.Read("min_range_m", &options->view.edges.min_range_m);
  section.Read("max_image_width_px", &options->view.max_image_width_px);
  section.Read("image_blur_px", &options->view.image_blur_px);
  CheckAndClose(*options, &section);
}

void ReadDiagnosis(YamlSection* assessor, DiagnosisOptions* options) {
  YamlSection section = assessor->Section("diagnosis");
  // What moves the result matters now, whatever its size.
  for (const char* size : {"min_held_out_gain",
                           "min_focal_scale",
                           "min_principal_point_px",
                           "min_square_scale",
                           "min_range_offset_m"}) {
    section.PassOver(size, "min_moved_intervals");
  }
  section.Read("min_log_likelihood_gain", &options->min_log_likelihood_gain);
  section.Read("min_moved_intervals", &options->min_moved_intervals);
  section.Read("max_range_offset_m", &options->max_range_offset_m);
  section.Read("min_edge_error_m", &options->min_edge_error_m);
  section.Read("min_side_error_m", &options->min_side_error_m);
  section.Read("max_outlier_factor", &options->max_outlier_factor);
  section.Read("min_samples", &options->min_samples);
  section.ReadDegrees("min_tilt_spread_deg", &options->min_tilt_spread_rad);
  section.ReadDegrees("min_view_spread_deg", &options->min_view_spread_rad);
  CheckAndClose(*options, &section);
}

}  // namespace

void ReadAssessor(YamlSection* top, SceneCheckOptions* scene_check, DiagnosisOptions* diagnosis) {
  YamlSection section = top->Section("assessor");
  ReadSceneCheck(&section, scene_check);
  ReadDiagnosis(&section, diagnosis);
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
