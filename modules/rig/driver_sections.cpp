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
                      OptionSection* section,
                      FrameOptions* options) {
  ReadPath("folder",
           rig_path,
           section,
           &options->folder,
           "for source folder: its files, in natural order");
  section->Read("file_ending",
                &options->file_ending,
                "for source folder: only names that end so, \"_full.pcd\"");
  section->Read("rate_hz", &options->rate_hz, "frames a second of a folder or the simulator");
  section->Read("is_repeating",
                &options->is_repeating,
                "for source folder: starts again after the last file");
  section->ReadOneOf<bool>("frames_by",
                           {{"names", false}, {"order", true}},
                           &options->is_by_order,
                           "for source folder: what tells which cloud and image belong together, "
                           "the numbers or times in their names, or their places in both folders");
}

/// A lidar's source is one of its own, or a lidar by its protocol's name.
void ReadLidarSource(OptionSection* section,
                     LidarDriverOptions* options,
                     LidarSensorOptions* sensor) {
  using Source = LidarDriverOptions::Source;
  const std::map<std::string, Source> sources = {{"folder", Source::kFolder},
                                                 {"simulator", Source::kSimulator}};
  std::string text = "folder";
  section->Read("source",
                &text,
                "folder (of .pcd or .ply files), simulator, or a lidar: " + LidarProtocolNames());
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

void ReadCameraSource(OptionSection* section, CameraDriverOptions* options) {
  using Source = CameraDriverOptions::Source;
  section->ReadOneOf<Source>("source",
                             {{"folder", Source::kFolder},
                              {"simulator", Source::kSimulator},
                              {"video", Source::kVideo},
                              {"genicam", Source::kGenicam}},
                             &options->source,
                             "a folder (of .png or .jpg files) or another source");
}

void ReadSensor(OptionSection* lidar_driver,
                const std::filesystem::path& rig_path,
                LidarSensorOptions* options) {
  OptionSection section = lidar_driver->Section("sensor", "for a lidar that `source` names");
  ReadPath("pcap",
           rig_path,
           &section,
           &options->pcap,
           "a capture (pcap, pcapng) instead of the network");
  section.Read("is_unpaced",
               &options->is_unpaced,
               "a capture is read as fast as it can be, not as it was recorded");
  section.Read(
      "address",
      &options->address,
      "packets are awaited on this IPv4 address of this host; 0.0.0.0 is every network card. "
      "Nothing from beyond this host arrives unless this line says so");
  section.Read("port", &options->port, "0 to 65535; 0: the sensor's usual one");
  ReadPath(
      "calibration",
      rig_path,
      &section,
      &options->calibration,
      "the vendor's file on this very unit (modules/lidar_driver/README.md: which lidars need it)");
  section.ReadOneOf<ReturnChoice>("returns",
                                  {{"strongest", ReturnChoice::kStrongest},
                                   {"last", ReturnChoice::kLast},
                                   {"both", ReturnChoice::kBoth}},
                                  &options->packets.returns,
                                  "which of a beam's echoes (both: all)");
  section.ReadDegrees(
      "split_azimuth_deg",
      &options->packets.split_azimuth_rad,
      "where a spinning lidar's sweeps end, clockwise from its zero; 0 to below 360");
  std::vector<double> elevations_deg;
  section.Read("elevations_deg",
               &elevations_deg,
               "of this very unit's rings, lowest first; none: its calibration's");
  for (const double elevation_deg : elevations_deg) {
    options->packets.unit.elevations_rad.push_back(elevation_deg * M_PI / 180.0);
  }
  section.Read("distance_offset_m",
               &options->packets.unit.distance_offset_m,
               "by which every range reads long");
  section.Read("ring_offsets_m",
               &options->packets.unit.ring_offsets_m,
               "by which each ring reads long besides, lowest first; none: all 0");
  ReadPath("bias_from",
           rig_path,
           &section,
           &options->bias_from,
           "an extrinsic.yaml: its lidar_bias is taken off all ranges");
  section.Read("are_packets_published",
               &options->are_packets_published,
               "as raw_t on lidar_packets, so that a recording has them");
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace

void ReadLidarDriver(OptionSection* top,
                     const std::filesystem::path& rig_path,
                     LidarDriverOptions* options,
                     LidarSensorOptions* sensor) {
  OptionSection section = top->Section("lidar_driver", "where sweeps come from");
  ReadLidarSource(&section, options, sensor);
  ReadFrameOptions(rig_path, &section, options);
  ReadSensor(&section, rig_path, sensor);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

void ReadCameraDriver(OptionSection* top,
                      const std::filesystem::path& rig_path,
                      CameraDriverOptions* options) {
  OptionSection section = top->Section("camera_driver", "where images come from");
  ReadCameraSource(&section, options);
  ReadFrameOptions(rig_path, &section, options);
  section.Read("jpeg_quality", &options->jpeg_quality, "for images that are no JPEG yet: 1 to 100");
  section.Read("device", &options->device, "for source video, one of three: V4L2, \"/dev/video0\"");
  section.Read(
      "pipeline", &options->pipeline, "...GStreamer, \"rtspsrc location=... ! ... ! appsink\"");
  section.Read("url", &options->url, "...or a stream, \"rtsp://...\", or a video file");
  section.Read("camera_id",
               &options->camera_id,
               "for source genicam: its id, address or serial number; \"\": the only one");
  section.Read("retry_s",
               &options->retry_s,
               "for sources video and genicam: a lost camera is sought so often");
  const bool is_file = options->url.find("://") == std::string::npos;
  if (is_file) options->url = Beside(rig_path, options->url).string();
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
