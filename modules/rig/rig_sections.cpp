#include "rig/rig_sections.hpp"

#include <optional>
#include <stdexcept>
#include <variant>

#include "core/camera_detection/calibration_target.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "files/transform_yaml.hpp"
#include "rig/assessor_section.hpp"
#include "rig/camera_section.hpp"
#include "rig/channel_section.hpp"
#include "rig/driver_sections.hpp"
#include "rig/lcm_url.hpp"
#include "rig/pose_guide_section.hpp"
#include "rig/refiner_section.hpp"
#include "rig/section_reading.hpp"
#include "rig/sensor_entries.hpp"
#include "rig/simulation_section.hpp"

namespace voqcal {
namespace {

void ReadLcm(YamlSection* top,
             const std::filesystem::path& rig_path,
             Rig* rig,
             std::string* channel_prefix) {
  YamlSection section = top->Section("lcm");
  section.Read("url", &rig->lcm_url);
  const std::string problem = LcmUrlProblem(rig->lcm_url);
  if (!problem.empty()) section.AddError("url", problem);
  section.Read("channel_prefix", channel_prefix);
  ReadPath("types", rig_path, &section, &rig->lcm_types);
  section.RefuseUnknownKeys();
}

void ReadTargetKey(const TargetKey& key, YamlSection* section, BoardSpec* board) {
  const auto read = [&](auto field) {
    if (key.is_required) return section->ReadRequired(key.name, &(board->*field));
    section->Read(key.name, &(board->*field));
  };
  std::visit(read, key.field);
  if (const auto* count = std::get_if<int BoardSpec::*>(&key.field)) board->*(*count) *= key.times;
}

void ReadBoard(YamlSection* top, BoardSpec* board) {
  YamlSection section = top->RequiredSection("board");
  if (!top->Has("board")) return;
  section.ReadRequired("width_m", &board->width_m);
  section.ReadRequired("height_m", &board->height_m);
  section.Read("pattern_offset_x_m", &board->pattern_offset_x_m);
  section.Read("pattern_offset_y_m", &board->pattern_offset_y_m);
  const char* pattern =
      section.Has("target_type") ? "target_type" : "pattern";  // Kalibr's and ours
  section.Read(pattern, &board->pattern);
  const CalibrationTarget* target = FindCalibrationTarget(board->pattern);
  if (target == nullptr) {
    return section.AddError(pattern, "must be one of " + CalibrationTargetNames());
  }
  for (const TargetKey& key : target->keys) ReadTargetKey(key, &section, board);
  if (section.IsComplete()) section.AddProblems(BoardProblems(*board));
  section.RefuseUnknownKeys();
}

void ReadLidarBoardDetector(YamlSection* top, LidarBoardOptions* options) {
  YamlSection section = top->Section("lidar_board_detector");
  section.Read("min_range_m", &options->min_range_m);
  section.Read("max_range_m", &options->max_range_m);
  YamlSection box = section.Section("region_of_interest");
  if (section.Has("region_of_interest")) {
    RegionOfInterest region;
    box.ReadRequired("min_lidar_m", &region.min_lidar_m);
    box.ReadRequired("max_lidar_m", &region.max_lidar_m);
    options->region_of_interest = region;
  }
  box.RefuseUnknownKeys();
  section.Read("max_corner_sigma_m", &options->max_corner_sigma_m);
  section.Read("max_bend_m", &options->max_bend_m);
  section.Read("thickness_m", &options->thickness_m);
  section.Read("thickness_sigma_m", &options->thickness_sigma_m);
  section.Read("max_accumulation_s", &options->max_accumulation_s);
  YamlSection beam = section.Section("beam");
  beam.Read("spill_m", &options->beam.spill_m);
  beam.Read("spill_sigma_m", &options->beam.spill_sigma_m);
  beam.Read("blur_m", &options->beam.blur_m);
  beam.Read("blur_per_m", &options->beam.blur_per_m);
  beam.Read("hit_band_m", &options->beam.hit_band_m);
  beam.Read("line_sigma_m", &options->beam.line_sigma_m);
  beam.RefuseUnknownKeys();
  YamlSection background = section.Section("background");
  background.Read("is_used", &options->background.is_used);
  background.Read("memory_sweeps", &options->background.memory_sweeps);
  background.Read("min_step_m", &options->background.min_step_m);
  background.RefuseUnknownKeys();
  CheckAndClose(*options, &section);
}

void ReadCameraBoardDetector(YamlSection* top, CameraBoardOptions* options) {
  YamlSection section = top->Section("camera_board_detector");
  section.Read("max_reprojection_rms_px", &options->max_reprojection_rms_px);
  section.ReadDegrees("max_edge_width_deg", &options->max_edge_width_rad);
  section.Read("max_edge_width_squares", &options->max_edge_width_squares);
  section.Read("min_square_px", &options->min_square_px);
  section.Read("min_contrast", &options->min_contrast);
  section.Read("max_outside_share", &options->max_outside_share);
  section.Read("max_mirrored_probability", &options->max_mirrored_probability);
  CheckAndClose(*options, &section);
}

void ReadSampleCollector(YamlSection* top, SamplePickerOptions* options) {
  YamlSection section = top->Section("sample_collector");
  section.Read("max_pair_offset_s", &options->max_pair_offset_s);
  section.Read("num_still_frames", &options->num_still_frames);
  section.Read("max_still_motion_m", &options->max_still_motion_m);
  section.Read("max_still_motion_px", &options->max_still_motion_px);
  section.Read("min_new_distance_m", &options->min_new_distance_m);
  section.ReadDegrees("min_new_angle_deg", &options->min_new_angle_rad);
  section.Read("max_edge_error_m", &options->max_edge_error_m);
  section.Read("max_candidates", &options->max_candidates);
  CheckAndClose(*options, &section);
}

void ReadVoqSelector(YamlSection* top, SelectionOptions* options, ConsistencyOptions* consistency) {
  YamlSection section = top->Section("voq_selector");
  std::string criterion = ToString(options->criterion);
  section.Read("criterion", &criterion);
  if (const auto known = SelectionCriterionFromString(criterion)) {
    options->criterion = *known;
  } else {
    std::string names;
    for (const SelectionCriterion each : AllSelectionCriteria()) {
      names += (names.empty() ? "" : ", ") + ToString(each);
    }
    section.AddError("criterion", "must be one of " + names);
  }
  section.Read("seed", &options->seed);
  section.Read("num_sets", &options->num_sets);
  YamlSection pairs = section.Section("consistency");
  pairs.Read("max_distance_m", &consistency->max_distance_m);
  pairs.ReadDegrees("max_angle_deg", &consistency->max_angle_rad);
  CheckAndClose(*consistency, &pairs);
  CheckAndClose(*options, &section);
}

void ReadExtrinsicEstimator(YamlSection* top,
                            SetExtrinsicOptions* options,
                            AverageOptions* average) {
  YamlSection section = top->Section("extrinsic_estimator");
  section.ReadDegrees("sigma_normal_deg", &options->sigma_normal_rad);
  section.Read("sigma_centre_m", &options->sigma_centre_m);
  section.Read("sigma_centre_px", &options->sigma_centre_px);
  section.Read("max_iterations", &options->max_iterations);
  section.Read("max_z_score", &average->max_z_score);
  section.AddProblems(average->Problems());
  CheckAndClose(*options, &section);
}

void ReadExtrinsicMonitor(YamlSection* top,
                          const std::filesystem::path& rig_path,
                          ExtrinsicMonitorOptions* options) {
  YamlSection section = top->Section("extrinsic_monitor");
  ReadPath("extrinsic", rig_path, &section, &options->extrinsic);
  section.Read("max_apart_s", &options->window.max_apart_s);
  section.Read("every_s", &options->window.every_s);
  section.Read("window_s", &options->window.window_s);
  CheckAndClose(options->window, &section);
}

/// Roughly where a sensor is on its rig: p_rig = T_rig_sensor * p_sensor.
std::optional<Eigen::Isometry3d> ReadMount(SensorEntry* entry, const char* key) {
  YamlSection section = entry->section.Section(key);
  if (!entry->section.Has(key)) return {};
  Eigen::Isometry3d T_rig_sensor = Eigen::Isometry3d::Identity();
  ReadTransform(&section, &T_rig_sensor);
  section.RefuseUnknownKeys();
  return T_rig_sensor;
}

/// Where the two are on the rig tells where they are to each other.
void ReadMounts(const PairOfEntries& pair, Rig* rig) {
  const auto T_rig_lidar = ReadMount(pair.lidar, "T_rig_lidar_guess");
  const auto T_rig_camera = ReadMount(pair.camera, "T_rig_camera_guess");
  if (rig->T_camera_lidar_guess) {
    YamlSection camera = pair.camera->section.Section("camera");
    camera.AddError("T_camera_lidar_guess",
                    "is of one lidar: give lidars." + pair.lidar->name +
                        ".T_rig_lidar_guess and cameras." + pair.camera->name +
                        ".T_rig_camera_guess instead");
  }
  if (T_rig_lidar && T_rig_camera) {
    rig->T_camera_lidar_guess = T_rig_camera->inverse() * *T_rig_lidar;
  } else if (T_rig_lidar) {
    pair.lidar->section.AddRemark(
        "T_rig_lidar_guess",
        "is not used with " + pair.camera->name + ", which has no T_rig_camera_guess");
  } else if (T_rig_camera) {
    pair.camera->section.AddRemark(
        "T_rig_camera_guess",
        "is not used with " + pair.lidar->name + ", which has no T_rig_lidar_guess");
  }
}

/// A detector's options: the sensor's own, or else those that all of its kind share. Both are
/// checked.
template <typename Options>
void ReadDetector(void (*read)(YamlSection*, Options*),
                  const char* key,
                  YamlSection* sensor,
                  YamlSection* top,
                  Options* options) {
  Options own = *options;
  read(top, options);
  if (sensor == top) return;
  read(sensor, &own);
  if (sensor->Has(key)) *options = own;
}

/// What belongs to one lidar or one camera, from where each has its sections.
void ReadSensors(const std::filesystem::path& rig_path,
                 YamlSection* top,
                 YamlSection* lidar,
                 YamlSection* camera,
                 Rig* rig,
                 LensInRig* lens) {
  ReadCamera(camera, &rig->camera, &rig->T_camera_lidar_guess, lens);
  ReadLidarDriver(lidar, rig_path, &rig->lidar_driver, &rig->lidar_sensor);
  ReadCameraDriver(camera, rig_path, &rig->camera_driver);
  ReadDetector(
      ReadLidarBoardDetector, "lidar_board_detector", lidar, top, &rig->lidar_board_detector);
  ReadDetector(
      ReadCameraBoardDetector, "camera_board_detector", camera, top, &rig->camera_board_detector);
}

/// Where the path names none, the file may: a session's copy says which were meant.
RigPlace PlaceInFile(const RigPlace& place, PairLine line, YamlSection* top) {
  std::string names;
  std::string pair;
  top->Read("sensors", &names);
  top->Read("pair", &pair);
  if (!names.empty() && !pair.empty()) top->AddError("pair", "must not stand beside sensors");
  if (line == PairLine::kChooses && !pair.empty()) names = pair;
  return place.names.empty() && !names.empty()
             ? PlaceOfRig(std::filesystem::path(place.file.string() + "#" + names))
             : place;
}

/// The same of a file that has its sensors by name.
void ReadNamedSensors(const RigPlace& place,
                      SensorChoice choice,
                      const std::string& channel_prefix,
                      YamlSection* top,
                      SensorEntries* entries,
                      Rig* rig,
                      LensInRig* lens) {
  const PairOfEntries pair =
      ChoosePair(PlaceInFile(place, PairLine::kChooses, top), choice, entries);
  rig->lidar_name = pair.lidar->name;
  rig->camera_name = pair.camera->name;
  const bool is_one_of_several = entries->lidars.size() + entries->cameras.size() > 2;
  if (is_one_of_several) rig->name += "_" + PairName(rig->lidar_name, rig->camera_name);
  ReadChannels(top, channel_prefix, pair, entries, &rig->channels);
  ReadSensors(place.file, top, &pair.lidar->section, &pair.camera->section, rig, lens);
  ReadMounts(pair, rig);
  if (lens == nullptr) {
    ReadSimulatedRig(top, pair, entries, rig);
  } else {
    pair.camera->section.Section("simulation");
    pair.lidar->section.Section("simulation");
  }
  pair.lidar->section.RefuseUnknownKeys();
  pair.camera->section.RefuseUnknownKeys();
}

}  // namespace

RigSensors ReadRigSensors(PairLine line, RigPlace* place, YamlDocument* document) {
  YamlSection top(document);
  const SensorEntries entries = ReadSensorEntries(&top);
  document->ThrowIfWrong();
  *place = PlaceInFile(*place, line, &top);
  document->ThrowIfWrong();
  RequireNames(*place, entries.Names());
  return entries.Names();
}

void ReadRigSections(
    const RigPlace& place, YamlDocument* document, Rig* rig, LensInRig* lens, SensorChoice choice) {
  YamlSection top(document);
  SensorEntries entries = ReadSensorEntries(&top);
  document->ThrowIfWrong();  // before any of them is chosen
  std::string channel_prefix;
  top.ReadRequired("rig", &rig->rig_name);
  rig->name = rig->rig_name;
  ReadLcm(&top, place.file, rig, &channel_prefix);
  ReadBoard(&top, &rig->board);
  ReadSimulation(&top, &rig->simulation);
  if (entries.AreGiven()) {
    ReadNamedSensors(place, choice, channel_prefix, &top, &entries, rig, lens);
  } else {
    RequireNames(place, {});
    ReadChannels(&top, channel_prefix, &rig->channels);
    ReadSensors(place.file, &top, &top, &top, rig, lens);
  }
  ReadSampleCollector(&top, &rig->sample_collector);
  ReadVoqSelector(&top, &rig->voq_selector, &rig->consistency);
  ReadExtrinsicEstimator(&top, &rig->extrinsic_estimator, &rig->average);
  // A table's features have no covariances: the selector then expects what the estimator does.
  rig->voq_selector.nominal = {rig->extrinsic_estimator.sigma_normal_rad,
                               rig->extrinsic_estimator.sigma_centre_m,
                               rig->extrinsic_estimator.sigma_centre_px};
  ReadExtrinsicRefiner(&top, &rig->extrinsic_refiner);
  ReadAssessor(&top, &rig->scene_check, &rig->diagnosis);
  ReadDashboard(&top, &rig->dashboard);
  ReadPoseGuide(&top, &rig->pose_guide);
  ReadExtrinsicMonitor(&top, place.file, &rig->extrinsic_monitor);
  rig->pose_guide.sensors.detector = rig->lidar_board_detector;
  top.RefuseUnknownKeys();
}

}  // namespace voqcal
