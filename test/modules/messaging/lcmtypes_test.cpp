#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messaging/bus.hpp"
#include "messaging/encode.hpp"
#include "voqcal/image_metadata_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/pointfield_t.hpp"
#include "voqcal/raw_t.hpp"
#include "voqcal/rigid_transform_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

template <typename Message>
std::uint64_t Fingerprint() {
  return static_cast<std::uint64_t>(Message::getHash());
}

/// `message` with the four big-endian bytes at `at` replaced by `value`.
std::vector<std::uint8_t> WithInt32(std::vector<std::uint8_t> bytes,
                                    std::size_t at,
                                    std::int32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
  }
  return bytes;
}

template <typename Message>
std::string ProblemOf(const std::vector<std::uint8_t>& bytes) {
  Message message;
  return DecodeMessage(bytes.data(), bytes.size(), &message);
}

// lcm-gen's numbers for openhumanoids/bot_core_lcmtypes: drivers and viewers of others work with
// ours.
TEST(Fingerprint, IsBotCores) {
  EXPECT_EQ(Fingerprint<image_t>(), 0x14739ffe13d5f5f0U);
  EXPECT_EQ(Fingerprint<image_metadata_t>(), 0x9a4b634d0577fb8eU);
  EXPECT_EQ(Fingerprint<pointcloud2_t>(), 0x0bcd5ce4bf5a1b4aU);
  EXPECT_EQ(Fingerprint<pointfield_t>(), 0xb24e10825e0b476dU);
  EXPECT_EQ(Fingerprint<raw_t>(), 0x30571b45b804c18eU);
  EXPECT_EQ(Fingerprint<rigid_transform_t>(), 0xea9ffbf2acc5c5aeU);
}

TEST(DecodeMessage, TakesAWholeMessage) {
  image_t image{};
  image.size = 3;
  image.data = {1, 2, 3};
  const auto bytes = EncodeMessage(image);
  image_t decoded;
  EXPECT_EQ(DecodeMessage(bytes.data(), bytes.size(), &decoded), "");
  EXPECT_EQ(decoded.data, image.data);
}

TEST(DecodeMessage, SaysWhyNot) {
  const auto bytes = EncodeMessage(image_t{});
  EXPECT_NE(ProblemOf<image_t>({}), "");
  EXPECT_NE(ProblemOf<pointcloud2_t>(bytes), "");  // another type's fingerprint

  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_NE(ProblemOf<image_t>(longer), "");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_NE(ProblemOf<image_t>({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)}),
              "")
        << n;
  }
}

// Counts that would allocate gigabytes, throw std::length_error, or (2^29 and 2^30, whose size in
// bytes overflows an int) read past the end. The sanitizers of the dev build would tell.
TEST(DecodeMessage, RefusesAbsurdCounts) {
  constexpr std::size_t kHash = 8;
  constexpr std::size_t kImageSizeAt = kHash + 8 + 4 * 4;  // utime, width .. pixelformat
  constexpr std::size_t kImageMetadataAt = kImageSizeAt + 4;
  constexpr std::size_t kCloudFieldsAt = kHash + 8 + 4 + (4 + 1) + 4 + 4;  // empty frame_id
  constexpr std::size_t kSamplesAt = kHash + 8 + 8 + 1 + (4 + 1);
  const auto image = EncodeMessage(image_t{});
  const auto cloud = EncodeMessage(pointcloud2_t{});
  const auto samples = EncodeMessage(samples_t{});
  for (const std::int32_t count : {-1, INT32_MIN, INT32_MAX, 1 << 29, 1 << 30, 1000}) {
    EXPECT_NE(ProblemOf<image_t>(WithInt32(image, kImageSizeAt, count)), "") << count;
    EXPECT_NE(ProblemOf<image_t>(WithInt32(image, kImageMetadataAt, count)), "") << count;
    EXPECT_NE(ProblemOf<pointcloud2_t>(WithInt32(cloud, kCloudFieldsAt, count)), "") << count;
    EXPECT_NE(ProblemOf<samples_t>(WithInt32(samples, kSamplesAt, count)), "") << count;
  }
}

TEST(DecodeMessage, RefusesStringsWithoutAnEnd) {
  constexpr std::size_t kFrameIdAt = 8 + 8 + 4;
  const auto cloud = EncodeMessage(pointcloud2_t{});
  for (const std::int32_t length : {0, -1, INT32_MIN, INT32_MAX}) {
    EXPECT_NE(ProblemOf<pointcloud2_t>(WithInt32(cloud, kFrameIdAt, length)), "") << length;
  }
}

}  // namespace
}  // namespace voqcal
