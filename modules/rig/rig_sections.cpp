#include "rig/rig_sections.hpp"

#include <optional>
#include <stdexcept>

#include "core/sensor_network/sensor_pair.hpp"
#include "rig/assessor_section.hpp"
#include "rig/board_section.hpp"
#include "rig/camera_section.hpp"
#include "rig/channel_section.hpp"
#include "rig/detector_sections.hpp"
#include "rig/driver_sections.hpp"
#include "rig/lcm_url.hpp"
#include "rig/pose_guide_section.hpp"
#include "rig/refiner_section.hpp"
#include "rig/section_reading.hpp"
#include "rig/sensor_entries.hpp"
#include "rig/simulation_section.hpp"

namespace voqcal {
namespace {

void ReadLcm(OptionSection* top,
             const std::filesystem::path& rig_path,
             Rig* rig,
             std::string* channel_prefix) {
  OptionSection section = top->Section("lcm", "the network that all modules share");
  section.Read(
      "url",
      &rig->lcm_url,
      "with another port, networks on this one are not heard. ttl=0: nothing leaves the host. "
      "recv_buf_size lets whole images and sweeps arrive (bytes; see net.core.rmem_max)");
  const std::string problem = LcmUrlProblem(rig->lcm_url);
  if (!problem.empty()) section.AddError("url", problem);
  section.Read("channel_prefix", channel_prefix, "put before each channel, \"FRONT_\"");
  ReadPath("types",
           rig_path,
           &section,
           &rig->lcm_types,
           "folder of the .lcm files that define clouds, images or packets of other types than "
           "bot_core's, for calibrate --bag LOG. What they are is told by their members' names "
           "(tools/node/README.md)");
  section.RefuseUnknownKeys();
}

void ReadSampleCollector(OptionSection* top, SamplePickerOptions* options) {
  OptionSection section =
      top->Section("sample_collector", "when a pair of sightings becomes a sample");
  section.Read("max_pair_offset_s",
               &options->max_pair_offset_s,
               "time from sweep to image of a pair, at most");
  section.Read("num_still_frames",
               &options->num_still_frames,
               "pairs in a row over which the board must rest");
  section.Read("max_still_motion_m",
               &options->max_still_motion_m,
               "resting: its centre moves less, by the lidar");
  section.Read("max_still_motion_px",
               &options->max_still_motion_px,
               "resting: its corners move less, by the camera");
  section.Read("min_new_distance_m",
               &options->min_new_distance_m,
               "a pose is new if it is this far from every sample's...");
  section.ReadDegrees("min_new_angle_deg", &options->min_new_angle_rad, "...or turned by this");
  section.Read(
      "max_edge_error_m", &options->max_edge_error_m, "largest error of a measured edge length");
  section.Read("max_candidates",
               &options->max_candidates,
               "patches that might be the board, kept with a sample");
  CheckAndClose(*options, &section);
}

void ReadVoqSelector(OptionSection* top,
                     SelectionOptions* options,
                     ConsistencyOptions* consistency) {
  OptionSection section = top->Section("voq_selector", "how sets of poses are chosen");
  section.ReadOneOf("criterion",
                    ByName(AllSelectionCriteria()),
                    &options->criterion,
                    "what is chosen by (voq: as published; all_poses: one set of all)");
  section.Read("seed", &options->seed, "of criterion random");
  section.Read("num_sets", &options->num_sets, "sets of three poses");
  OptionSection pairs =
      section.Section("consistency", "pairs of poses look alike to both sensors, or one is wrong");
  pairs.Read("max_distance_m",
             &consistency->max_distance_m,
             "distance between two centres, lidar against camera");
  pairs.ReadDegrees("max_angle_deg",
                    &consistency->max_angle_rad,
                    "angle between two normals, lidar against camera");
  CheckAndClose(*consistency, &pairs);
  CheckAndClose(*options, &section);
}

void ReadExtrinsicEstimator(OptionSection* top,
                            SetExtrinsicOptions* options,
                            AverageOptions* average) {
  OptionSection section =
      top->Section("extrinsic_estimator", "the extrinsic of each set, then their mean");
  section.ReadDegrees("sigma_normal_deg", &options->sigma_normal_rad, "noise of a lidar normal");
  section.Read(
      "sigma_centre_m", &options->sigma_centre_m, "noise of a lidar centre, mostly in range");
  section.Read("sigma_centre_px",
               &options->sigma_centre_px,
               "noise of a lidar centre across the view, in pixels");
  section.Read("max_iterations", &options->max_iterations, "of one set's fit");
  section.Read(
      "max_z_score", &average->max_z_score, "sets beyond this many standard deviations go");
  section.AddProblems(average->Problems());
  CheckAndClose(*options, &section);
}

void ReadExtrinsicMonitor(OptionSection* top,
                          const std::filesystem::path& rig_path,
                          ExtrinsicMonitorOptions* options) {
  OptionSection section = top->Section(
      "extrinsic_monitor", "watches an extrinsic after the calibration, without a board");
  ReadPath("extrinsic", rig_path, &section, &options->extrinsic, "a result; \"\": the session's");
  section.Read("max_apart_s", &options->window.max_apart_s, "between a sweep and its image");
  section.Read("every_s", &options->window.every_s, "at least so long between two scenes");
  section.Read("window_s", &options->window.window_s, "the scenes of so long are judged together");
  CheckAndClose(options->window, &section);
}

/// Roughly where a sensor is on its rig: p_rig = T_rig_sensor * p_sensor.
std::optional<Eigen::Isometry3d> ReadMount(SensorEntry* entry, const char* key) {
  return entry->section.ReadTransform(
      key, "roughly where it is on the rig: tells where to look for unsure boards");
}

/// Where the two are on the rig tells where they are to each other.
void ReadMounts(const PairOfEntries& pair, Rig* rig) {
  const auto T_rig_lidar = ReadMount(pair.lidar, "T_rig_lidar_guess");
  const auto T_rig_camera = ReadMount(pair.camera, "T_rig_camera_guess");
  if (rig->T_camera_lidar_guess) {
    YamlSection camera = pair.camera->section.Peek("camera");
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
void ReadDetector(void (*read)(OptionSection*, Options*),
                  const char* key,
                  OptionSection* sensor,
                  OptionSection* top,
                  Options* options) {
  Options own = *options;
  read(top, options);
  if (sensor == top) return;
  read(sensor, &own);
  if (sensor->Has(key)) *options = own;
}

/// What belongs to one lidar or one camera, from where each has its sections.
void ReadSensors(const std::filesystem::path& rig_path,
                 OptionSection* top,
                 OptionSection* lidar,
                 OptionSection* camera,
                 Rig* rig,
                 LensInRig* lens) {
  ReadCamera(camera, &rig->camera, &rig->T_camera_lidar_guess, lens);
  ReadLidarDriver(lidar, rig_path, &rig->lidar_driver, &rig->lidar_sensor);
  ReadCameraDriver(camera, rig_path, &rig->camera_driver);
  ReadSimulation(top, &rig->simulation);
  ReadDetector(
      ReadLidarBoardDetector, "lidar_board_detector", lidar, top, &rig->lidar_board_detector);
  ReadDetector(
      ReadCameraBoardDetector, "camera_board_detector", camera, top, &rig->camera_board_detector);
}

/// Where the path names none, the file may: a session's copy says which were meant.
RigPlace PlaceInFile(const RigPlace& place, PairLine line, OptionSection* top) {
  std::string names;
  std::string pair;
  top->Read("sensors", &names, "those that are meant, if the path names none: front,left,right");
  top->Read("pair", &pair, "the same for who takes one pair alone: front,left");
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
                      OptionSection* top,
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
    pair.camera->section.Peek("simulation");
    pair.lidar->section.Peek("simulation");
  }
  pair.lidar->section.RefuseUnknownKeys();
  pair.camera->section.RefuseUnknownKeys();
}

}  // namespace

RigSensors ReadRigSensors(PairLine line, RigPlace* place, YamlDocument* document) {
  OptionSection top(document);
  const SensorEntries entries = ReadSensorEntries(&top);
  document->ThrowIfWrong();
  *place = PlaceInFile(*place, line, &top);
  document->ThrowIfWrong();
  RequireNames(*place, entries.Names());
  return entries.Names();
}

void ReadRigSections(const RigPlace& place,
                     YamlDocument* document,
                     Rig* rig,
                     LensInRig* lens,
                     SensorChoice choice,
                     PlateInRig plate) {
  OptionSection top(document);
  SensorEntries entries = ReadSensorEntries(&top);
  document->ThrowIfWrong();  // before any of them is chosen
  std::string channel_prefix;
  top.ReadRequired("rig", &rig->rig_name, "name of the rig, as reports show it");
  rig->name = rig->rig_name;
  ReadLcm(&top, place.file, rig, &channel_prefix);
  rig->is_plate_given = ReadBoard(&top, plate, &rig->board);
  if (entries.AreGiven()) {
    ReadNamedSensors(place, choice, channel_prefix, &top, &entries, rig, lens);
  } else {
    RequireNames(place, {});
    ReadSensors(place.file, &top, &top, &top, rig, lens);
    ReadChannels(&top, channel_prefix, &rig->channels);
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
