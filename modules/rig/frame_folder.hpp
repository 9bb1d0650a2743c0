#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rig/rig.hpp"

namespace voqcal {

/// One file of a folder and the time that it stands for.
struct FrameFile {
  std::filesystem::path path;
  std::int64_t utime = 0;
};

/// The number of a frame: the last number in its name ("pose10_full.pcd": 10); nothing if there is
/// none, or one too large to be a frame's.
std::optional<std::int64_t> FrameNumber(const std::filesystem::path& path);

/// @param where  file and section that the message names: "my_rig.yaml: lidar_driver".
/// @throws std::runtime_error if the options name no folder.
void RequireFolder(const FrameOptions& options, const std::string& where);

/// The files of a driver's folder as frames. Frame number n stands for kSyntheticEpochUtime + n /
/// rate_hz, so that pose10.png and pose10_full.pcd are of the same instant although other poses may
/// be missing; where a name has no number, or two names have the same, n is the file's place.
class FrameFolder {
 public:
  /// @throws std::runtime_error naming the folder if it is missing or has no such file.
  FrameFolder(const FrameOptions& options, const std::vector<std::string>& extensions);

  /// The next file in natural order; nothing after the last, unless the options repeat.
  std::optional<FrameFile> Next();

  std::size_t size() const { return files_.size(); }

 private:
  std::vector<FrameFile> files_;
  bool is_repeating_;
  std::int64_t round_us_;  // how much later each round of a repetition is
  std::size_t next_ = 0;
  std::int64_t num_rounds_ = 0;
};

}  // namespace voqcal
