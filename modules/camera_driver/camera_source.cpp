#include "camera_driver/camera_source.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "camera_driver/genicam_source.hpp"
#include "camera_driver/guided_camera_source.hpp"
#include "camera_driver/video_source.hpp"
#include "core/simulation/rig_simulation.hpp"
#include "core/simulation/simulation.hpp"
#include "files/atomic_file.hpp"
#include "images/encoded_image.hpp"
#include "images/jpeg.hpp"
#include "rig/frame_folder.hpp"
#include "rig/frame_pairing.hpp"

namespace voqcal {
namespace {

// The files' bytes are passed on as they are: PNG stays lossless, JPEG is not compressed twice.
class FolderCameraSource : public CameraSource {
 public:
  explicit FolderCameraSource(const FrameOptions& options) : folder_(options, kImageEndings) {}

  std::optional<TimedImage> Next() override {
    auto image = folder_.NextReadable(Read);
    has_ended_ = !image;
    return image;
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  static TimedImage Read(const FrameFile& file) {
    const std::string text = ReadWholeFile(file.path);
    TimedImage image{file.utime, {text.begin(), text.end()}};
    const auto info = InspectEncodedImage(image.bytes);
    if (!info) throw std::runtime_error(file.path.string() + ": neither a JPEG nor a PNG");
    if (!info->has_end) throw std::runtime_error(file.path.string() + ": is cut off");
    return image;
  }

  FrameFolder folder_;
  bool has_ended_ = false;
};

/// @tparam World  Simulation, or one like it.
template <typename World>
class SimulatedCameraSource : public CameraSource {
 public:
  SimulatedCameraSource(std::unique_ptr<World> world, const CameraDriverOptions& options)
      : world_(std::move(world)), rate_hz_(options.rate_hz), jpeg_quality_(options.jpeg_quality) {}

  std::optional<TimedImage> Next() override {
    const double time_s = static_cast<double>(num_images_) / rate_hz_;
    has_ended_ = time_s > world_->DurationS();
    if (has_ended_) return {};
    ++num_images_;
    const std::int64_t utime = kSyntheticEpochUtime + std::llround(time_s * 1e6);
    return TimedImage{utime, EncodeJpeg(world_->Image(time_s), jpeg_quality_)};
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  std::unique_ptr<World> world_;
  double rate_hz_;
  int jpeg_quality_;
  std::int64_t num_images_ = 0;
  bool has_ended_ = false;
};

/// What one camera of a rig sees of the world of all.
class WorldOfRig {
 public:
  explicit WorldOfRig(const Rig& rig)
      : simulation_(rig.simulated_rig, rig.board),
        camera_(IndexOfName(rig.simulated_rig.cameras, rig.camera_name)) {}

  double DurationS() const { return simulation_.DurationS(); }
  cv::Mat Image(double time_s) { return simulation_.Image(camera_, time_s); }

 private:
  RigSimulation simulation_;
  std::size_t camera_;
};

std::unique_ptr<CameraSource> MakeSimulatedSource(const Rig& rig, Bus* bus) {
  if (!rig.simulated_rig.cameras.empty()) {
    return std::make_unique<SimulatedCameraSource<WorldOfRig>>(std::make_unique<WorldOfRig>(rig),
                                                               rig.camera_driver);
  }
  if (rig.simulation.follows_guidance) return std::make_unique<GuidedCameraSource>(rig, bus);
  return std::make_unique<SimulatedCameraSource<Simulation>>(
      std::make_unique<Simulation>(rig.simulation, rig.board, rig.camera), rig.camera_driver);
}

}  // namespace

std::unique_ptr<CameraSource> MakeCameraSource(const Rig& rig, Bus* bus) {
  switch (rig.camera_driver.source) {
    case CameraDriverOptions::Source::kFolder:
      RequireFolder(rig.camera_driver, rig.path.string() + ": camera_driver");
      AnnouncePairing(rig);
      return std::make_unique<FolderCameraSource>(rig.camera_driver);
    case CameraDriverOptions::Source::kSimulator:
      return MakeSimulatedSource(rig, bus);
    case CameraDriverOptions::Source::kVideo:
      return MakeVideoSource(rig.camera_driver);
    case CameraDriverOptions::Source::kGenicam:
      return MakeGenicamSource(rig);
  }
  throw std::logic_error("MakeCameraSource: unknown source");
}

}  // namespace voqcal
