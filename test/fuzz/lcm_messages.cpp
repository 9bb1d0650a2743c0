// First byte: the type (lcm_types.hpp). Then the message without its fingerprint, which Decode
// adds.
#include <tuple>
#include <utility>
#include <vector>

#include "fuzz/fuzz_input.hpp"
#include "fuzz/lcm_types.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert.hpp"
#include "messaging/sequence.hpp"

namespace voqcal::fuzz {
namespace {

// What a node does first with a message; nothing for types that are read field by field.
template <typename Message>
void Use(const Message&) {}
void Use(const camera_board_t& message) { SightingFromMessage(message); }
void Use(const camera_info_t& message) { FromMessage(message); }
void Use(const extrinsic_averaged_t& message) {
  FromMessage(message);
  for (const set_extrinsic_t& set : message.sets) FromMessage(set);
}
void Use(const extrinsic_refined_t& message) { FromMessage(message); }
void Use(const image_t& message) {
  constexpr std::int64_t kMaxPixels = 1 << 20;  // as in images.cpp
  SequenceOf(message);
  if (std::int64_t{message.width} * message.height <= kMaxPixels) FromMessage(message);
}
void Use(const lidar_board_t& message) { SightingFromMessage(message); }
void Use(const pointcloud2_t& message) { FromMessage(message); }
void Use(const sample_t& message) { FromMessage(message); }
void Use(const samples_t& message) {
  SamplesAsChosen(message, {});
  std::vector<BoardSample> samples = FromMessage(message);
  TakeChosen({{}}, &samples);
}
void Use(const voq_sets_t& message) {
  for (const voq_set_t& set : message.sets) FromMessage(set, {1, 2, 3});
}

template <typename Message>
void Decode(const Input& input) {
  std::vector<std::uint8_t> bytes(8);
  const auto hash = static_cast<std::uint64_t>(Message::getHash());
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(hash >> (56 - 8 * i));
  bytes.insert(bytes.end(), input.data(), input.data() + input.size());
  Message message;
  if (!DecodeMessage(bytes.data(), bytes.size(), &message).empty()) return;
  Tolerate([&message] { Use(message); });
}

template <std::size_t... kPlaces>
void DecodeAs(std::size_t type, const Input& input, std::index_sequence<kPlaces...>) {
  ((type == kPlaces ? Decode<std::tuple_element_t<kPlaces, LcmTypes>>(input) : void()), ...);
}

}  // namespace
}  // namespace voqcal::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using voqcal::fuzz::LcmTypes;
  constexpr std::size_t kNumTypes = std::tuple_size_v<LcmTypes>;
  voqcal::fuzz::Input input(data, size);
  const std::size_t type = input.Byte() % kNumTypes;
  voqcal::fuzz::DecodeAs(type, input, std::make_index_sequence<kNumTypes>());
  return 0;
}
