#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace voqcal {

/// Every module of a pair's session, in the order of the flow (modules/names.txt).
std::vector<std::string> AllModuleNames();

/// The module that a session of several sensors has beside drivers, detectors and collectors.
inline constexpr char kRigCalibrator[] = "rig_calibrator";
/// The page: of a pair, or one for all of a rig.
inline constexpr char kDashboard[] = "dashboard";

/// It may end by itself: what it reads has an end. No other module may.
/// @param name  of the module, or of one of several such (SessionProgram).
bool IsDriver(const std::string& name);

/// The module that such a name is of: "lidar_driver" of "lidar_driver_front"; empty if it is none
/// of a session's.
std::string ModuleOf(const std::string& name);

/// One process of a session.
struct SessionProgram {
  /// In MODULE_STATUS, under the supervisor and of its output: the module's; where a rig has one
  /// for each sensor or pair, "lidar_driver_front", "sample_collector_front_left".
  std::string name;
  std::string module;  ///< Its folder and its binary.
  /// The sensors that it is started with ("front", "front,left"); empty: as the rig was given.
  std::string sensors;
  std::string folder;  ///< Of its files, within the session's; empty: that itself.
};

/// What a session runs: of a pair every module once; of several sensors a driver and a detector
/// each, a sample collector a pair, the rig's calibrator and its page. In the order of the flow.
/// @throws as PairsOfRig.
std::vector<SessionProgram> ProgramsOfRig(const std::filesystem::path& rig);

}  // namespace voqcal
