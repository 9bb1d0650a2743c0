#include "health/session_programs.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "core/sensor_network/sensor_pair.hpp"
#include "core/starts_with.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

SessionProgram OfSensor(const std::string& module, const std::string& sensor) {
  return {module + "_" + sensor, module, sensor, ""};
}

}  // namespace

std::vector<std::string> AllModuleNames() {
  std::istringstream names(VOQCAL_MODULES);  // modules/names.txt
  return {std::istream_iterator<std::string>(names), {}};
}

std::string ModuleOf(const std::string& name) {
  static const std::vector<std::string> kModules = [] {
    std::vector<std::string> names = AllModuleNames();
    names.emplace_back(kRigCalibrator);
    return names;
  }();
  for (const std::string& module : kModules) {
    if (name == module || StartsWith(name, module + "_")) return module;
  }
  return {};
}

bool IsDriver(const std::string& name) {
  const std::string module = ModuleOf(name);
  return module == "lidar_driver" || module == "camera_driver";
}

std::vector<SessionProgram> ProgramsOfRig(const std::filesystem::path& rig) {
  const RigSensors sensors = SensorsOfRig(rig);
  std::vector<SessionProgram> programs;
  if (sensors.lidars.size() * sensors.cameras.size() < 2) {
    for (const std::string& module : AllModuleNames()) programs.push_back({module, module, "", ""});
    return programs;
  }
  for (const char* kind : {"driver", "board_detector"}) {
    for (const std::string& lidar : sensors.lidars) {
      programs.push_back(OfSensor(std::string("lidar_") + kind, lidar));
    }
    for (const std::string& camera : sensors.cameras) {
      programs.push_back(OfSensor(std::string("camera_") + kind, camera));
    }
  }
  for (const std::string& lidar : sensors.lidars) {
    for (const std::string& camera : sensors.cameras) {
      const std::string name = PairName(lidar, camera);
      programs.push_back(
          {"sample_collector_" + name, "sample_collector", lidar + "," + camera, name});
    }
  }
  for (const char* module : {kRigCalibrator, kDashboard}) {
    programs.push_back({module, module, "", ""});
  }
  return programs;
}

}  // namespace voqcal
