#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/diagnosis.hpp"
#include "core/scene/scene_check.hpp"
#include "core/board/board_spec.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "core/estimation/average.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/guidance/next_pose.hpp"
#include "core/lidar/packet_stream.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/sampling/sample_picker.hpp"
#include "core/selection/consistency.hpp"
#include "core/selection/select_sets.hpp"
#include "core/simulation/simulation.hpp"
#include "rig/dashboard_options.hpp"

namespace voqcal {

/// The same as Bus' own default (a test of messaging holds them together): this module does not
/// know LCM.
inline constexpr char kDefaultRigLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

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
};

/// Frames without a clock of their own (folders, simulation) count from here: 2020-01-01T00:00:00Z,
/// microseconds since the Unix epoch. Never the wall clock: the same frames get the same times.
inline constexpr std::int64_t kSyntheticEpochUtime = 1577836800000000;

/// kVideo is a camera's, kVlp16 and kSpectrumScan are a lidar's.
enum class DriverSource { kFolder, kSimulator, kVideo, kVlp16, kSpectrumScan };

/// Where a driver's frames come from.
struct DriverOptions {
  DriverSource source = DriverSource::kFolder;
  std::filesystem::path folder;  ///< For kFolder: files in natural order (pose2 before pose10).
  std::string file_ending;       ///< For kFolder: only names that end so ("_full.pcd"); empty: all.
  double rate_hz = 10.0;         ///< Frames a second.
  bool is_repeating = false;     ///< For kFolder: starts again after the last file.
  int jpeg_quality = 95;         ///< Camera only, of images that are no files yet: 1 to 100.
  // For kVideo, camera only: one of these three.
  std::string device;    ///< V4L2: /dev/video0.
  std::string pipeline;  ///< GStreamer: "... ! appsink".
  std::string url;       ///< A stream (rtsp://...) or a video file.
  double retry_s = 1.0;  ///< For kVideo: how long after a loss the camera is sought again.

  /// One line for each broken constraint, with its value; empty if the options are usable. Whether
  /// the folder exists is for the driver to say: a rig file also serves where there is no such
  /// folder.
  std::vector<std::string> Problems() const;
};

/// A lidar whose packets the driver reads itself, from the network or a capture.
struct LidarSensorOptions {
  LidarPacketOptions packets;
  std::filesystem::path pcap;  ///< A capture instead of the network; empty: the network.
  bool is_unpaced = false;     ///< A capture as fast as it can be read, not as it was recorded.
  /// Of this host, on which packets are awaited: an IPv4 address of its network card, or 0.0.0.0
  /// for all cards (needed for broadcasts). By default nothing from beyond this host arrives.
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0: the sensor's usual one, see Port().
  /// A result file whose lidar_bias is taken off all ranges; empty: none.
  std::filesystem::path bias_from;
  bool are_packets_published = false;  ///< On the channel lidar_packets, as they came.

  int Port() const;  ///< 2368 (VLP-16) or 5044 (Spectrum-Scan) unless `port` says otherwise.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Everything that a rig file says. Every option of every module has its place here.
struct Rig {
  std::string name;
  std::filesystem::path path;
  std::string sha256;  ///< Of the file's bytes, lower-case hex.
  std::string lcm_url = kDefaultRigLcmUrl;
  Channels channels;
  BoardSpec board;
  CameraModel camera;
  DriverOptions lidar_driver;
  LidarSensorOptions lidar_sensor;  ///< Under lidar_driver; for sources kVlp16 and kSpectrumScan.
  DriverOptions camera_driver;
  SimulationOptions simulation;  ///< Used by drivers whose source is the simulator.
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

  /// What of it the method needs.
  CalibrationTask Task() const;
};

/// Reads and checks a rig file (YAML). Options that are not given keep their defaults; board and
/// camera must be given.
/// @throws std::runtime_error naming file, line, key, rule and value: missing or unknown keys,
/// wrong
///     types, Problems() of any part.
Rig LoadRig(const std::filesystem::path& path);

}  // namespace voqcal
