#include "files/natural_order.hpp"

#include <algorithm>
#include <stdexcept>

namespace voqcal {
namespace {

namespace fs = std::filesystem;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Takes the run of digits, or the one other character, that `text` begins with.
std::string_view TakePart(std::string_view* text) {
  std::size_t length = 1;
  if (IsDigit(text->front())) {
    while (length < text->size() && IsDigit((*text)[length])) ++length;
  }
  const std::string_view part = text->substr(0, length);
  text->remove_prefix(length);
  return part;
}

/// Negative, zero or positive, as numbers of any length if both are digits.
int OrderOfParts(std::string_view a, std::string_view b) {
  if (IsDigit(a.front()) && IsDigit(b.front())) {
    const auto without_zeros = [](std::string_view digits) {
      return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
    };
    a = without_zeros(a);
    b = without_zeros(b);
    if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  }
  return a.compare(b);
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

bool IsNaturallyLess(std::string_view a, std::string_view b) {
  std::string_view rest_a = a;
  std::string_view rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const int order = OrderOfParts(TakePart(&rest_a), TakePart(&rest_b));
    if (order != 0) return order < 0;
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  // Equal as numbers, e.g. 2 and 02: the shorter first, so that the order is total.
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::vector<fs::path> FilesInNaturalOrder(const fs::path& folder,
                                          const std::vector<std::string>& extensions) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) {
    throw std::runtime_error(folder.string() + ": cannot be read as a folder: " + error.message());
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : entries) {
    // Hidden files, such as the "._pose1.png" that macOS leaves on foreign disks, are none of ours.
    if (entry.path().filename().string().front() == '.') continue;
    const std::string extension = LowerCase(entry.path().extension().string());
    const bool is_wanted =
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
    if (is_wanted && entry.is_regular_file()) files.push_back(entry.path());
  }
  if (files.empty()) {
    throw std::runtime_error(folder.string() + ": has no file that ends in " + Joined(extensions));
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return IsNaturallyLess(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace voqcal
