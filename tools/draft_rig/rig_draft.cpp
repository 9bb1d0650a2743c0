#include "draft_rig/rig_draft.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "core/camera_detection/calibration_target.hpp"
#include "files/number_text.hpp"
#include "files/yaml_reader.hpp"
#include "rig/default_rig.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

// To a thousandth of a pixel, or a millionth without unit: more digits would claim too much.
std::string PixelText(double pixels) { return NumberText(std::round(pixels * 1e3) / 1e3); }
std::string CoefficientText(double value) { return NumberText(std::round(value * 1e6) / 1e6); }

std::string DistortionText(const CameraModel& camera) {
  std::string text = "[";
  for (int i = 0; i < NumDistortion(camera.lens); ++i) {
    text += (i == 0 ? "" : ", ") + CoefficientText(camera.distortion[static_cast<std::size_t>(i)]);
  }
  return text + "]";
}

}  // namespace

void RigDraft::Add(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::size_t dot = assignment.find('.');
  const bool is_whole = equals != std::string::npos && dot < equals && dot > 0 &&
                        dot + 1 < equals && equals + 1 < assignment.size();
  if (!is_whole || assignment.find('\n') != std::string::npos) {
    throw std::invalid_argument("\"" + assignment +
                                "\" is not SECTION.KEY=VALUE of a rig file (board.width_m=0.61)");
  }
  sections_[assignment.substr(0, dot)].keys.emplace_back(
      assignment.substr(dot + 1, equals - dot - 1), assignment.substr(equals + 1));
}

void RigDraft::Add(const CameraModel& camera, const std::string& from) {
  sections_["camera"].comment = from;
  AddDefault("camera", "lens_model", ToString(camera.lens));
  AddDefault("camera", "width_px", std::to_string(camera.width_px));
  AddDefault("camera", "height_px", std::to_string(camera.height_px));
  AddDefault("camera", "fx_px", PixelText(camera.fx_px));
  AddDefault("camera", "fy_px", PixelText(camera.fy_px));
  AddDefault("camera", "cx_px", PixelText(camera.cx_px));
  AddDefault("camera", "cy_px", PixelText(camera.cy_px));
  AddDefault("camera", "distortion", DistortionText(camera));
}

void RigDraft::AddDefault(const std::string& section,
                          const std::string& key,
                          const std::string& value) {
  if (!Has(section, key)) sections_[section].keys.emplace_back(key, value);
}

bool RigDraft::Has(const std::string& section, const std::string& key) const {
  const auto found = sections_.find(section);
  if (found == sections_.end()) return false;
  const auto& keys = found->second.keys;
  return std::any_of(keys.begin(), keys.end(), [&](const auto& pair) { return pair.first == key; });
}

std::string RigDraft::MissingOfBoard() const {
  std::string pattern = BoardSpec{}.pattern;
  if (const auto board = sections_.find("board"); board != sections_.end()) {
    for (const auto& [key, value] : board->second.keys) {
      if (key == "pattern") pattern = value;
    }
  }
  const CalibrationTarget* target = FindCalibrationTarget(pattern);
  std::vector<std::string> needed = {"width_m", "height_m"};
  for (const TargetKey& key : target ? target->keys : std::vector<TargetKey>{}) {
    if (key.is_required) needed.emplace_back(key.name);
  }
  std::string lines;
  const std::string board = "board.";
  for (const YamlDocument::KnownKey& key : DefaultRigKeys()) {
    const std::string name = key.path.substr(key.path.find('.') + 1);
    const bool is_missing = key.path == board + name && !Has("board", name) &&
                            std::count(needed.begin(), needed.end(), name) != 0;
    if (!is_missing) continue;
    std::string example = key.path + "=" + key.value;
    example.resize(std::max<std::size_t>(example.size(), 24), ' ');
    lines += "\n  " + example + "  " + key.meaning;
  }
  return lines;
}

std::string RigDraft::Text() const {
  std::ostringstream text;
  text << "# Drafted by draft_rig; check_rig --print-defaults explains every key.\n"
       << "rig: " << std::quoted(name_) << '\n';
  for (const auto& [name, section] : sections_) {
    text << '\n' << name << ":";
    if (!section.comment.empty()) text << "  # " << section.comment;
    text << '\n';
    for (const auto& [key, value] : section.keys) text << "  " << key << ": " << value << '\n';
  }
  return text.str();
}

Rig RigDraft::Read() const {
  YamlDocument document("the drafted rig file", Text());
  Rig rig;
  ReadRigSections({"the drafted rig file", {}}, &document, &rig);
  document.ThrowIfWrong();
  return rig;
}

}  // namespace voqcal
