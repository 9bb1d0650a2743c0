#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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

  /// The next image; nothing when the source has ended.
  /// @throws std::runtime_error naming the file and the cause.
  virtual std::optional<TimedImage> Next() = 0;
};

/// The source that the rig file names. Frames count from kSyntheticEpochUtime.
std::unique_ptr<CameraSource> MakeCameraSource(const Rig& rig);

}  // namespace voqcal
