#include "rig/rig.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <arpa/inet.h>
#include <spdlog/spdlog.h>

#include "core/add_if_new.hpp"
#include "core/problems.hpp"
#include "files/atomic_file.hpp"
#include "files/sha256.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {

std::vector<std::string> LidarDriverOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("rate_hz", rate_hz);
  return problems.lines();
}

std::vector<std::string> CameraDriverOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("rate_hz", rate_hz);
  problems.Require(
      jpeg_quality >= 1 && jpeg_quality <= 100, "jpeg_quality must be 1 to 100", jpeg_quality);
  const int num_named = !device.empty() + !pipeline.empty() + !url.empty();
  if (source == Source::kVideo && num_named != 1) {
    problems.Add(
        {"source video needs one of device, pipeline and url, has " + std::to_string(num_named)});
  }
  problems.RequirePositive("retry_s", retry_s);
  return problems.lines();
}

std::vector<std::string> LidarSensorOptions::Problems() const {
  ProblemList problems;
  problems.Add(packets.Problems());
  in_addr parsed{};
  problems.Require(inet_pton(AF_INET, address.c_str(), &parsed) == 1,
                   "address must be an IPv4 address of this host",
                   '"' + address + '"');
  problems.Require(!packets.protocol->needs_calibration || !calibration.empty(),
                   "calibration must name " + packets.protocol->calibration + " of this " +
                       packets.protocol->title,
                   "not given");
  problems.Require(port >= 0 && port <= 65535, "port must be 0 to 65535", port);
  return problems.lines();
}

CalibrationTask Rig::Task() const {
  return {board,
          camera,
          {consistency,
           voq_selector,
           extrinsic_estimator,
           average,
           extrinsic_refiner,
           scene_check,
           diagnosis,
           pose_guide.enough}};
}

namespace {

Rig Load(const std::filesystem::path& path,
         SensorChoice choice,
         LensInRig* lens,
         PlateInRig plate = PlateInRig::kRequired) {
  const RigPlace place = PlaceOfRig(path);
  const std::string text = ReadWholeFile(place.file);
  YamlDocument document(place.file.string(), text);
  Rig rig;
  rig.path = path;
  rig.sha256 = Sha256OfBytes(text);
  ReadRigSections(place, &document, &rig, lens, choice, plate);
  document.ThrowIfWrong();
  rig.remarks = document.Remarks();
  return rig;
}

Rig Told(Rig rig) {
  for (const std::string& remark : rig.remarks) spdlog::warn(remark);
  return rig;
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Those of `sensors` that `names` names; all of them if it names none.
std::vector<std::string> Meant(const std::vector<std::string>& sensors,
                               const std::vector<std::string>& names) {
  std::vector<std::string> meant;
  for (const std::string& each : sensors) {
    if (Has(names, each)) meant.push_back(each);
  }
  return meant.empty() ? sensors : meant;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

RigPlace PlaceOfRig(const std::filesystem::path& path) {
  const std::string text = path.string();
  const std::size_t hash = text.rfind('#');
  std::error_code ignored;  // told by whoever reads it
  if (hash == std::string::npos || std::filesystem::is_regular_file(path, ignored))
    return {path, {}};
  RigPlace place = {text.substr(0, hash), {}};
  std::istringstream names(text.substr(hash + 1));
  for (std::string name; std::getline(names, name, ',');) place.names.push_back(name);
  return place;
}

Rig LoadRig(const std::filesystem::path& path) { return LoadRig(path, SensorChoice::kPair); }

Rig LoadRig(const std::filesystem::path& path, SensorChoice choice) {
  return Told(Load(path, choice, nullptr));
}

Rig LoadRig(const std::filesystem::path& path, LensInRig* lens) {
  return Told(Load(path, SensorChoice::kCamera, lens));
}

Rig LoadRig(const std::filesystem::path& path, PlateInRig plate) {
  return Told(Load(path, SensorChoice::kPair, nullptr, plate));
}

RigSensors SensorsOfRig(const std::filesystem::path& path, PairLine pair_line) {
  RigPlace place = PlaceOfRig(path);
  YamlDocument document(place.file.string(), ReadWholeFile(place.file));
  const RigSensors sensors = ReadRigSensors(pair_line, &place, &document);
  return {Meant(sensors.lidars, place.names), Meant(sensors.cameras, place.names)};
}

std::vector<std::filesystem::path> PairsOfRig(const std::filesystem::path& path,
                                              PairLine pair_line) {
  const RigSensors sensors = SensorsOfRig(path, pair_line);
  if (sensors.lidars.empty()) return {path};
  std::vector<std::filesystem::path> paths;
  for (const std::string& lidar : sensors.lidars) {
    for (const std::string& camera : sensors.cameras) {
      paths.emplace_back(PlaceOfRig(path).file.string() + "#" + lidar + "," + camera);
    }
  }
  return paths;
}

std::vector<Rig> LoadPairs(const std::filesystem::path& path, PairLine pair_line) {
  std::vector<Rig> rigs;
  std::vector<std::string> remarks;  // of one file, whichever pair is read
  std::vector<std::string> problems;
  for (const std::filesystem::path& each : PairsOfRig(path, pair_line)) {
    try {
      rigs.push_back(Load(each, SensorChoice::kPair, nullptr));
      for (const std::string& remark : rigs.back().remarks) AddIfNew(remark, &remarks);
    } catch (const std::runtime_error& error) {
      for (const std::string& line : LinesOf(error.what())) AddIfNew(line, &problems);
    }
  }
  for (const std::string& remark : remarks) spdlog::warn(remark);
  std::string text;
  for (const std::string& line : problems) text += (text.empty() ? "" : "\n") + line;
  if (!problems.empty()) throw std::runtime_error(text);
  return rigs;
}

}  // namespace voqcal
