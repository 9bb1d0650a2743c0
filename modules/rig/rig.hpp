#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/diagnosis.hpp"
#include "core/board/board_spec.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "core/estimation/average.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/guidance/next_pose.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/lidar_packets/packet_stream.hpp"
#include "core/sampling/sample_picker.hpp"
#include "core/scene/scene_check.hpp"
#include "core/scene/scene_window_options.hpp"
#include "core/selection/consistency.hpp"
#include "core/selection/select_sets.hpp"
#include "core/simulation/rig_simulation.hpp"
#include "core/simulation/simulation.hpp"
#include "rig/dashboard_options.hpp"
#include "rig/lcm_url.hpp"

namespace voqcal {

/// The channel of each message, prefix included.
struct Channels {
  std::string lidar_points = "LIDAR_POINTS";
  std::string lidar_packets = "LIDAR_PACKETS";
  std::string camera_image = "CAMERA_IMAGE";
  std::string camera_info = "CAMERA_INFO";
  std::string lidar_board = "LIDAR_BOARD";
  std::string camera_board = "CAMERA_BOARD";
  std::string calib_command = "CALIB_COMMAND";
  std::string calib_event = "CALIB_EVENT";
  std::string calib_samples = "CALIB_SAMPLES";
  std::string voq_sets = "VOQ_SETS";
  std::string extrinsic_averaged = "EXTRINSIC_AVERAGED";
  std::string extrinsic_refined = "EXTRINSIC_REFINED";
  std::string calib_assessment = "CALIB_ASSESSMENT";
  std::string next_pose = "NEXT_POSE";
  std::string simulated_board = "SIMULATED_BOARD";
  std::string module_status = "MODULE_STATUS";
  std::string camera_to_lidar = "CAMERA_TO_LIDAR";
  std::string extrinsic_check = "EXTRINSIC_CHECK";
  std::string rig_extrinsics = "RIG_EXTRINSICS";
};

/// Frames without a clock of their own (folders, simulation) count from here: 2020-01-01T00:00:00Z,
/// microseconds since the Unix epoch. Never the wall clock: the same frames get the same times.
inline constexpr std::int64_t kSyntheticEpochUtime = 1577836800000000;

/// The frames of a driver, whichever it is.
struct FrameOptions {
  std::filesystem::path folder;  ///< For kFolder: files in natural order (pose2 before pose10).
  std::string file_ending;       ///< For kFolder: only names that end so ("_full.pcd"); empty: all.
  double rate_hz = 10.0;         ///< Frames a second, of a folder or the simulator.
  bool is_repeating = false;     ///< For kFolder: starts again after the last file.
  bool is_by_order = false;      ///< For kFolder: frames are the first, the second, ... file.
};

/// Where the lidar driver's sweeps come from.
struct LidarDriverOptions : FrameOptions {
  enum class Source { kFolder, kSimulator, kSensor };

  Source source = Source::kFolder;

  /// One line for each broken constraint, with its value; empty if the options are usable. Whether
  /// the folder exists is for the driver to say: a rig file also serves where there is no such
  /// folder.
  std::vector<std::string> Problems() const;
};

/// Where the camera driver's images come from.
struct CameraDriverOptions : FrameOptions {
  enum class Source { kFolder, kSimulator, kVideo, kGenicam };

  Source source = Source::kFolder;
  int jpeg_quality = 95;  ///< Of images that are no files yet: 1 to 100.
  // For kVideo: one of these three.
  std::string device;    ///< V4L2: /dev/video0.
  std::string pipeline;  ///< GStreamer: "... ! appsink".
  std::string url;       ///< A stream (rtsp://...) or a video file.
  /// For kGenicam: as Aravis lists it, or its address or serial number; empty: the only one there.
  std::string camera_id;
  /// For kVideo and kGenicam: how long after a loss the camera is sought again.
  double retry_s = 1.0;

  /// As those of LidarDriverOptions.
  std::vector<std::string> Problems() const;
};

/// A lidar whose packets the driver reads itself, from the network or a capture.
struct LidarSensorOptions {
  LidarPacketOptions packets;
  /// The vendor's file on this very unit, in the format that its protocol names; empty: none.
  std::filesystem::path calibration;
  std::filesystem::path pcap;  ///< A capture instead of the network; empty: the network.
  bool is_unpaced = false;     ///< A capture as fast as it can be read, not as it was recorded.
  /// Of this host, on which packets are awaited: an IPv4 address of its network card, or 0.0.0.0
  /// for all cards (needed for broadcasts). By default nothing from beyond this host arrives.
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0: the sensor's usual one.
  /// A result file whose lidar_bias is taken off all ranges; empty: none.
  std::filesystem::path bias_from;
  bool are_packets_published = false;  ///< On the channel lidar_packets, as they came.

