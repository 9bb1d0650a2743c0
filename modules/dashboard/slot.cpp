#include "dashboard/slot.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace voqcal {

const char* ToString(Slot slot) {
  constexpr std::array<const char*, kNumSlots> kNames = {"rig",
                                                         "pairs",
                                                         "samples",
                                                         "result",
                                                         "report",
                                                         "guidance",
                                                         "events",
                                                         "modules",
                                                         "lidar_board",
                                                         "camera_board",
                                                         "cloud",
                                                         "image"};
  return kNames.at(static_cast<std::size_t>(slot));
}

FramePtr TextFrame(std::string json) {
  return std::make_shared<const Frame>(Frame{false, std::move(json)});
}

FramePtr BinaryFrame(const std::string& json_header, const std::string& payload) {
  Frame frame{true, ""};
  frame.bytes.reserve(sizeof(std::uint32_t) + json_header.size() + payload.size());
  const auto length = static_cast<std::uint32_t>(json_header.size());
  for (unsigned shift = 0; shift < 32; shift += 8) {
    frame.bytes += static_cast<char>((length >> shift) & 0xffU);
  }
  frame.bytes += json_header;
  frame.bytes += payload;
  return std::make_shared<const Frame>(std::move(frame));
}

}  // namespace voqcal
