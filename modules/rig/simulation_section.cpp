#include "rig/simulation_section.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "files/transform_yaml.hpp"
#include "rig/camera_section.hpp"
#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

void ReadScan(YamlSection* section, ScanOptions* scan) {
  std::string pattern = ToString(scan->pattern);
  section->Read("pattern", &pattern);
  if (const auto known = ScanPatternFromString(pattern)) {
    scan->pattern = *known;
  } else {
    section->AddError("pattern", "must be vlp16, spinning_64, spinning_128, raster or rosette");
  }
  section->ReadDegrees("dense_from_deg", &scan->dense_from_rad);
  section->ReadDegrees("dense_to_deg", &scan->dense_to_rad);
}

}  // namespace

void ReadSimulation(YamlSection* top, SimulationOptions* options) {
  YamlSection section = top->Section("simulation");
  section.Read("seed", &options->seed);
  YamlSection truth = section.Section("T_camera_lidar");
  ReadTransform(&truth, &options->T_camera_lidar);
  truth.RefuseUnknownKeys();
  section.Read("follows_guidance", &options->follows_guidance);
  section.Read("num_poses", &options->num_poses);
  section.Read("hold_s", &options->hold_s);
  section.Read("move_s", &options->move_s);
  section.Read("min_distance_m", &options->min_distance_m);
  section.Read("max_distance_m", &options->max_distance_m);
  section.Read("has_clutter", &options->has_clutter);
  section.Read("second_board_scale", &options->second_board_scale);
  ReadScan(&section, &options->scan);
  section.Read("range_noise_m", &options->range_noise_m);
  section.Read("ring_bias_m", &options->ring_bias_m);
  section.Read("common_bias_m", &options->common_bias_m);
  section.Read("dark_bias_m", &options->dark_bias_m);
  section.Read("intensity_noise", &options->intensity_noise);
  section.ReadDegrees("beam_divergence_deg", &options->beam_divergence_rad);
  section.ReadDegrees("pointing_noise_deg", &options->pointing_noise_rad);
  section.Read("dropout", &options->dropout);
  section.Read("image_noise", &options->image_noise);
  section.Read("image_blur_px", &options->image_blur_px);
  CheckAndClose(*options, &section);
}

namespace {

bool IsSimulated(SensorEntry* entry, const char* driver) {
  std::string source;
  entry->section.Section(driver).Read("source", &source);
  return source == "simulator";
}

/// One simulated sensor's own place in the world.
Eigen::Isometry3d ReadPlace(YamlSection* section, const char* key) {
  Eigen::Isometry3d T_rig_sensor = Eigen::Isometry3d::Identity();
  YamlSection place = section->RequiredSection(
      key, "(where the simulated sensor is: quaternion_xyzw, translation_m)");
  if (section->Has(key)) ReadTransform(&place, &T_rig_sensor);
  place.RefuseUnknownKeys();
  return T_rig_sensor;
}

SimulatedLidar ReadSimulatedLidar(const ScanOptions& shared, SensorEntry* entry) {
  SimulatedLidar lidar;
  lidar.name = entry->name;
  lidar.scan = shared;
  YamlSection section = entry->section.Section("simulation");
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
  YamlSection section = entry->section.Section("simulation");
  camera.T_camera_rig = ReadPlace(&section, "T_rig_camera").inverse();
  section.RefuseUnknownKeys();
  return camera;
}

/// What a rig's world has not: its sensors say where they are, and its board follows its script.
void RefuseKeysOfOnePair(YamlSection* top) {
  YamlSection section = top->Section("simulation");
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

void ReadSimulatedRig(YamlSection* top,
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
    entry->section.Section(driver).AddError(
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
