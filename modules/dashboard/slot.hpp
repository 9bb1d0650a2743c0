#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace voqcal {

/// The kinds of what a page is told. Of each kind only the newest counts.
enum class Slot : std::size_t {
  kRig,
  kPairs,
  kSamples,
  kResult,
  kReport,
  kGuidance,
  kEvents,
  kModules,
  kLidarBoard,
  kCameraBoard,
  kCloud,
  kImage,
};
inline constexpr std::size_t kNumSlots = 12;

/// "rig", "samples", ...: its name in every message.
const char* ToString(Slot slot);

/// Frames so large that the next is held back until the page has drawn the last.
inline bool IsLarge(Slot slot) { return slot == Slot::kCloud || slot == Slot::kImage; }

/// One WebSocket message, shared by all pages that are still to get it.
struct Frame {
  bool is_binary = false;
  std::string bytes;
};
using FramePtr = std::shared_ptr<const Frame>;

/// A message of JSON text.
FramePtr TextFrame(std::string json);

/// A message of a header in JSON and what it describes: the header's length (uint32,
/// little-endian), the header, the payload.
FramePtr BinaryFrame(const std::string& json_header, const std::string& payload);

}  // namespace voqcal
