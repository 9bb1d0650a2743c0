#include "files/foreign_file.hpp"

#include <fstream>

namespace voqcal {
namespace {

using std::string_view_literals::operator""sv;

struct Kind {
  std::string_view first_bytes;
  const char* text;
};

constexpr Kind kKinds[] = {
    {"\x1F\x8B"sv, "is compressed: unpack it first (gunzip)"},
    {"BZh"sv, "is compressed: unpack it first (bunzip2)"},
    {"\xFD"
     "7zXZ"sv,
     "is compressed: unpack it first (unxz)"},
    {"\x28\xB5\x2F\xFD"sv, "is compressed: unpack it first (unzstd)"},
    {"\x04\x22\x4D\x18"sv, "is compressed: unpack it first (unlz4)"},
    {"PK\x03\x04"sv, "is compressed: unpack it first (unzip)"},
    {"#ROSBAG V"sv, "is a recording of ROS: calibrate --bag reads it"},
    {"\x89MCAP"sv, "is a recording of ROS: calibrate --bag reads it"},
    {"SQLite format 3"sv, "is a recording of ROS: calibrate --bag reads it"},
};

}  // namespace

std::string ForeignFileText(std::string_view first_bytes) {
  for (const Kind& kind : kKinds) {
    if (first_bytes.substr(0, kind.first_bytes.size()) == kind.first_bytes) return kind.text;
  }
  return "";
}

std::string ForeignFileText(const std::filesystem::path& path) {
  char bytes[16] = {};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes, sizeof(bytes));
  return ForeignFileText(std::string_view(bytes, static_cast<std::size_t>(file.gcount())));
}

}  // namespace voqcal
