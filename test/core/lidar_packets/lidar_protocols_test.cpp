#include "core/lidar_packets/lidar_protocols.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/capture_file.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

TEST(LidarProtocols, HaveNamesOfTheirOwnWhichTheDriversNoteLists) {
  const std::string note =
      test::ReadBytes(std::string(VOQCAL_SOURCE_DIR) + "/modules/lidar_driver/README.md");
  std::set<std::string> names;
  for (const LidarProtocol& protocol : LidarProtocols()) {
    EXPECT_TRUE(names.insert(protocol.name).second) << protocol.name;
    EXPECT_THAT(note, HasSubstr('`' + protocol.name + '`'));
    EXPECT_EQ(FindLidarProtocol(protocol.name), &protocol);
    EXPECT_GT(protocol.clock_us, 0) << protocol.name;
  }
  EXPECT_EQ(FindLidarProtocol("vlp16")->name, "velodyne_vlp16");
  EXPECT_EQ(FindLidarProtocol("spectrum_scan")->name, "baraja_spectrum_scan");
  EXPECT_EQ(FindLidarProtocol(""), nullptr);
}

TEST(WrongLidarText, NamesWhoMayHaveSentIt) {
  EXPECT_EQ(WrongLidarText(*FindLidarProtocol("vlp16"), {{1262, 1439}, {48, 3}}),
            "no VLP-16 packet among 1439 of 1262 bytes: another sensor? 1262 bytes is what "
            "hesai_40p sends");
  EXPECT_EQ(WrongLidarText(*FindLidarProtocol("vlp16"), {{7, 2}}),
            "no VLP-16 packet among 2 of 7 bytes: another sensor?");
  EXPECT_EQ(WrongLidarText(*FindLidarProtocol("ouster"), {{8448, 192}}),
            "no OS-0, OS-1, OS-2 packet among 192 of 8448 bytes: another sensor? Or is the "
            "calibration another unit's?");
}

}  // namespace
}  // namespace voqcal
