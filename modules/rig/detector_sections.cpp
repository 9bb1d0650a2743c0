#include "rig/detector_sections.hpp"

#include "rig/section_reading.hpp"

namespace voqcal {

void ReadLidarBoardDetector(OptionSection* top, LidarBoardOptions* options) {
  OptionSection section = top->Section("lidar_board_detector", "finds the board in a sweep");
  section.Read("min_range_m", &options->min_range_m, "nearer returns are the robot itself");
  section.Read("max_range_m", &options->max_range_m, "farther boards have too few points");
  section.Describe(
      "region_of_interest",
      "{min_lidar_m: [0.5, -3, -1.5], max_lidar_m: [6, 3, 2]}",
      "narrows the search to a box in the lidar frame; without it the board is sought everywhere",
      true);
  YamlSection box = section.Peek("region_of_interest");
  if (section.Has("region_of_interest")) {
    RegionOfInterest region;
    box.ReadRequired("min_lidar_m", &region.min_lidar_m);
    box.ReadRequired("max_lidar_m", &region.max_lidar_m);
    options->region_of_interest = region;
  }
  box.RefuseUnknownKeys();
  section.Read("max_corner_sigma_m",
               &options->max_corner_sigma_m,
               "a board whose corners are less certain is refused");
  section.Read(
      "max_bend_m", &options->max_bend_m, "a board that is certainly more bent is refused");
  section.Read("thickness_m", &options->thickness_m, "of the board, give or take the next");
  section.Read("thickness_sigma_m", &options->thickness_sigma_m, "1 sigma of the thickness");
  section.Read("max_accumulation_s",
               &options->max_accumulation_s,
               "where one sweep of a lidar that never repeats its beams (Livox) is too thin, those "
               "of so long are put together while the board rests; 0: none, at most 10");
  OptionSection beam = section.Section("beam", "how the lidar sees the edge of a plate");
  beam.Read(
      "spill_m", &options->beam.spill_m, "hits end so far past an edge, give or take the next");
  beam.Read("spill_sigma_m", &options->beam.spill_sigma_m, "1 sigma of the spill");
  beam.Read("blur_m", &options->beam.blur_m, "scale of a beam's turn from hit to miss");
  beam.Read("blur_per_m", &options->beam.blur_per_m, "its growth with each metre of range");
  beam.Read("hit_band_m",
            &options->beam.hit_band_m,
            "returns so near the board's plane are of the board");
  beam.Read("line_sigma_m",
            &options->beam.line_sigma_m,
            "offset of one scan line from the others, 1 sigma");
  beam.RefuseUnknownKeys();
  OptionSection background =
      section.Section("background", "what came since earlier sweeps ranks higher");
  background.Read("is_used", &options->background.is_used, "else all rank alike");
  background.Read("memory_sweeps",
                  &options->background.memory_sweeps,
                  "what was not seen for so many is forgotten");
  background.Read("min_step_m",
                  &options->background.min_step_m,
                  "what came is nearer than the background by this");
  background.RefuseUnknownKeys();
  CheckAndClose(*options, &section);
}

void ReadCameraBoardDetector(OptionSection* top, CameraBoardOptions* options) {
  OptionSection section = top->Section("camera_board_detector", "finds the board in an image");
  section.Read("max_reprojection_rms_px",
               &options->max_reprojection_rms_px,
               "a worse fit is not this board, or not this camera");
  section.Read("max_edge_width_squares",
               &options->max_edge_width_squares,
               "edges that take more of a square give no pose");
  section.ReadDegrees("max_edge_width_deg",
                      &options->max_edge_width_rad,
                      "the board is still taken beyond this and the limits below, with a warning. "
                      "Blurred: width of an edge as an angle of view");
  section.Read("min_square_px", &options->min_square_px, "too small: fewer pixels to a square");
  section.Read("min_contrast",
               &options->min_contrast,
               "glare: contrast of the palest corner, share of the median");
  section.Read("max_outside_share",
               &options->max_outside_share,
               "cut off: share of the outline beyond the image");
  section.Read("max_mirrored_probability",
               &options->max_mirrored_probability,
               "ambiguous: probability of the mirrored tilt");
  CheckAndClose(*options, &section);
}

}  // namespace voqcal
