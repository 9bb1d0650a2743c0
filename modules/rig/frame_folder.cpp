#include "rig/frame_folder.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <stdexcept>

#include "files/natural_order.hpp"

namespace voqcal {
namespace {

bool EndsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

// The numbers of the names, or their places where the names do not number them.
std::vector<std::int64_t> NumberFrames(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::int64_t> numbers;
  std::set<std::int64_t> distinct;
  for (const auto& path : paths) {
    const auto number = FrameNumber(path);
    if (!number || !distinct.insert(*number).second) break;
    numbers.push_back(*number);
  }
  const bool is_numbered =
      numbers.size() == paths.size() && std::is_sorted(numbers.begin(), numbers.end());
  if (is_numbered) return numbers;
  numbers.clear();
  for (std::size_t i = 0; i < paths.size(); ++i) numbers.push_back(static_cast<std::int64_t>(i));
  return numbers;
}

}  // namespace

std::optional<std::int64_t> FrameNumber(const std::filesystem::path& path) {
  constexpr std::size_t kMaxDigits = 9;  // longer ones are times or hashes
  const std::string stem = path.stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto end = std::find_if(stem.rbegin(), stem.rend(), is_digit).base();
  auto begin = end;
  while (begin != stem.begin() && is_digit(static_cast<unsigned char>(*(begin - 1)))) --begin;
  const std::string digits(begin, end);
  if (digits.empty() || digits.size() > kMaxDigits) return {};
  return std::stoll(digits);
}

void RequireFolder(const FrameOptions& options, const std::string& where) {
  if (options.folder.empty()) {
    throw std::runtime_error(where + ".folder: must be given, since source is folder");
  }
}

FrameFolder::FrameFolder(const FrameOptions& options, const std::vector<std::string>& extensions)
    : is_repeating_(options.is_repeating) {
  std::vector<std::filesystem::path> paths = FilesInNaturalOrder(options.folder, extensions);
  const auto is_other = [&options](const std::filesystem::path& path) {
    return !EndsWith(path.filename().string(), options.file_ending);
  };
  paths.erase(std::remove_if(paths.begin(), paths.end(), is_other), paths.end());
  if (paths.empty()) {
    throw std::runtime_error(options.folder.string() + ": no file whose name ends with '" +
                             options.file_ending + "'");
  }
  const std::vector<std::int64_t> numbers = NumberFrames(paths);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double time_s = static_cast<double>(numbers[i]) / options.rate_hz;
    files_.push_back({paths[i], kSyntheticEpochUtime + std::llround(time_s * 1e6)});
  }
  round_us_ = files_.back().utime - files_.front().utime + std::llround(1e6 / options.rate_hz);
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
