#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// What one sensor's detector makes of a recording, for every pair that the sensor is part of: the
/// detector sees nothing of the others.
class DetectedBoards {
 public:
  enum class Sensor { kLidar, kCamera };

  /// Runs the detector over the whole recording; what the file's end cuts off is left out.
  ///
  /// @param rig  any pair with the sensor.
  /// @param use_log_times  a message's time is when it was recorded.
  /// @param on_progress    called now and then with the share done.
  /// @throws std::runtime_error naming the log, event and cause.
  DetectedBoards(const Rig& rig,
                 Sensor sensor,
                 const std::filesystem::path& log,
                 bool use_log_times,
                 const std::function<void(double share)>& on_progress);

  /// The detector, with its counts.
  const Module& detector() const { return *detector_; }

  /// The messages that came of the event which ends at that byte of the recording, encoded.
  /// (Numbers of events may repeat.)
  const std::vector<std::vector<std::uint8_t>>& Of(std::int64_t end_of_event) const;

 private:
  template <typename Detector, typename BoardMessage>
  void Listen(const Rig& rig, const std::string& board_channel);

  Bus bus_;
  std::unique_ptr<Module> detector_;
  std::map<std::int64_t, std::vector<std::vector<std::uint8_t>>> boards_;  // by event
  std::int64_t end_of_event_ = 0;  // of the one that is being handled
};

}  // namespace voqcal
