#include "core/lidar_packets/lidar_recognition.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/vlp16_packet.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> SendersOf(const std::vector<std::uint8_t>& bytes,
                                   const std::string& calibration = "") {
  std::vector<std::string> names;
  for (const LidarProtocol* sender : LidarsThatSend({bytes.data(), bytes.size()}, calibration)) {
    names.push_back(sender->name);
  }
  return names;
}

TEST(LidarsThatSend, TellsModelsOfOneSizeApart) {
  const auto packet = test::Vlp16Turns(1).front();
  const std::vector<std::uint8_t> bytes(packet.bytes.begin(), packet.bytes.end());
  EXPECT_THAT(SendersOf(bytes), ElementsAre("velodyne_vlp16"));
  EXPECT_THAT(SendersOf(bytes, "of another lidar"), IsEmpty());
  EXPECT_THAT(SendersOf(std::vector<std::uint8_t>(1206, 0)), IsEmpty());
  EXPECT_THAT(SendersOf({}), IsEmpty());
}

}  // namespace
}  // namespace voqcal
