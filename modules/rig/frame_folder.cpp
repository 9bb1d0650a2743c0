#include "rig/frame_folder.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <spdlog/spdlog.h>

#include "files/natural_order.hpp"

namespace voqcal {
namespace {

bool EndsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The last run of digits in a text.
std::string LastDigits(const std::string& text) {
  const auto end = std::find_if(text.rbegin(), text.rend(), IsDigit).base();
  auto begin = end;
  while (begin != text.begin() && IsDigit(*(begin - 1))) --begin;
  return {begin, end};
}

using NumberOf = std::optional<std::int64_t> (*)(const std::filesystem::path&);

/// What the names say, if each says something, later files more than earlier ones; else nothing.
std::vector<std::int64_t> Rising(const std::vector<std::filesystem::path>& paths, NumberOf of) {
  std::vector<std::int64_t> numbers;
  for (const auto& path : paths) {
    const auto number = of(path);
    if (!number || (!numbers.empty() && *number <= numbers.back())) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// How many us one unit of a time of so many digits is, and how many units; 0 for no time.
std::int64_t TimeUs(const std::string& digits) {
  switch (digits.size()) {
    case 10:
      return std::stoll(digits) * 1'000'000;
    case 13:
      return std::stoll(digits) * 1000;
    case 16:
      return std::stoll(digits);
    case 19:
      return digits[0] == '9' ? 0 : std::stoll(digits) / 1000;
    default:
      return 0;
  }
}

}  // namespace

std::optional<std::int64_t> FrameNumber(const std::filesystem::path& path) {
  constexpr std::size_t kMaxDigits = 9;  // longer ones are times or hashes
  const std::string digits = LastDigits(path.stem().string());
  if (digits.empty() || digits.size() > kMaxDigits) return {};
  return std::stoll(digits);
}

std::optional<std::int64_t> FrameTime(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  const std::string last = LastDigits(stem);
  const std::string before = stem.substr(0, stem.rfind(last));
  // Seconds and decimals, parted by a point or, where a program avoids that, by something else.
  const std::string seconds = before.empty() ? "" : LastDigits(before.substr(0, before.size() - 1));
  const bool has_decimals =
      seconds.size() == 10 && before.size() > 10 && before.rfind(seconds) == before.size() - 11;
  const std::int64_t time_us =
      has_decimals ? TimeUs(seconds) + std::stoll((last + "000000").substr(0, 6)) : TimeUs(last);
  if (time_us <= 0) return {};
  return time_us;
}

void RequireFolder(const FrameOptions& options, const std::string& where) {
  if (options.folder.empty()) {
    throw std::runtime_error(where + ".folder: must be given, since source is folder");
  }
}

FrameFolder::FrameFolder(const FrameOptions& options, const std::vector<std::string>& extensions)
    : naming_(FrameNaming::kPlaces), is_repeating_(options.is_repeating) {
  std::vector<std::filesystem::path> paths = FilesInNaturalOrder(options.folder, extensions);
  const auto is_other = [&options](const std::filesystem::path& path) {
    return !EndsWith(path.filename().string(), options.file_ending);
  };
  paths.erase(std::remove_if(paths.begin(), paths.end(), is_other), paths.end());
  if (paths.empty()) {
    throw std::runtime_error(options.folder.string() + ": no file whose name ends with '" +
                             options.file_ending + "'");
  }
  const std::vector<std::int64_t> times = Rising(paths, FrameTime);
  const std::vector<std::int64_t> numbers = Rising(paths, FrameNumber);
  if (!options.is_by_order && !times.empty())
    naming_ = FrameNaming::kTimes;
  else if (!options.is_by_order && !numbers.empty())
    naming_ = FrameNaming::kNumbers;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::int64_t number =
        naming_ == FrameNaming::kNumbers ? numbers[i] : static_cast<std::int64_t>(i);
    const std::int64_t synthetic_us =
        kSyntheticEpochUtime + std::llround(static_cast<double>(number) / options.rate_hz * 1e6);
    files_.push_back({paths[i], naming_ == FrameNaming::kTimes ? times[i] : synthetic_us});
  }
  round_us_ = files_.back().utime - files_.front().utime + std::llround(1e6 / options.rate_hz);
}

void FrameFolder::LeaveOut(const std::string& problem) {
  if (++num_in_vain_ >= files_.size()) {
    throw std::runtime_error("none of the folder's files can be read, the last for: " + problem);
  }
  if (num_rounds_ == 0) spdlog::warn("left out: {}", problem);
}

std::optional<FrameFile> FrameFolder::Next() {
  if (next_ == files_.size()) {
    if (!is_repeating_) return {};
    next_ = 0;
    ++num_rounds_;
  }
  FrameFile file = files_[next_++];
  file.utime += num_rounds_ * round_us_;
  return file;
}

}  // namespace voqcal