  int Port() const { return port != 0 ? port : packets.protocol->port; }

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// What watches an extrinsic after the calibration.
struct ExtrinsicMonitorOptions {
  std::filesystem::path extrinsic;  ///< A result; empty: the session's.
  SceneWindowOptions window;
};

/// Everything that a rig file says of one lidar and one camera. Every option of every module has
/// its place here.
struct Rig {
  std::string rig_name;                ///< As the file says.
  std::string name;                    ///< The same; of a pair out of several "RIG_LIDAR_CAMERA".
  std::filesystem::path path;          ///< As it was given (RigPlace).
  std::string sha256;                  ///< Of the file's bytes, lower-case hex.
  std::vector<std::string> remarks;    ///< What it says in vain; logged when it is loaded.
  std::string lidar_name = "lidar";    ///< As the file names it under lidars...
  std::string camera_name = "camera";  ///< ...and cameras, if it does.
  std::string lcm_url = kDefaultLcmUrl;
  /// Of .lcm files that define the types of other teams' recordings; empty: ours and bot_core's.
  std::filesystem::path lcm_types;
  Channels channels;
  BoardSpec board;
  bool is_plate_given = true;  ///< Else board.width_m and height_m are only what its pattern needs.
  CameraModel camera;
  /// Roughly where the camera is (within some 5 degrees and 0.2 m), if anyone knows: where to look
  /// for boards that the lidar alone is unsure of. The result does not lean on it.
  std::optional<Eigen::Isometry3d> T_camera_lidar_guess;
  LidarDriverOptions lidar_driver;
  LidarSensorOptions lidar_sensor;  ///< Under lidar_driver; for source kSensor.
  CameraDriverOptions camera_driver;
  SimulationOptions simulation;  ///< Used by drivers whose source is the simulator.
  /// Of a file of several sensors that are the simulator's: the world of them all, whichever are
  /// meant. Without sensors: `simulation` is the world.
  RigSimulationOptions simulated_rig;
  LidarBoardOptions lidar_board_detector;
  CameraBoardOptions camera_board_detector;
  SamplePickerOptions sample_collector;
  ConsistencyOptions consistency;  ///< Under voq_selector.
  SelectionOptions voq_selector;
  SetExtrinsicOptions extrinsic_estimator;
  AverageOptions average;  ///< Under extrinsic_estimator.
  RefinerOptions extrinsic_refiner;
  SceneCheckOptions scene_check;  ///< Under assessor.
  DiagnosisOptions diagnosis;     ///< Under assessor.
  DashboardOptions dashboard;
  GuidanceOptions pose_guide;
  ExtrinsicMonitorOptions extrinsic_monitor;

  /// What of it the method needs.
  CalibrationTask Task() const;
};

/// Where a rig is found: a file, and which of its sensors are meant. What follows the last # of a
/// path that is no file names them: "rig.yaml#front,left".
struct RigPlace {
  std::filesystem::path file;
  std::vector<std::string> names;
};
RigPlace PlaceOfRig(const std::filesystem::path& path);

/// The sensors of a rig file by name, in its order.
struct RigSensors {
  std::vector<std::string> lidars;
  std::vector<std::string> cameras;
};

/// Reads and checks a rig file (YAML). Options that are not given keep their defaults; board and
/// camera must be given. Of a file with several lidars or cameras, `path` names one pair
/// (RigPlace), which is read as if the file had no others.
/// @throws std::runtime_error naming file, line, key, rule and value: missing or unknown keys,
///     wrong types, Problems() of any part; which pairs there are, if `path` names none.
Rig LoadRig(const std::filesystem::path& path);

/// What a file's `pair:` line says, which a session's copy has: the session is of that pair. Who
/// calibrates or checks a whole rig takes every pair all the same; `sensors:` chooses for both.
enum class PairLine { kChooses, kIsIgnored };

/// Those that are meant: of a kind of which `path` (or, where it names none, the file) names some,
/// these, else all. None if the file does not have them by name.
/// @throws as LoadRig if the sensors' names are wrong.
RigSensors SensorsOfRig(const std::filesystem::path& path, PairLine line = PairLine::kChooses);

/// A path for each pair of SensorsOfRig: each camera of the first lidar, of the second, ...; `path`
/// itself if the file does not have them by name.
/// @throws as LoadRig if the sensors' names are wrong.
std::vector<std::filesystem::path> PairsOfRig(const std::filesystem::path& path,
                                              PairLine line = PairLine::kChooses);

/// Which sensors a program works on.
enum class SensorChoice { kPair, kLidar, kCamera };

/// For a program of one sensor: of a file with several, `path` names that one alone
/// ("rig.yaml#front"). What is said of the other kind is then that of any.
Rig LoadRig(const std::filesystem::path& path, SensorChoice choice);

/// LoadRig of each of PairsOfRig.
/// @throws as LoadRig, each problem once.
std::vector<Rig> LoadPairs(const std::filesystem::path& path, PairLine line = PairLine::kChooses);

/// What a rig file says of a lens that may still have to be found.
struct LensInRig {
  std::optional<LensModel> model;  ///< Nothing: not given, or `automatic`.
  /// The whole camera, if all of it is given. Of Rig::camera width_px and height_px are then as
  /// given too, else 0 where they are not.
  std::optional<CameraModel> camera;
};

/// The same of a rig file whose camera may be unknown, whole or in part.
Rig LoadRig(const std::filesystem::path& path, LensInRig* lens);

/// Whether a rig file must say how large the board's plate is.
enum class PlateInRig { kRequired, kMayBeMissing };

Rig LoadRig(const std::filesystem::path& path, PlateInRig plate);

}  // namespace voqcal
