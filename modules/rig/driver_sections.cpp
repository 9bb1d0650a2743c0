#include "rig/driver_sections.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "rig/section_reading.hpp"

namespace voqcal {
namespace {

/// What both drivers have in common.
void ReadFrameOptions(const std::filesystem::path& rig_path,
                      YamlSection* section,
                      FrameOptions* options) {
  ReadPath("folder", rig_path, section, &options->folder);
  section->Read("file_ending", &options->file_ending);
  section->Read("rate_hz", &options->rate_hz);
  section->Read("is_repeating", &options->is_repeating);
  std::string frames_by = "names";
  section->Read("frames_by", &frames_by);
  if (frames_by != "names" && frames_by != "order") {
    section->AddError("frames_by", "must be names or order");
  }
  options->is_by_order = frames_by == "order";
}

/// A lidar's source is one of its own, or a lidar by its protocol's name.
void ReadLidarSource(YamlSection* section,
                     LidarDriverOptions* options,
                     LidarSensorOptions* sensor) {
  using Source = LidarDriverOptions::Source;
  const std::map<std::string, Source> sources = {{"folder", Source::kFolder},
                                                 {"simulator", Source::kSimulator}};
  std::string text = "folder";
  section->Read("source", &text);
  const auto known = sources.find(text);
  const LidarProtocol* const protocol = FindLidarProtocol(text);
  if (known != sources.end()) {
    options->source = known->second;
  } else if (protocol) {
    options->source = Source::kSensor;
    sensor->packets.protocol = protocol;
  } else {
    section->AddError("source", "must be folder, simulator or a lidar: " + LidarProtocolNames());
  }
}

void ReadCameraSource(YamlSection* section, CameraDriverOptions* options) {
  using Source = CameraDriverOptions::Source;
  const std::map<std::string, Source> sources = {{"folder", Source::kFolder},
                                                 {"simulator", Source::kSimulator},
                                                 {"video", Source::kVideo},
                                                 {"genicam", Source::kGenicam}};
  std::string text = "folder";
  section->Read("source", &text);
  const auto known = sources.find(text);
  if (known != sources.end()) {
    options->source = known->second;
  } else {
    section->AddError("source", "must be folder, simulator, video or genicam");
  }
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
  ReadPath("calibration", rig_path, &section, &options->calibration);
  ReadReturns(&section, &options->packets.returns);
  section.ReadDegrees("split_azimuth_deg", &options->packets.split_azimuth_rad);
  std::vector<double> elevations_deg;
  section.Read("elevations_deg", &elevations_deg);
  for (const double elevation_deg : elevations_deg) {
    options->packets.unit.elevations_rad.push_back(elevation_deg * M_PI / 180.0);
  }
  section.Read("distance_offset_m", &options->packets.unit.distance_offset_m);
  section.Read("ring_offsets_m", &options->packets.unit.ring_offsets_m);
  ReadPath("bias_from", rig_path, &section, &options->bias_from);
  section.Read("are_packets_published", &options->are_packets_published);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace

void ReadLidarDriver(YamlSection* top,
                     const std::filesystem::path& rig_path,
                     LidarDriverOptions* options,
                     LidarSensorOptions* sensor) {
  YamlSection section = top->Section("lidar_driver");
  ReadLidarSource(&section, options, sensor);
  ReadFrameOptions(rig_path, &section, options);
  ReadSensor(&section, rig_path, sensor);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

void ReadCameraDriver(YamlSection* top,
                      const std::filesystem::path& rig_path,
                      CameraDriverOptions* options) {
  YamlSection section = top->Section("camera_driver");
  ReadCameraSource(&section, options);
  ReadFrameOptions(rig_path, &section, options);
  section.Read("jpeg_quality", &options->jpeg_quality);
  section.Read("device", &options->device);
  section.Read("pipeline", &options->pipeline);
  section.Read("url", &options->url);
  section.Read("camera_id", &options->camera_id);
  section.Read("retry_s", &options->retry_s);
  const bool is_file = options->url.find("://") == std::string::npos;
  if (is_file) options->url = Beside(rig_path, options->url).string();
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
