#include "result/lidar_bias_yaml.hpp"

#include <functional>
#include <vector>

#include "files/atomic_file.hpp"
#include "files/number_text.hpp"
#include "files/yaml_reader.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

std::string StatusOf(const BiasEstimate& estimate) {
  return estimate.is_observable ? "estimated" : "unobservable";
}

std::string Fault(const std::string& key, const BiasEstimate& estimate, const std::string& note) {
  return "  " + key + ": {value: " + NumberText(estimate.value_m) +
         ", standard_error: " + NumberText(estimate.standard_error_m) +
         ", status: " + StatusOf(estimate) + "}  # " + note + "\n";
}

std::string RingList(const std::vector<BiasEstimate>& rings,
                     const std::function<std::string(const BiasEstimate&)>& text) {
  std::string list;
  for (const BiasEstimate& ring : rings) list += (list.empty() ? "" : ", ") + text(ring);
  return "[" + list + "]\n";
}

BiasEstimate ReadFault(YamlSection* bias, const std::string& key) {
  YamlSection section = bias->Section(key);
  BiasEstimate estimate;
  std::string status;
  section.Read("value", &estimate.value_m);
  section.Read("status", &status);
  estimate.is_observable = status == "estimated";
  return estimate;
}

std::vector<BiasEstimate> ReadRings(YamlSection* bias) {
  YamlSection section = bias->Section("ring_m");
  std::vector<double> values_m;
  section.Read("value", &values_m);
  std::vector<BiasEstimate> rings;
  for (const double value_m : values_m) {
    rings.push_back({value_m, std::numeric_limits<double>::quiet_NaN(), value_m != 0.0});
  }
  return rings;
}

}  // namespace

std::string LidarBiasYaml(const LidarBias& bias) {
  if (!bias.IsObservable()) return "lidar_bias: {status: not estimated}\n";
  return "lidar_bias:  # measured range = true range + these, metres\n"
         "  status: estimated\n" +
         Fault("common_m", bias.common, "of every range") +
         Fault("dark_step_m", bias.dark_step, "how much longer dark surfaces read than bright") +
         "  ring_m:  # of each scan line, by its number\n    value: " +
         RingList(bias.rings, [](const BiasEstimate& r) { return NumberText(r.value_m); }) +
         "    standard_error: " +
         RingList(bias.rings,
                  [](const BiasEstimate& r) { return NumberText(r.standard_error_m); }) +
         "    status: " + RingList(bias.rings, StatusOf) +
         Fault("outline_lift_m", bias.outline_lift, "how much higher outlines look than they are") +
         Fault("outline_rise", bias.outline_rise, "the same for each metre of range, m") +
         "  dark_intensity: " + NumberText(bias.shades.dark_intensity) +
         "  # up to here a return is dark, from the next on bright\n" +
         "  bright_intensity: " + NumberText(bias.shades.bright_intensity) + "\n";
}

LidarBias ReadLidarBias(const std::filesystem::path& path) {
  const std::filesystem::path file = ResultFileAt(path);
  YamlDocument document(file.string(), ReadWholeFile(file));
  YamlSection top(&document);
  YamlSection section = top.Section("lidar_bias");
  LidarBias bias;
  bias.common = ReadFault(&section, "common_m");
  bias.dark_step = ReadFault(&section, "dark_step_m");
  bias.rings = ReadRings(&section);
  bias.outline_lift = ReadFault(&section, "outline_lift_m");
  bias.outline_rise = ReadFault(&section, "outline_rise");
  section.Read("dark_intensity", &bias.shades.dark_intensity);
  section.Read("bright_intensity", &bias.shades.bright_intensity);
  document.ThrowIfWrong();
  return bias;
}

Eigen::Vector2d ReadChessboardTurn(const std::filesystem::path& path) {
  const std::filesystem::path file = ResultFileAt(path);
  YamlDocument document(file.string(), ReadWholeFile(file));
  YamlSection top(&document);
  std::vector<double> turn_rad = {0, 0};
  top.Read("chessboard_turn_rad", &turn_rad);
  if (turn_rad.size() != 2) top.AddError("chessboard_turn_rad", "must have two numbers");
  document.ThrowIfWrong();
  return {turn_rad[0], turn_rad[1]};
}

}  // namespace voqcal
