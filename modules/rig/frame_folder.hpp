#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rig/rig.hpp"

namespace voqcal {

/// One file of a folder and the time that it stands for.
struct FrameFile {
  std::filesystem::path path;
  std::int64_t utime = 0;
};

/// What files are frames, by the endings of their names.
inline const std::vector<std::string> kCloudEndings = {".pcd", ".ply"};
inline const std::vector<std::string> kImageEndings = {".png", ".jpg", ".jpeg"};

/// How the files of a folder tell which frames they are.
enum class FrameNaming {
  kNumbers,  ///< pose10.png: frame 10.
  kTimes,    ///< 1700000000.25.png: taken then.
  kPlaces,   ///< Neither: the first, the second, ...
};

/// The number of a frame: the last number in its name ("pose10_full.pcd": 10); nothing if there is
/// none, or one too large to be a frame's.
std::optional<std::int64_t> FrameNumber(const std::filesystem::path& path);

/// The time in a frame's name, us since the Unix epoch: the last number, if it has ten digits (s,
/// then perhaps decimals), 13 (ms), 16 (us) or 19 (ns); nothing otherwise.
std::optional<std::int64_t> FrameTime(const std::filesystem::path& path);

/// @param where  file and section that the message names: "my_rig.yaml: lidar_driver".
/// @throws std::runtime_error if the options name no folder.
void RequireFolder(const FrameOptions& options, const std::string& where);

/// The files of a driver's folder as frames. Frame number n stands for kSyntheticEpochUtime + n /
/// rate_hz, so that pose10.png and pose10_full.pcd are of the same instant although other poses may
/// be missing; names that are times stand for these. Where a name has neither, or two names have
/// the same, or the options say so, n is the file's place.
class FrameFolder {
 public:
  /// @throws std::runtime_error naming the folder if it is missing or has no such file.
  FrameFolder(const FrameOptions& options, const std::vector<std::string>& extensions);

  /// The next file in natural order; nothing after the last, unless the options repeat.
  std::optional<FrameFile> Next();

  /// What `read` makes of the next file that it can read; nothing after the last. Files that it
  /// cannot read (std::runtime_error) are named in the log and left out.
  /// @throws std::runtime_error if not one of the folder's files can be read.
  template <typename Read>
  auto NextReadable(const Read& read) -> std::optional<decltype(read(FrameFile{}))> {
    while (const auto file = Next()) {
      try {
        auto frame = read(*file);
        num_in_vain_ = 0;
        return frame;
      } catch (const std::runtime_error& error) {
        LeaveOut(error.what());
      }
    }
    return {};
  }

  const std::vector<FrameFile>& files() const { return files_; }
  std::size_t size() const { return files_.size(); }
  FrameNaming naming() const { return naming_; }

 private:
  void LeaveOut(const std::string& problem);

  std::vector<FrameFile> files_;
  FrameNaming naming_;
  bool is_repeating_;
  std::int64_t round_us_;  // how much later each round of a repetition is
  std::size_t next_ = 0;
  std::int64_t num_rounds_ = 0;
  std::size_t num_in_vain_ = 0;  // files in a row that could not be read
};

}  // namespace voqcal
