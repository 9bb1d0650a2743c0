#include "rig/driver_sections.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace voqcal {
namespace {

using Sources = std::map<std::string, DriverSource>;

std::filesystem::path Beside(const std::filesystem::path& rig_path, const std::string& path) {
  if (path.empty()) return {};
  return (rig_path.parent_path() / path).lexically_normal();
}

void ReadPath(const std::string& key,
              const std::filesystem::path& rig_path,
              YamlSection* section,
              std::filesystem::path* path) {
  std::string text;
  section->Read(key, &text);
  *path = Beside(rig_path, text);
}

/// What both drivers have in common.
/// @param rule  names the sources, as an error says it.
void ReadFrameSource(const std::filesystem::path& rig_path,
                     const Sources& sources,
                     const std::string& rule,
                     YamlSection* section,
                     DriverOptions* options) {
  std::string source = "folder";
  section->Read("source", &source);
  const auto known = sources.find(source);
  if (known == sources.end()) {
    section->AddError("source", rule);
  } else {
    options->source = known->second;
  }
  ReadPath("folder", rig_path, section, &options->folder);
  section->Read("file_ending", &options->file_ending);
  section->Read("rate_hz", &options->rate_hz);
  section->Read("is_repeating", &options->is_repeating);
}

void ReadReturns(YamlSection* section, ReturnChoice* returns) {
  const std::map<std::string, ReturnChoice> choices = {{"both", ReturnChoice::kBoth},
                                                       {"strongest", ReturnChoice::kStrongest},
                                                       {"last", ReturnChoice::kLast}};
  std::string text = "strongest";
  section->Read("returns", &text);
  const auto known = choices.find(text);
  if (known == choices.end()) {
    return section->AddError("returns", "must be strongest, last or both");
  }
  *returns = known->second;
}

void ReadSensor(YamlSection* lidar_driver,
                const std::filesystem::path& rig_path,
                LidarSensorOptions* options) {
  YamlSection section = lidar_driver->Section("sensor");
  ReadPath("pcap", rig_path, &section, &options->pcap);
  section.Read("is_unpaced", &options->is_unpaced);
  section.Read("address", &options->address);
  section.Read("port", &options->port);
  ReadReturns(&section, &options->packets.returns);
  section.ReadDegrees("split_azimuth_deg", &options->packets.split_azimuth_rad);
  std::vector<double> elevations_deg;
  section.Read("elevations_deg", &elevations_deg);
  for (const double elevation_deg : elevations_deg) {
    options->packets.vlp16.elevations_rad.push_back(elevation_deg * M_PI / 180.0);
  }
  section.Read("distance_offset_m", &options->packets.vlp16.distance_offset_m);
  section.Read("ring_offsets_m", &options->packets.vlp16.ring_offsets_m);
  ReadPath("bias_from", rig_path, &section, &options->bias_from);
  section.Read("are_packets_published", &options->are_packets_published);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace

void ReadLidarDriver(YamlSection* top,
                     const std::filesystem::path& rig_path,
                     DriverOptions* options,
                     LidarSensorOptions* sensor) {
  const Sources sources = {{"folder", DriverSource::kFolder},
                           {"simulator", DriverSource::kSimulator},
                           {"vlp16", DriverSource::kVlp16},
                           {"spectrum_scan", DriverSource::kSpectrumScan}};
  YamlSection section = top->Section("lidar_driver");
  ReadFrameSource(
      rig_path, sources, "must be folder, simulator, vlp16 or spectrum_scan", &section, options);
  sensor->packets.model = options->source == DriverSource::kSpectrumScan ? LidarModel::kSpectrumScan
                                                                         : LidarModel::kVlp16;
  ReadSensor(&section, rig_path, sensor);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

void ReadCameraDriver(YamlSection* top,
                      const std::filesystem::path& rig_path,
                      DriverOptions* options) {
  const Sources sources = {{"folder", DriverSource::kFolder},
                           {"simulator", DriverSource::kSimulator},
                           {"video", DriverSource::kVideo}};
  YamlSection section = top->Section("camera_driver");
  ReadFrameSource(rig_path, sources, "must be folder, simulator or video", &section, options);
  section.Read("jpeg_quality", &options->jpeg_quality);
  section.Read("device", &options->device);
  section.Read("pipeline", &options->pipeline);
  section.Read("url", &options->url);
  section.Read("retry_s", &options->retry_s);
  const bool is_file = options->url.find("://") == std::string::npos;
  if (is_file) options->url = Beside(rig_path, options->url).string();
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
