#include "rig/pose_guide_section.hpp"

#include "rig/section_reading.hpp"

namespace voqcal {

void ReadPoseGuide(OptionSection* top, GuidanceOptions* options) {
  OptionSection section =
      top->Section("pose_guide", "where to hold the board next, and when it is enough");
  ErrorTolerance* tolerance = &options->enough.tolerance;
  section.Read("tolerance",
               &tolerance->tolerance,
               "largest predicted error (RMS) of a lidar point in the image");
  section.ReadOneOf("unit",
                    ByName<ErrorUnit>({ErrorUnit::kMillimetres, ErrorUnit::kPixels}),
                    &tolerance->unit,
                    "of the tolerance (mm: across the camera's ray)");
  section.Read(
      "min_range_m", &tolerance->min_range_m, "that holds from this range from the camera...");
  section.Read("max_range_m", &tolerance->max_range_m, "...to this");
  section.Read("min_samples",
               &options->enough.min_samples,
               "fewer are never enough: what they share they cannot show");
  section.AddProblems(options->enough.Problems());
  OptionSection hold = section.Section("hold", "where the board may be asked for");
  hold.Read("min_distance_m", &options->limits.min_distance_m, "from the camera...");
  hold.Read("max_distance_m", &options->limits.max_distance_m, "...to this");
  hold.ReadDegrees("max_incidence_deg",
                   &options->limits.max_incidence_rad,
                   "of either sensor's ray on the board; below 90");
  hold.Read("image_margin",
            &options->limits.image_margin,
            "around the outline, share of the image's shorter side; below 0.5");
  hold.Read("min_square_px", &options->limits.min_square_px, "smaller squares are not asked for");
  hold.Read("min_rows", &options->limits.min_rows, "scan lines on the board");
  hold.AddProblems(options->limits.Problems());
  hold.RefuseUnknownKeys();
  OptionSection sensors =
      section.Section("sensors", "what is expected of a sample: a VLP-16's by default");
  sensors.ReadDegrees(
      "min_elevation_deg", &options->sensors.min_elevation_rad, "of the lidar's lowest row...");
  sensors.ReadDegrees("max_elevation_deg",
                      &options->sensors.max_elevation_rad,
                      "...and highest, evenly spaced between");
  sensors.ReadDegrees(
      "max_azimuth_deg", &options->sensors.max_azimuth_rad, "to both sides of the lidar's x");
  sensors.Read("num_rows", &options->sensors.num_rows, "2 to 256");
  sensors.ReadDegrees(
      "column_step_deg", &options->sensors.column_step_rad, "between returns of a row");
  sensors.Read(
      "corner_noise_px", &options->sensors.corner_noise_px, "1 sigma of a chessboard corner");
  sensors.AddProblems(options->sensors.Problems());
  sensors.RefuseUnknownKeys();
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
