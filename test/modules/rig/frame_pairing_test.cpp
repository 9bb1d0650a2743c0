#include "rig/frame_pairing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

using Names = std::vector<std::string>;

FrameFolder FolderOf(const test::TemporaryFolder& folder, const Names& names, bool is_by_order) {
  for (const std::string& name : names) folder.Write(name, "");
  FrameOptions options;
  options.folder = folder.path();
  options.is_by_order = is_by_order;
  return {options, {".pcd", ".png"}};
}

std::string Pairing(const Names& clouds, const Names& images, bool is_by_order = false) {
  const test::TemporaryFolder cloud_folder;
  const test::TemporaryFolder image_folder;
  return PairingOf(FolderOf(cloud_folder, clouds, is_by_order),
                   FolderOf(image_folder, images, is_by_order),
                   0.06);
}

std::string Refusal(const Names& clouds, const Names& images) {
  return test::ErrorOf([&] { Pairing(clouds, images); });
}

TEST(FrameTime, ReadsSecondsToNanoseconds) {
  EXPECT_EQ(FrameTime("1700000001.png"), 1700000001000000);
  EXPECT_EQ(FrameTime("1700000001.25.png"), 1700000001250000);
  EXPECT_EQ(FrameTime("cam_1700000001_250000000.png"), 1700000001250000);
  EXPECT_EQ(FrameTime("1700000001250.png"), 1700000001250000);
  EXPECT_EQ(FrameTime("1700000001250000.png"), 1700000001250000);
  EXPECT_EQ(FrameTime("1700000001250000000.png"), 1700000001250000);
  EXPECT_EQ(FrameTime("pose7.png"), std::nullopt);
  EXPECT_EQ(FrameTime("20231114_221321.png"), std::nullopt);
  EXPECT_EQ(FrameTime("x.png"), std::nullopt);
}

TEST(PairingOf, GoesByNumbersOrTimes) {
  EXPECT_EQ(Pairing({"1.pcd", "2.pcd", "10.pcd"}, {"pose2.png", "pose10.png", "pose11.png"}),
            "2 pairs, by the numbers of their names");
  EXPECT_EQ(Pairing({"1700000001.10.pcd", "1700000002.10.pcd"},
                    {"1700000001.150000.png", "1700000002.150000.png"}),
            "2 pairs, by the times of their names");
  EXPECT_EQ(Pairing({"a.pcd", "b.pcd"}, {"left.png", "right.png"}), "2 pairs, by their order");
  EXPECT_EQ(Pairing({"1.pcd", "._1.pcd"}, {"1.png", ".2.png"}),
            "1 pairs, by the numbers of their names");
}

TEST(PairingOf, RefusesWhatIsDoubtful) {
  EXPECT_THAT(Refusal({"1.pcd", "2.pcd"}, {"1700000001.25.png", "1700000002.25.png"}),
              HasSubstr("the names of the clouds have numbers, those of the images times"));
  EXPECT_THAT(Refusal({"1.pcd", "2.pcd", "3.pcd"}, {"0.png", "1.png", "2.png"}),
              HasSubstr("shifted against each other (3 clouds from 1.pcd, 3 images from 0.png)"));
  EXPECT_THAT(Refusal({"1.pcd", "2.pcd"}, {"5.png", "9.png"}),
              HasSubstr("no cloud has the number"));
  EXPECT_THAT(Refusal({"a.pcd", "b.pcd"}, {"a.png"}), HasSubstr("there are not as many"));
  EXPECT_THAT(Refusal({"1.pcd", "2.pcd"}, {"0.png", "1.png"}), HasSubstr("--pair order"));
}

TEST(PairingOf, GoesByOrderIfAsked) {
  EXPECT_EQ(Pairing({"1.pcd", "2.pcd"}, {"0.png", "1.png"}, true), "2 pairs, by their order");
}

}  // namespace
}  // namespace voqcal
