#include "rig/assessor_section.hpp"

#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadSceneCheck(OptionSection* assessor, SceneCheckOptions* options) {
  OptionSection section = assessor->Section(
      "scene_check", "do the background's depth edges lie on edges of the image?");
  // Of an earlier check, which knew turns alone.
  section.PassOver("min_contrast", "min_gain_over_chance");
  section.PassOver("min_gain_sigmas", "min_gain_over_chance");
  section.PassOver("max_sigma_deg", "max_turn_sigma_deg");
  section.PassOver("tolerance_deg", "turn_tolerance_deg");
  section.Read("min_edges",
               &options->refinement.min_edges,
               "fewer depth edges, over all scenes, judge nothing");
  section.Read("min_gain_over_chance",
               &options->min_gain_over_chance,
               "it disagrees if the edges then fit better by so many times what chance gives");
  section.ReadDegrees("turn_prior_deg",
                      &options->turn_prior_rad,
                      "1 sigma of what may be wrong with the extrinsic");
  section.Read("shift_prior_m", &options->shift_prior_m, "the same of its shift");
  section.ReadDegrees("max_turn_sigma_deg",
                      &options->max_turn_sigma_rad,
                      "a turn known no better than this is left open");
  section.Read("max_shift_sigma_m", &options->max_shift_sigma_m, "so is such a shift");
  section.ReadDegrees(
      "turn_tolerance_deg", &options->turn_tolerance_rad, "a turn beyond this disagrees...");
  section.Read("shift_tolerance_m", &options->shift_tolerance_m, "...or a shift beyond this...");
  section.Read(
      "num_sigmas", &options->num_sigmas, "...if it is beyond so many of its standard errors");
  section.Read("min_jump_m",
               &options->view.edges.min_jump_m,
               "a depth edge: the next return is so much farther");
  section.ReadDegrees("max_step_deg",
                      &options->view.edges.max_step_rad,
                      "neighbours of a scan line are at most this far apart");
  section.Read(
      "board_margin_m", &options->view.board_margin_m, "around the board nothing is background");
  section.Read(
      "min_range_m", &options->view.edges.min_range_m, "nearer returns are the robot itself");
  section.Read("max_image_width_px",
               &options->view.max_image_width_px,
               "larger images are halved until they fit");
  section.Read(
      "image_blur_px", &options->view.image_blur_px, "1 sigma of the blur before the gradient");
  CheckAndClose(*options, &section);
}

void ReadDiagnosis(OptionSection* assessor, DiagnosisOptions* options) {
  OptionSection section = assessor->Section("diagnosis", "what makes a likely cause worth a word");
  // What moves the result matters now, whatever its size.
  for (const char* size : {"min_held_out_gain",
                           "min_focal_scale",
                           "min_principal_point_px",
                           "min_square_scale",
                           "min_range_offset_m"}) {
    section.PassOver(size, "min_moved_intervals");
  }
  section.Read("min_log_likelihood_gain",
               &options->min_log_likelihood_gain,
               "chance gains about 0.5 for each parameter");
  section.Read("min_moved_intervals",
               &options->min_moved_intervals,
               "what moves the result by a smaller share of its 95 % interval is within it");
  section.Read("max_range_offset_m",
               &options->max_range_offset_m,
               "no lidar errs more: if more was taken out, something else is wrong");
  section.Read("min_edge_error_m",
               &options->min_edge_error_m,
               "smaller errors do not matter: of the board's mean edge length");
  section.Read("min_side_error_m", &options->min_side_error_m, "of width against height, metres");
  section.Read("max_outlier_factor",
               &options->max_outlier_factor,
               "a sample so many times the median error off stands out");
  section.Read("min_samples", &options->min_samples, "fewer samples are too few");
  section.ReadDegrees("min_tilt_spread_deg",
                      &options->min_tilt_spread_rad,
                      "normals that spread less are too similar...");
  section.ReadDegrees("min_view_spread_deg",
                      &options->min_view_spread_rad,
                      "...as are the directions to the centres");
  CheckAndClose(*options, &section);
}

}  // namespace

void ReadAssessor(OptionSection* top, SceneCheckOptions* scene_check, DiagnosisOptions* diagnosis) {
  OptionSection section = top->Section("assessor", "how good the result is, and what may be wrong");
  ReadSceneCheck(&section, scene_check);
  ReadDiagnosis(&section, diagnosis);
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
