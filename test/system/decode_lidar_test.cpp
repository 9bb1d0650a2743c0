// The tool decode_lidar on captures that the test writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/pcap_file.hpp"
#include "support/temporary_folder.hpp"
#include "support/vlp16_packet.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two turns of a VLP-16, each packet as often as asked for.
test::PcapFile TwoTurns(int num_copies) {
  test::PcapFile file;
  std::int64_t utime = 1700000000000000;
  for (const auto& packet : test::Vlp16Turns(150)) {
    for (int copy = 0; copy < num_copies; ++copy) {
      file.Add(utime, test::UdpFrame{2368, packet.bytes}.Ethernet());
    }
    utime += 1327;
  }
  return file;
}

TEST(DecodeLidar, WritesEachSweepAndLeavesOutSecondCopies) {
  const test::TemporaryFolder folder;
  const auto capture = folder.Write("drive.pcap", TwoTurns(2).Bytes());
  const auto out = folder.path() / "sweeps";
  const test::Outcome outcome = test::Run({test::Program("decode_lidar"),
                                           capture.string(),
                                           "--model",
                                           "velodyne_vlp16",
                                           "--out",
                                           out.string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 sweeps, 57600 points"));
  EXPECT_THAT(outcome.out, HasSubstr("150 packets twice"));
  EXPECT_THAT(test::NamesIn(out), ElementsAre("sweep_0000.pcd", "sweep_0001.pcd"));
}

TEST(DecodeLidar, NamesTheWrongModel) {
  const test::TemporaryFolder folder;
  const auto capture = folder.Write("drive.pcap", TwoTurns(1).Bytes());
  const auto run = [&](const std::string& model) {
    return test::Run({test::Program("decode_lidar"),
                      capture.string(),
                      "--model",
                      model,
                      "--out",
                      (folder.path() / "sweeps").string()});
  };
  const test::Outcome wrong = run("hesai_40p");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.err,
              HasSubstr("no Pandar40P packet among 150 of 1206 bytes: another sensor? 1206 "
                        "bytes is what velodyne_vlp16"));
  EXPECT_THAT(run("vlp17").err, HasSubstr("--model must be one of velodyne_vlp16"));
}

}  // namespace
}  // namespace voqcal
