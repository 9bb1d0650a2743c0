#include "rig/simulation_section.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "rig/camera_section.hpp"
#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadScan(OptionSection* section, ScanOptions* scan) {
  section->ReadOneOf(
      "pattern",
      ByName<ScanPattern>({ScanPattern::kVlp16,
                           ScanPattern::kSpinning64,
                           ScanPattern::kSpinning128,
                           ScanPattern::kRaster,
                           ScanPattern::kRosette}),
      &scan->pattern,
      "of the lidar's beams (raster: 110 x 25 degrees, like a Spectrum-Scan; rosette: never "
      "repeats, like a Livox)");
  section->ReadDegrees("dense_from_deg",
                       &scan->dense_from_rad,
                       "of a raster: rows are twice as dense from this elevation...");
  section->ReadDegrees("dense_to_deg", &scan->dense_to_rad, "...to this");
}

}  // namespace

void ReadSimulation(OptionSection* top, SimulationOptions* options) {
  OptionSection section =
      top->Section("simulation", "for source simulator: both drivers live in this one world");
  section.Read("seed", &options->seed, "the same seed gives the same world and noise");
  options->T_camera_lidar = section
                                .ReadTransform("T_camera_lidar",
                                               "the truth to be found: p_camera = T_camera_lidar * "
                                               "p_lidar (lidar: x forward, y left, z up; camera: x "
                                               "right, y down, z forward)")
                                .value_or(options->T_camera_lidar);
  section.Read("follows_guidance",
               &options->follows_guidance,
               "a simulated person holds the board where NEXT_POSE asks, give or take 0.2 m and 10 "
               "degrees, until it is enough: to try the guidance without sensors. Else it goes "
               "through stops of its own.");
  section.Read(
      "num_poses", &options->num_poses, "stops of the board; following the guidance, at most");
  section.Read("hold_s", &options->hold_s, "how long the board rests at each stop");
  section.Read("move_s", &options->move_s, "how long it moves from stop to stop");
  section.Read("min_distance_m", &options->min_distance_m, "of the board from the lidar...");
  section.Read("max_distance_m", &options->max_distance_m, "...to this");
  section.Read(
      "has_clutter", &options->has_clutter, "people, tripods, open doors and more furniture");
  section.Read("second_board_scale",
               &options->second_board_scale,
               "size of a second, wrong board, of the true one's; 0: none");
  ReadScan(&section, &options->scan);
  section.Read("range_noise_m", &options->range_noise_m, "lidar: 1 sigma of one return");
  section.Read(
      "ring_bias_m", &options->ring_bias_m, "1 sigma of the constant offset of each ring, if any");
  section.Read("common_bias_m", &options->common_bias_m, "constant offset of every range");
  section.Read(
      "dark_bias_m", &options->dark_bias_m, "dark squares read longer by this, bright shorter");
  section.Read("intensity_noise",
               &options->intensity_noise,
               "1 sigma of one return; a white surface reads 100");
  section.ReadDegrees("beam_divergence_deg",
                      &options->beam_divergence_rad,
                      "full width of a beam: mixed pixels at edges");
  section.ReadDegrees("pointing_noise_deg",
                      &options->pointing_noise_rad,
                      "1 sigma of where a beam goes about where it says");
  section.Read("dropout", &options->dropout, "share of beams without a return, below 1");
  section.Read("image_noise", &options->image_noise, "camera: 1 sigma in grey levels of 255");
  section.Read("image_blur_px", &options->image_blur_px, "1 sigma of the lens' blur");
  CheckAndClose(*options, &section);
}

namespace {

bool IsSimulated(SensorEntry* entry, const char* driver) {
  std::string source;
  entry->section.Peek(driver).Read("source", &source);
  return source == "simulator";
}

/// One simulated sensor's own place in the world.
Eigen::Isometry3d ReadPlace(OptionSection* section, const char* key) {
  section->Require(key, "(where the simulated sensor is: quaternion_xyzw, translation_m)");
  return section->ReadTransform(key, "where the simulated sensor is: p_rig = T_rig_... * p_sensor")
      .value_or(Eigen::Isometry3d::Identity());
}

SimulatedLidar ReadSimulatedLidar(const ScanOptions& shared, SensorEntry* entry) {
  SimulatedLidar lidar;
  lidar.name = entry->name;
  lidar.scan = shared;
  OptionSection section =
      entry->section.Section("simulation", "of this sensor alone: its place, and how it scans");
  lidar.T_rig_lidar = ReadPlace(&section, "T_rig_lidar");
  ReadScan(&section, &lidar.scan);
  section.RefuseUnknownKeys();
  return lidar;
}

/// @param known  its lens, if that was read before.
SimulatedCamera ReadSimulatedCamera(const CameraModel* known, SensorEntry* entry) {
  SimulatedCamera camera;
  camera.name = entry->name;
  if (known != nullptr) {
    camera.model = *known;
  } else {
    std::optional<Eigen::Isometry3d> unused_guess;
    ReadCamera(&entry->section, &camera.model, &unused_guess, nullptr);
  }
  OptionSection section = entry->section.Section("simulation", "of this sensor alone: its place");
  camera.T_camera_rig = ReadPlace(&section, "T_rig_camera").inverse();
  section.RefuseUnknownKeys();
  return camera;
}

/// What a rig's world has not: its sensors say where they are, and its board follows its script.
void RefuseKeysOfOnePair(OptionSection* top) {
  YamlSection section = top->Peek("simulation");
  if (section.Has("T_camera_lidar")) {
    section.AddError("T_camera_lidar",
                     "is of one pair: give lidars.NAME.simulation.T_rig_lidar and "
                     "cameras.NAME.simulation.T_rig_camera instead");
  }
  if (section.Has("follows_guidance")) {
    section.AddError("follows_guidance", "is of one pair: the board of several follows its script");
  }
}

}  // namespace

void ReadSimulatedRig(OptionSection* top,
                      const PairOfEntries& pair,
                      SensorEntries* entries,
                      Rig* rig) {
  if (entries->lidars.size() + entries->cameras.size() <= 2) return;
  const auto is_any = [](std::vector<SensorEntry>* of, const char* driver) {
    return std::any_of(
        of->begin(), of->end(), [driver](SensorEntry& each) { return IsSimulated(&each, driver); });
  };
  if (!is_any(&entries->lidars, "lidar_driver") && !is_any(&entries->cameras, "camera_driver"))
    return;
  const auto require = [](SensorEntry* entry, const char* driver) {
    if (IsSimulated(entry, driver)) return;
    entry->section.Peek(driver).AddError(
        "source", "must be simulator, as that of other sensors is: all are of one world");
  };
  RigSimulationOptions* world = &rig->simulated_rig;
  world->world = rig->simulation;
  RefuseKeysOfOnePair(top);
  for (SensorEntry& each : entries->lidars) {
    require(&each, "lidar_driver");
    world->lidars.push_back(ReadSimulatedLidar(rig->simulation.scan, &each));
  }
  for (SensorEntry& each : entries->cameras) {
    require(&each, "camera_driver");
    world->cameras.push_back(
        ReadSimulatedCamera(&each == pair.camera ? &rig->camera : nullptr, &each));
  }
}

}  // namespace voqcal
