#include "lidar_driver/calibrated_stream.hpp"

#include <stdexcept>
#include <string>

#include "files/atomic_file.hpp"

namespace voqcal {

LidarPacketStream CalibratedStream(LidarPacketOptions options,
                                   const std::filesystem::path& calibration) {
  const LidarProtocol& protocol = *options.protocol;
  if (calibration.empty()) {
    if (protocol.needs_calibration) {
      throw std::runtime_error(protocol.name + " needs a calibration: " + protocol.calibration +
                               " of this very unit");
    }
    return LidarPacketStream(options);
  }
  if (protocol.calibration.empty()) {
    throw std::runtime_error(calibration.string() + ": " + protocol.name +
                             " takes no calibration: leave it out");
  }
  options.unit.calibration = ReadWholeFile(calibration);
  try {
    return LidarPacketStream(options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(calibration.string() + ": " + error.what() +
                             " (expected: " + protocol.calibration + ')');
  }
}

}  // namespace voqcal
