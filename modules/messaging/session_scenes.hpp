#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/parallel.hpp"
#include "messaging/log.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {

/// Name of a session's log of samples in its folder.
inline constexpr char kSamplesLogName[] = "samples.lcm";

/// Its channels. A change of the samples is one CALIB_SAMPLE (sample_t) or CALIB_EVENT (event_t); a
/// sample's scene comes before it, as the sensors' own messages, under the same event number.
inline constexpr char kSceneSweepChannel[] = "CALIB_SWEEP";  ///< pointcloud2_t
inline constexpr char kSceneImageChannel[] = "CALIB_IMAGE";  ///< image_t
inline constexpr char kSampleChannel[] = "CALIB_SAMPLE";
inline constexpr char kEventChannel[] = "CALIB_EVENT";

/// What both sensors saw at a sample's first frame; FromMessage makes a cloud and an image of it.
struct SessionScene {
  std::int64_t sample_id = 0;
  pointcloud2_t sweep;
  image_t image;
};

/// Reads the scenes of a session's samples.lcm, in order and one at a time: a session may hold more
/// than fits in memory. Samples without a scene (a frame that was lost, features read from a table)
/// are passed over; samples that were discarded later are not.
///
/// The session may go on meanwhile: what is being written is not read.
class SessionSceneReader {
 public:
  /// @throws std::runtime_error naming the file, if it cannot be read.
  explicit SessionSceneReader(const std::filesystem::path& samples_log);

  /// The next sample's scene, or nothing at the end.
  /// @throws std::runtime_error naming file, event and cause, if the log is damaged.
  std::optional<SessionScene> Next();

 private:
  /// The next event; nothing at the end or at an event that is not yet whole.
  std::optional<LogEvent> NextEvent();

  std::filesystem::path path_;
  LogReader reader_;
};

/// Calls `work` for each scene for which `is_wanted` says so, one a core at a time: it must not
/// matter which comes first. Of a log that is damaged somewhere, the scenes before that are done.
/// Scenes of the same sample and time, as logs have that were joined, count once: the first.
/// @param is_wanted  is called by one thread at a time, while `work` goes on.
/// @throws as SessionSceneReader; what `work` throws of the first scene that it does of, once all
///     that were begun have ended: none is begun after it.
template <typename IsWanted, typename Work>
void ForEachScene(const std::filesystem::path& samples_log,
                  const IsWanted& is_wanted,
                  const Work& work) {
  struct Numbered {
    std::size_t number;
    SessionScene scene;
  };
  std::mutex reading;  // of all that follows
  SessionSceneReader reader(samples_log);
  std::set<std::pair<std::int64_t, std::int64_t>> taken;  // id, utime
  bool is_at_end = false;
  std::exception_ptr error;
  std::size_t number_of_error = std::numeric_limits<std::size_t>::max();
  const auto keep_error = [&](std::size_t number) {
    is_at_end = true;
    if (number >= number_of_error) return;
    number_of_error = number;
    error = std::current_exception();
  };
  const auto next = [&]() -> std::optional<Numbered> {
    const std::lock_guard<std::mutex> lock(reading);
    try {
      while (!is_at_end) {
        std::optional<SessionScene> scene = reader.Next();
        is_at_end = !scene;
        if (!scene || !is_wanted(*scene)) continue;
        if (!taken.emplace(scene->sample_id, scene->sweep.utime).second) continue;
        return Numbered{taken.size(), std::move(*scene)};
      }
    } catch (...) {
      keep_error(taken.size() + 1);
    }
    return std::nullopt;
  };
  ParallelFor(1 + Helpers::Shared().num(), [&](std::size_t) {
    while (const std::optional<Numbered> each = next()) {
      try {
        work(each->scene);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(reading);
        keep_error(each->number);
      }
    }
  });
  if (error) std::rethrow_exception(error);
}

}  // namespace voqcal
