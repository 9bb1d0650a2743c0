#include "calibrate_lens/rig_with_camera.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/add_if_new.hpp"
#include "files/atomic_file.hpp"
#include "files/yaml_reader.hpp"
#include "result/camera_yaml.hpp"
#include "rig/rig.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

using Lines = std::vector<std::string>;

/// The lines below a section's key, and how its own keys are indented.
struct Block {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string indent;
  std::string path;  ///< "cameras.left."; empty: the whole file.
};

[[noreturn]] void Refuse(const std::string& section) {
  throw std::runtime_error(
      "the rig file's section " + section +
      " is not written line by line (key: value, indented): put the lines above in its place "
      "yourself");
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

// Of a file whose lines end as those of Windows do.
std::string EndOf(const std::string& line) {
  return !line.empty() && line.back() == '\r' ? "\r" : "";
}

// What follows a key on its line, without its comment.
bool HasValueOnItsLine(const std::string& line) {
  const std::string value = line.substr(0, line.size() - CommentOf(line).size());
  const std::string rest = value.substr(value.find(':') + 1);
  return !IsBlankOrComment(rest) &&
         (rest.find('[') == std::string::npos) == (rest.find(']') == std::string::npos);
}

std::size_t IndentOf(const std::string& line) { return line.find_first_not_of(' '); }

/// The line of a key of the block's own; `end` if it has none.
std::size_t LineOf(const std::string& key, const Lines& lines, const Block& block) {
  for (std::size_t i = block.begin; i < block.end; ++i) {
    if (IsBlankOrComment(lines[i]) || IndentOf(lines[i]) != block.indent.size()) continue;
    if (KeyOf(lines[i]) == key) return i;
  }
  return block.end;
}

/// The section of a key on `line` within the block `outer`.
Block Below(std::size_t line, const Lines& lines, const Block& outer) {
  Block block = {line + 1, line + 1, outer.indent + "  ", outer.path + KeyOf(lines[line]) + "."};
  if (!IsBlankOrComment(lines[line].substr(lines[line].find(':') + 1))) {
    Refuse(outer.path + KeyOf(lines[line]));
  }
  bool is_empty = true;
  for (; block.end < outer.end; ++block.end) {
    const std::string& each = lines[block.end];
    if (IsBlankOrComment(each)) continue;
    if (IndentOf(each) <= outer.indent.size()) break;
    if (is_empty) block.indent = each.substr(0, IndentOf(each));
    is_empty = false;
  }
  return block;
}

Block SectionOf(const std::string& key, const Lines& lines, const Block& outer) {
  const std::size_t line = LineOf(key, lines, outer);
  if (line == outer.end) Refuse(outer.path + key);
  return Below(line, lines, outer);
}

/// Puts the camera's values where those of their keys stand, and what is missing before all.
void PutValues(const CameraModel& camera, const Block& block, Lines* lines) {
  Lines missing = LinesOf(CameraYaml(camera, block.indent));
  for (std::size_t i = block.begin; i < block.end; ++i) {
    std::string& line = lines->at(i);
    if (IsBlankOrComment(line) || IndentOf(line) != block.indent.size()) continue;
    const auto same = std::find_if(missing.begin(), missing.end(), [&](const std::string& ours) {
      return KeyOf(ours) == KeyOf(line);
    });
    if (same == missing.end()) continue;
    if (!HasValueOnItsLine(line)) Refuse(block.path + KeyOf(line));
    const std::string comment = CommentOf(line);
    line = *same + (comment.empty() ? EndOf(line) : comment);
    missing.erase(same);
  }
  for (std::string& line : missing) line += EndOf(lines->at(block.begin - 1));
  lines->insert(
      lines->begin() + static_cast<std::ptrdiff_t>(block.begin), missing.begin(), missing.end());
}

/// All that a rig file names relative to itself.
std::vector<std::pair<std::string, std::filesystem::path>> PathsOf(const Rig& rig) {
  const bool is_stream = rig.camera_driver.url.find("://") != std::string::npos;
  const bool are_by_name = !PlaceOfRig(rig.path).names.empty();
  const std::string lidar = are_by_name ? "lidars." + rig.lidar_name + "." : "";
  const std::string camera = are_by_name ? "cameras." + rig.camera_name + "." : "";
  return {{"lcm.types", rig.lcm_types},
          {lidar + "lidar_driver.folder", rig.lidar_driver.folder},
          {lidar + "lidar_driver.sensor.pcap", rig.lidar_sensor.pcap},
          {lidar + "lidar_driver.sensor.calibration", rig.lidar_sensor.calibration},
          {lidar + "lidar_driver.sensor.bias_from", rig.lidar_sensor.bias_from},
          {camera + "camera_driver.folder", rig.camera_driver.folder},
          {camera + "camera_driver.url", is_stream ? "" : rig.camera_driver.url},
          {"extrinsic_monitor.extrinsic", rig.extrinsic_monitor.extrinsic}};
}

/// What the text of a pair's rig file names if the file lies at `file`.
std::vector<std::pair<std::string, std::filesystem::path>> PathsAt(
    const std::filesystem::path& file, const std::filesystem::path& pair, const std::string& text) {
  YamlDocument document(file.string(), text);
  Rig rig;
  rig.path = pair;
  LensInRig may_lack;
  ReadRigSections(
      {file, PlaceOfRig(pair).names}, &document, &rig, &may_lack, SensorChoice::kCamera);
  return PathsOf(rig);
}

}  // namespace

void RequireSamePaths(const std::filesystem::path& rig_file,
                      const std::filesystem::path& copy_path) {
  const std::string text = ReadWholeFile(rig_file);
  const auto whole = [](const std::filesystem::path& path) {
    return path.empty() ? path : std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  std::vector<std::string> moved;
  for (const std::filesystem::path& pair : PairsOfRig(rig_file)) {
    const auto before = PathsAt(rig_file, pair, text);
    const auto after = PathsAt(copy_path, pair, text);
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (whole(before[i].second) != whole(after[i].second)) AddIfNew(before[i].first, &moved);
    }
  }
  if (moved.empty()) return;
  std::string names;
  for (const std::string& key : moved) names += (names.empty() ? "" : ", ") + key;
  throw std::runtime_error(copy_path.string() + ": " + names +
                           " of the rig file would be another path there: write the copy beside "
                           "the rig file, or make it absolute");
}

std::string RigWithCamera(const std::string& rig_text,
                          const CameraModel& camera,
                          const std::string& name) {
  Lines lines = LinesOf(rig_text);
  Block outer = {0, lines.size(), "", ""};
  if (!name.empty()) outer = SectionOf(name, lines, SectionOf("cameras", lines, outer));
  std::size_t line = LineOf("camera", lines, outer);
  if (line == outer.end) {
    if (!name.empty()) line = outer.begin;
    const std::string end = lines.empty() ? "" : EndOf(lines.front());
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(line), outer.indent + "camera:" + end);
    ++outer.end;
  }
  PutValues(camera, Below(line, lines, outer), &lines);
  std::string text;
  for (const std::string& each : lines) text += each + '\n';
  const bool has_last_end = rig_text.empty() || rig_text.back() == '\n';
  return has_last_end ? text : text.substr(0, text.size() - 1);
}

}  // namespace voqcal
