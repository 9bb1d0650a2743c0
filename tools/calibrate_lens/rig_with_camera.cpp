#include "calibrate_lens/rig_with_camera.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/yaml_reader.hpp"
#include "result/camera_yaml.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

using Lines = std::vector<std::string>;

[[noreturn]] void Refuse() {
  throw std::runtime_error(
      "the rig file's section camera is not written line by line (key: value, indented): put the "
      "lines above in its place yourself");
}

Lines LinesOf(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string KeyOf(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  const std::size_t colon = line.find(':');
  if (begin == std::string::npos || colon == std::string::npos || line[begin] == '#') return "";
  return line.substr(begin, colon - begin);
}

// From a value's comment on, with the blanks before it.
std::string CommentOf(const std::string& line) {
  const std::size_t hash = line.find(" #");
  if (hash == std::string::npos) return "";
  return line.substr(line.find_last_not_of(' ', hash) + 1);
}

bool IsBlankOrComment(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(" \t\r");
  return begin == std::string::npos || line[begin] == '#';
}

bool IsTopLevel(const std::string& line) { return !IsBlankOrComment(line) && line[0] != ' '; }

// What follows a key on its line, without its comment.
bool HasValueOnItsLine(const std::string& line) {
  const std::string value = line.substr(0, line.size() - CommentOf(line).size());
  const std::string rest = value.substr(value.find(':') + 1);
  return !IsBlankOrComment(rest) &&
         (rest.find('[') == std::string::npos) == (rest.find(']') == std::string::npos);
}

/// All that a rig file names relative to itself.
std::vector<std::pair<std::string, std::filesystem::path>> PathsOf(const Rig& rig) {
  const bool is_stream = rig.camera_driver.url.find("://") != std::string::npos;
  return {{"lcm.types", rig.lcm_types},
          {"lidar_driver.folder", rig.lidar_driver.folder},
          {"lidar_driver.sensor.pcap", rig.lidar_sensor.pcap},
          {"lidar_driver.sensor.calibration", rig.lidar_sensor.calibration},
          {"lidar_driver.sensor.bias_from", rig.lidar_sensor.bias_from},
          {"camera_driver.folder", rig.camera_driver.folder},
          {"camera_driver.url", is_stream ? "" : rig.camera_driver.url},
          {"extrinsic_monitor.extrinsic", rig.extrinsic_monitor.extrinsic}};
}

}  // namespace

void RequireSamePaths(const Rig& rig,
                      const std::string& rig_text,
                      const std::filesystem::path& copy_path) {
  YamlDocument document(copy_path.string(), rig_text);
  Rig copy;
  copy.path = copy_path;
  LensInRig may_lack;
  ReadRigSections({copy_path, {}}, &document, &copy, &may_lack, SensorChoice::kCamera);
  const auto before = PathsOf(rig);
  const auto after = PathsOf(copy);
  const auto whole = [](const std::filesystem::path& path) {
    return path.empty() ? path : std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  std::string moved;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (whole(before[i].second) == whole(after[i].second)) continue;
    moved += (moved.empty() ? "" : ", ") + before[i].first;
  }
  if (moved.empty()) return;
  throw std::runtime_error(copy_path.string() + ": " + moved +
                           " of the rig file would be another path there: write the copy beside "
                           "the rig file, or make it absolute");
}

std::string RigWithCamera(const std::string& rig_text, const CameraModel& camera) {
  const Lines lines = LinesOf(rig_text);
  const auto section = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return IsTopLevel(line) && KeyOf(line) == "camera";
  });
  Lines written(lines.begin(), section);
  Lines below;
  auto after = section;
  std::string indent = "  ";
  if (section != lines.end()) {
    if (!IsBlankOrComment(section->substr(section->find(':') + 1))) Refuse();
    after = std::find_if(section + 1, lines.end(), IsTopLevel);
    below.assign(section + 1, after);
    const auto first = std::find_if_not(below.begin(), below.end(), IsBlankOrComment);
    if (first != below.end()) indent = first->substr(0, first->find_first_not_of(' '));
  }
  written.push_back(section == lines.end() ? "camera:" : *section);

  const Lines camera_lines = LinesOf(CameraYaml(camera, indent));
  Lines missing = camera_lines;
  for (std::string& line : below) {
    const std::string key = IsBlankOrComment(line) ? "" : KeyOf(line);
    const auto same = std::find_if(missing.begin(), missing.end(), [&](const std::string& ours) {
      return !key.empty() && KeyOf(ours) == key;
    });
    if (same == missing.end() || line.find_first_not_of(' ') != indent.size()) continue;
    if (!HasValueOnItsLine(line)) Refuse();
    line = *same + CommentOf(line);
    missing.erase(same);
  }
  written.insert(written.end(), missing.begin(), missing.end());
  written.insert(written.end(), below.begin(), below.end());
  written.insert(written.end(), after, lines.end());
  std::string text;
  for (const std::string& line : written) text += line + '\n';
  return text;
}

}  // namespace voqcal
