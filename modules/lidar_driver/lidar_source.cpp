#include "lidar_driver/lidar_source.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/simulation/rig_simulation.hpp"
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

/// @tparam World  Simulation, or one like it.
template <typename World>
class SimulatedLidarSource : public LidarSource {
 public:
  SimulatedLidarSource(std::unique_ptr<World> world, double rate_hz)
      : world_(std::move(world)), rate_hz_(rate_hz) {}

  std::optional<TimedCloud> Next() override {
    const double time_s = static_cast<double>(num_sweeps_) / rate_hz_;
    has_ended_ = time_s > world_->DurationS();
    if (has_ended_) return {};
    ++num_sweeps_;
    return TimedCloud{kSyntheticEpochUtime + std::llround(time_s * 1e6), world_->Sweep(time_s)};
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  std::unique_ptr<World> world_;
  double rate_hz_;
  std::int64_t num_sweeps_ = 0;
  bool has_ended_ = false;
};

/// What one lidar of a rig sees of the world of all.
class WorldOfRig {
 public:
  explicit WorldOfRig(const Rig& rig)
      : simulation_(rig.simulated_rig, rig.board),
        lidar_(IndexOfName(rig.simulated_rig.lidars, rig.lidar_name)) {}

  double DurationS() const { return simulation_.DurationS(); }
  PointCloud Sweep(double time_s) const { return simulation_.Sweep(lidar_, time_s); }

 private:
  RigSimulation simulation_;
  std::size_t lidar_;
};

std::unique_ptr<LidarSource> MakeSimulatedSource(const Rig& rig, Bus* bus) {
  const double rate_hz = rig.lidar_driver.rate_hz;
  if (!rig.simulated_rig.lidars.empty()) {
    return std::make_unique<SimulatedLidarSource<WorldOfRig>>(std::make_unique<WorldOfRig>(rig),
                                                              rate_hz);
  }
  if (rig.simulation.follows_guidance) return std::make_unique<GuidedLidarSource>(rig, bus);
  return std::make_unique<SimulatedLidarSource<Simulation>>(
      std::make_unique<Simulation>(rig.simulation, rig.board, rig.camera), rate_hz);
}

}  // namespace

std::unique_ptr<LidarSource> MakeLidarSource(const Rig& rig, PacketListener on_packet, Bus* bus) {
  switch (rig.lidar_driver.source) {
    case LidarDriverOptions::Source::kFolder:
      RequireFolder(rig.lidar_driver, rig.path.string() + ": lidar_driver");
      AnnouncePairing(rig);
      return std::make_unique<FolderLidarSource>(rig.lidar_driver);
    case LidarDriverOptions::Source::kSimulator:
      return MakeSimulatedSource(rig, bus);
    case LidarDriverOptions::Source::kSensor:
      return std::make_unique<PacketLidarSource>(rig.lidar_sensor, std::move(on_packet));
  }
  throw std::logic_error("MakeLidarSource: unknown source");
}

}  // namespace voqcal
