#include "camera_driver/guided_camera_source.hpp"

#include <cmath>

#include "images/jpeg.hpp"
#include "messaging/convert_simulation.hpp"

namespace voqcal {

GuidedCameraSource::GuidedCameraSource(const Rig& rig, Bus* bus)
    : options_(rig.simulation),
      simulation_(options_, rig.board, rig.camera),
      rate_hz_(rig.camera_driver.rate_hz),
      jpeg_quality_(rig.camera_driver.jpeg_quality) {
  bus->Subscribe<simulated_board_t>(rig.channels.simulated_board,
                                    Queue::kState,
                                    [this](const simulated_board_t& m) { board_ = m; });
}

bool GuidedCameraSource::IsReady() const { return board_ && NextUtime() < board_->utime; }

std::optional<TimedImage> GuidedCameraSource::Next() {
  has_ended_ = board_->end_utime != 0 && NextUtime() > board_->end_utime;
  if (has_ended_) return {};
  TimedImage image{NextUtime(), {}};
  const double time_s = 1e-6 * static_cast<double>(image.utime - kSyntheticEpochUtime);
  const Eigen::Isometry3d T_lidar_board =
      PoseAt(time_s, StopsFromMessage(*board_, kSyntheticEpochUtime), options_);
  image.bytes = EncodeJpeg(simulation_.Image(time_s, T_lidar_board), jpeg_quality_);
  ++num_images_;
  return image;
}

std::string GuidedCameraSource::State() const {
  return IsReady() ? "running" : "waiting for the simulated lidar";
}

std::int64_t GuidedCameraSource::NextUtime() const {
  return kSyntheticEpochUtime + std::llround(1e6 * static_cast<double>(num_images_) / rate_hz_);
}

}  // namespace voqcal
