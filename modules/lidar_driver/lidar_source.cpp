#include "lidar_driver/lidar_source.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/simulation/simulation.hpp"
#include "files/point_cloud_file.hpp"
#include "lidar_driver/guided_lidar_source.hpp"
#include "lidar_driver/packet_lidar_source.hpp"
#include "rig/frame_folder.hpp"
#include "rig/frame_pairing.hpp"

namespace voqcal {
namespace {

class FolderLidarSource : public LidarSource {
 public:
  explicit FolderLidarSource(const FrameOptions& options) : folder_(options, kCloudEndings) {}

  std::optional<TimedCloud> Next() override {
    auto cloud = folder_.NextReadable([](const FrameFile& file) {
      return TimedCloud{file.utime, ReadPointCloud(file.path)};
    });
    has_ended_ = !cloud;
    return cloud;
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  FrameFolder folder_;
  bool has_ended_ = false;
};

class SimulatedLidarSource : public LidarSource {
 public:
  explicit SimulatedLidarSource(const Rig& rig)
      : simulation_(rig.simulation, rig.board, rig.camera), rate_hz_(rig.lidar_driver.rate_hz) {}

  std::optional<TimedCloud> Next() override {
    const double time_s = static_cast<double>(num_sweeps_) / rate_hz_;
    has_ended_ = time_s > simulation_.DurationS();
    if (has_ended_) return {};
    ++num_sweeps_;
    return TimedCloud{kSyntheticEpochUtime + std::llround(time_s * 1e6), simulation_.Sweep(time_s)};
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  Simulation simulation_;
  double rate_hz_;
  std::int64_t num_sweeps_ = 0;
  bool has_ended_ = false;
};

}  // namespace

std::unique_ptr<LidarSource> MakeLidarSource(const Rig& rig, PacketListener on_packet, Bus* bus) {
  switch (rig.lidar_driver.source) {
    case LidarDriverOptions::Source::kFolder:
      RequireFolder(rig.lidar_driver, rig.path.string() + ": lidar_driver");
      AnnouncePairing(rig);
      return std::make_unique<FolderLidarSource>(rig.lidar_driver);
    case LidarDriverOptions::Source::kSimulator:
      if (rig.simulation.follows_guidance) return std::make_unique<GuidedLidarSource>(rig, bus);
      return std::make_unique<SimulatedLidarSource>(rig);
    case LidarDriverOptions::Source::kSensor:
      return std::make_unique<PacketLidarSource>(rig.lidar_sensor, std::move(on_packet));
  }
  throw std::logic_error("MakeLidarSource: unknown source");
}

}  // namespace voqcal
