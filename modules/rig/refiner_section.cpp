#include "rig/refiner_section.hpp"

#include <optional>

#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadSceneRefinement(OptionSection* refiner, SceneRefinementOptions* options) {
  OptionSection section =
      refiner->Section("scene", "of joint: the background's depth edges on the image's edges");
  section.Read("min_edges", &options->min_edges, "fewer in the images tell nothing");
  section.ReadDegrees("outset_prior_deg",
                      &options->outset_prior_rad,
                      "1 sigma: how far surfaces reach beyond their ends in a wide beam");
  section.ReadDegrees("shared_error_deg",
                      &options->shared_error_rad,
                      "1 sigma of what all edges share, added to each turn");
  section.Read("min_gain_sigmas",
               &options->min_gain_sigmas,
               "parts left out must fit better by so many standard errors");
  section.Read("max_iterations", &options->max_iterations, "of the fit");
  CheckAndClose(*options, &section);
}

void ReadLikelihood(OptionSection* refiner, LikelihoodOptions* options) {
  OptionSection section =
      refiner->Section("likelihood", "1 sigma of what is expected before the data speak");
  section.Read("common_prior_m", &options->common_prior_m, "offset of all of the lidar's ranges");
  section.Read(
      "dark_step_prior_m", &options->dark_step_prior_m, "dark surfaces against bright ones");
  section.Read("ring_prior_m", &options->ring_prior_m, "each scan line's own offset");
  section.Read("outline_lift_prior_m",
               &options->outline_lift_prior_m,
               "height of outlines, alike in all sweeps");
  section.Read("outline_rise_prior",
               &options->outline_rise_prior,
               "the same, metres for each metre of range");
  section.Read(
      "outline_error_m",
      &options->outline_error_m,
      "of single boards beyond the detectors' noise (how large it is, the session shows): of an "
      "outline's centre...");
  section.ReadDegrees(
      "outline_error_deg", &options->outline_error_rad, "...and its turn in the plane");
  section.Read("camera_error_m", &options->camera_error_m, "of a chessboard's depth...");
  section.ReadDegrees("camera_error_deg", &options->camera_error_rad, "...and its tilt");
  section.Read("lens_error",
               &options->lens_error,
               "of the camera's intrinsics: of each (focal length, its aspect, principal point x "
               "and y, two radial terms) by how far it moves a point half the image's width from "
               "the middle, as a share of that");
  section.Read("board_size_error", &options->board_size_error, "of a chessboard square, relative");
  section.Read("pattern_offset_error_m",
               &options->pattern_offset_error_m,
               "of the pattern's offset on the plate, each way");
  section.Read(
      "corner_error_px",
      &options->corner_error_px,
      "of a chessboard's corner where it tells of the intrinsics, neighbours erring alike");
  section.Read("max_iterations", &options->max_iterations, "of the fit");
  CheckAndClose(*options, &section);
}

}  // namespace

void ReadExtrinsicRefiner(OptionSection* top, RefinerOptions* options) {
  OptionSection section =
      top->Section("extrinsic_refiner", "one fit over all samples, from the mean");
  section.ReadOneOf<std::optional<RefineMethod>>(
      "method",
      {{"automatic", std::nullopt},
       {"joint", RefineMethod::kJoint},
       {"likelihood", RefineMethod::kLikelihood},
       {"reprojection", RefineMethod::kReprojection},
       {"average", RefineMethod::kAverage}},
      &options->method,
      "how (automatic: joint, else the best of the others)");
  section.Read("centre_weight",
               &options->reprojection.centre_weight,
               "of method reprojection: weight of a centre's reprojection...");
  section.Read("corner_weight",
               &options->reprojection.corner_weight,
               "...and of a corner's; 0 leaves corners out");
  section.Read("huber_px", &options->reprojection.huber_px, "residuals beyond this count linearly");
  section.Read("range_offset_m",
               &options->reprojection.range_offset_m,
               "1 sigma of an offset of all ranges, in the covariance");
  section.Read("max_iterations", &options->reprojection.max_iterations, "of the fit");
  ReadLikelihood(&section, &options->likelihood);
  ReadSceneRefinement(&section, &options->scene);
  CheckAndClose(options->reprojection, &section);
}

}  // namespace voqcal
