#include "camera_driver/camera_source.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "camera_driver/genicam_source.hpp"
#include "camera_driver/guided_camera_source.hpp"
#include "camera_driver/video_source.hpp"
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

class SimulatedCameraSource : public CameraSource {
 public:
  explicit SimulatedCameraSource(const Rig& rig)
      : simulation_(rig.simulation, rig.board, rig.camera),
        rate_hz_(rig.camera_driver.rate_hz),
        jpeg_quality_(rig.camera_driver.jpeg_quality) {}

  std::optional<TimedImage> Next() override {
    const double time_s = static_cast<double>(num_images_) / rate_hz_;
    has_ended_ = time_s > simulation_.DurationS();
    if (has_ended_) return {};
    ++num_images_;
    const std::int64_t utime = kSyntheticEpochUtime + std::llround(time_s * 1e6);
    return TimedImage{utime, EncodeJpeg(simulation_.Image(time_s), jpeg_quality_)};
  }

  bool HasEnded() const override { return has_ended_; }

 private:
  Simulation simulation_;
  double rate_hz_;
  int jpeg_quality_;
  std::int64_t num_images_ = 0;
  bool has_ended_ = false;
};

}  // namespace

std::unique_ptr<CameraSource> MakeCameraSource(const Rig& rig, Bus* bus) {
  switch (rig.camera_driver.source) {
    case CameraDriverOptions::Source::kFolder:
      RequireFolder(rig.camera_driver, rig.path.string() + ": camera_driver");
      AnnouncePairing(rig);
      return std::make_unique<FolderCameraSource>(rig.camera_driver);
    case CameraDriverOptions::Source::kSimulator:
      if (rig.simulation.follows_guidance) return std::make_unique<GuidedCameraSource>(rig, bus);
      return std::make_unique<SimulatedCameraSource>(rig);
    case CameraDriverOptions::Source::kVideo:
      return MakeVideoSource(rig.camera_driver);
    case CameraDriverOptions::Source::kGenicam:
      return MakeGenicamSource(rig);
  }
  throw std::logic_error("MakeCameraSource: unknown source");
}

}  // namespace voqcal
