#include "rig/pose_guide_section.hpp"

#include <string>

namespace voqcal {

void ReadPoseGuide(YamlSection* top, GuidanceOptions* options) {
  YamlSection section = top->Section("pose_guide");
  ErrorTolerance* tolerance = &options->enough.tolerance;
  std::string unit = ToString(tolerance->unit);
  section.Read("tolerance", &tolerance->tolerance);
  section.Read("unit", &unit);
  if (unit != "mm" && unit != "px") section.AddError("unit", "must be mm or px");
  tolerance->unit = unit == "px" ? ErrorUnit::kPixels : ErrorUnit::kMillimetres;
  section.Read("min_range_m", &tolerance->min_range_m);
  section.Read("max_range_m", &tolerance->max_range_m);
  section.Read("min_samples", &options->enough.min_samples);
  section.AddProblems(options->enough.Problems());
  YamlSection hold = section.Section("hold");
  hold.Read("min_distance_m", &options->limits.min_distance_m);
  hold.Read("max_distance_m", &options->limits.max_distance_m);
  hold.ReadDegrees("max_incidence_deg", &options->limits.max_incidence_rad);
  hold.Read("image_margin", &options->limits.image_margin);
  hold.Read("min_square_px", &options->limits.min_square_px);
  hold.Read("min_rows", &options->limits.min_rows);
  hold.AddProblems(options->limits.Problems());
  hold.RefuseUnknownKeys();
  YamlSection sensors = section.Section("sensors");
  sensors.ReadDegrees("min_elevation_deg", &options->sensors.min_elevation_rad);
  sensors.ReadDegrees("max_elevation_deg", &options->sensors.max_elevation_rad);
  sensors.ReadDegrees("max_azimuth_deg", &options->sensors.max_azimuth_rad);
  sensors.Read("num_rows", &options->sensors.num_rows);
  sensors.ReadDegrees("column_step_deg", &options->sensors.column_step_rad);
  sensors.Read("corner_noise_px", &options->sensors.corner_noise_px);
  sensors.AddProblems(options->sensors.Problems());
  sensors.RefuseUnknownKeys();
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
