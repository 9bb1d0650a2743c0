#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// One image as a JPEG or PNG file's bytes, and when it was exposed.
struct TimedImage {
  std::int64_t utime = 0;
  std::vector<std::uint8_t> bytes;
};

/// Where the camera driver's images come from, one after the other.
class CameraSource {
 public:
  virtual ~CameraSource() = default;

  /// False while it waits for other modules: it is not to be asked yet.
  virtual bool IsReady() const { return true; }

  /// The next image; nothing if there is none now, or never will be.
  /// @throws std::runtime_error naming the file and the cause.
  virtual std::optional<TimedImage> Next() = 0;

  /// True once there will never be an image again.
  virtual bool HasEnded() const = 0;

  /// True if Next waits for the camera's own next frame; else the driver's rate sets the pace.
  virtual bool SetsThePace() const { return false; }

  /// "running", or what it waits for.
  virtual std::string State() const { return "running"; }
};

/// The source that the rig file names. Frames of folders, files and the
/// simulator count from kSyntheticEpochUtime.
/// @param bus  for sources that listen; borrowed.
std::unique_ptr<CameraSource> MakeCameraSource(const Rig& rig, Bus* bus);

}  // namespace voqcal
