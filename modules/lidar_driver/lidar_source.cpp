#include "lidar_driver/lidar_source.hpp"

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/simulation/simulation.hpp"
#include "rig/frame_folder.hpp"
#include "rig/point_cloud_file.hpp"

namespace voqcal {
namespace {

class FolderLidarSource : public LidarSource {
 public:
  explicit FolderLidarSource(const DriverOptions& options) : folder_(options, {".pcd", ".ply"}) {}

  std::optional<TimedCloud> Next() override {
    const auto file = folder_.Next();
    if (!file) return {};
    return TimedCloud{file->utime, ReadPointCloud(file->path)};
  }

 private:
  FrameFolder folder_;
};

class SimulatedLidarSource : public LidarSource {
 public:
  explicit SimulatedLidarSource(const Rig& rig)
      : simulation_(rig.simulation, rig.board, rig.camera), rate_hz_(rig.lidar_driver.rate_hz) {}

  std::optional<TimedCloud> Next() override {
    const double time_s = static_cast<double>(num_sweeps_) / rate_hz_;
    if (time_s > simulation_.DurationS()) return {};
    ++num_sweeps_;
    return TimedCloud{kSyntheticEpochUtime + std::llround(time_s * 1e6), simulation_.Sweep(time_s)};
  }

 private:
  Simulation simulation_;
  double rate_hz_;
  std::int64_t num_sweeps_ = 0;
};

}  // namespace

std::unique_ptr<LidarSource> MakeLidarSource(const Rig& rig) {
  switch (rig.lidar_driver.source) {
    case DriverSource::kFolder:
      RequireFolder(rig.lidar_driver, rig.path.string() + ": lidar_driver");
      return std::make_unique<FolderLidarSource>(rig.lidar_driver);
    case DriverSource::kSimulator:
      return std::make_unique<SimulatedLidarSource>(rig);
    case DriverSource::kVideo:  // the rig's reader lets only a camera have it
      break;
  }
  throw std::logic_error("MakeLidarSource: unknown source");
}

}  // namespace voqcal
