// decode_lidar: a lidar's capture to point clouds, one file a sweep.

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>

#include <system_error>

#include "common/tool_main.hpp"
#include "decode_lidar/sweep_pcd.hpp"
#include "files/atomic_file.hpp"
#include "lidar_driver/calibrated_stream.hpp"
#include "lidar_driver/pcap_packets.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

struct DecodeArgs {
  fs::path capture;
  std::string model;
  fs::path calibration;
  fs::path out;
  int port = 0;
  ReturnChoice returns = ReturnChoice::kBoth;
  double split_azimuth_deg = 0.0;
};

// The folder's sweeps, which are replaced once there is one to replace them.
class SweepFolder {
 public:
  explicit SweepFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) {
      throw std::runtime_error(folder_.string() + ": cannot make the folder: " + error.message());
    }
  }

  void Write(const TimedSweep& sweep) {
    if (num_sweeps_ == 0) RemoveOld();
    char name[32];
    std::snprintf(name, sizeof(name), "sweep_%04d.pcd", num_sweeps_++);
    WriteFileAtomically(folder_ / name, SweepPcd(sweep));
    num_points_ += static_cast<std::int64_t>(sweep.returns.size());
  }

  int num_sweeps() const { return num_sweeps_; }
  std::int64_t num_points() const { return num_points_; }

 private:
  void RemoveOld() const {
    static const std::regex kName("sweep_[0-9]+\\.pcd");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (std::regex_match(entry.path().filename().string(), kName)) fs::remove(entry.path());
    }
  }

  fs::path folder_;
  int num_sweeps_ = 0;
  std::int64_t num_points_ = 0;
};

const LidarProtocol& ProtocolOf(const std::string& model) {
  const LidarProtocol* const protocol = FindLidarProtocol(model);
  if (protocol) return *protocol;
  throw std::runtime_error("--model must be one of " + LidarProtocolNames() + ", is \"" + model +
                           '"');
}

LidarPacketOptions StreamOptions(const DecodeArgs& args) {
  LidarPacketOptions options;
  options.protocol = &ProtocolOf(args.model);
  options.returns = args.returns;
  options.split_azimuth_rad = args.split_azimuth_deg * M_PI / 180.0;
  return options;
}

void RequirePackets(const DecodeArgs& args, const LidarPacketStream& stream) {
  if (stream.Counts().count("packets") > 0) return;
  const std::string wrong = stream.WrongLidar();
  throw std::runtime_error(
      args.capture.string() + ": " + (wrong.empty() ? "no packet with points" : wrong) +
      (wrong.empty() && args.port != 0 ? " to port " + std::to_string(args.port) + " (0: to any)"
                                       : ""));
}

void PrintCounts(const DecodeArgs& args,
                 const SweepFolder& folder,
                 const std::map<std::string, std::int64_t>& of_stream,
                 const std::map<std::string, std::int64_t>& of_capture) {
  std::printf("%s: %d sweeps, %" PRId64 " points\n",
              args.out.c_str(),
              folder.num_sweeps(),
              folder.num_points());
  for (const auto& counts : {of_stream, of_capture}) {
    for (const auto& [what, count] : counts) std::printf("%9" PRId64 " %s\n", count, what.c_str());
  }
}

void Decode(const DecodeArgs& args) {
  LidarPacketStream stream = CalibratedStream(StreamOptions(args), args.calibration);
  const auto packets = MakePcapPackets(args.capture, args.port);
  SweepFolder folder(args.out);
  while (!packets->HasEnded()) {
    const auto packet = packets->Next();
    if (!packet) continue;
    const PacketBytes bytes{packet->bytes.data(), packet->bytes.size()};
    for (const TimedSweep& sweep : stream.Add(bytes, packet->utime)) folder.Write(sweep);
  }
  for (const TimedSweep& sweep : stream.Finish()) folder.Write(sweep);
  RequirePackets(args, stream);
  PrintCounts(args, folder, stream.Counts(), packets->Counts());
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  using voqcal::ReturnChoice;
  CLI::App app(
      "Decodes a lidar's capture to point clouds (PCD: x y z intensity ring time "
      "return_number), one file a sweep.",
      "decode_lidar");
  voqcal::DecodeArgs args;
  const std::map<std::string, ReturnChoice> choices = {{"both", ReturnChoice::kBoth},
                                                       {"strongest", ReturnChoice::kStrongest},
                                                       {"last", ReturnChoice::kLast}};
  app.add_option("capture", args.capture, "The capture (pcap, pcapng)")->required();
  app.add_option("--model", args.model, "The lidar: " + voqcal::LidarProtocolNames())->required();
  app.add_option("--calibration", args.calibration, "The vendor's file on this very unit");
  app.add_option(
         "--out", args.out, "The folder for sweep_0000.pcd, ...; those that are there are replaced")
      ->required();
  app.add_option("--port", args.port, "Only packets to this port; 0: to any")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  app.add_option_function<std::string>(
         "--returns",
         [&](const std::string& name) { args.returns = choices.at(name); },
         "Of a beam's echoes; both, unless told: all of them")
      ->check(CLI::IsMember({"both", "strongest", "last"}));
  app.add_option("--split-azimuth",
                 args.split_azimuth_deg,
                 "Degrees, clockwise from the lidar's zero, at which sweeps end")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 359.999));
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Decode(args); });
}
