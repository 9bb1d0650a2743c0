#include "files/point_cloud_file.hpp"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "support/real_data.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// x y z intensity as float, ring as 16 bits: 18 bytes a point.
std::string PcdHeader(int num_points, const std::string& data) {
  const std::string n = std::to_string(num_points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity ring\n"
         "SIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH " +
         n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

template <typename Value>
std::string Bytes(Value value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

std::string BinaryPoint(float x, float y, float z, float intensity, std::uint16_t ring) {
  return Bytes(x) + Bytes(y) + Bytes(z) + Bytes(intensity) + Bytes(ring);
}

PointCloud Read(const std::string& name, const std::string& contents) {
  const test::TemporaryFolder folder;
  return ReadPointCloud(folder.Write(name, contents));
}

std::string ReadError(const std::string& name, const std::string& contents) {
  const std::string error = test::ErrorOf([&] { Read(name, contents); });
  const std::size_t at = error.find(name);
  return at == std::string::npos ? error : error.substr(at);
}

void ExpectTwoPoints(const PointCloud& cloud) {
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_TRUE(cloud.has_intensity);
  EXPECT_TRUE(cloud.has_ring);
  EXPECT_FALSE(cloud.has_time);
  EXPECT_EQ(cloud.points[0].position_m, Eigen::Vector3f(1.5F, -2, 3));
  EXPECT_EQ(cloud.points[1].intensity, 42);
  EXPECT_EQ(cloud.points[1].ring, 15);
  EXPECT_TRUE(std::isnan(cloud.points[1].position_m.x()));
}

TEST(ReadPointCloud, ReadsPcdText) {
  ExpectTwoPoints(Read("a.pcd", PcdHeader(2, "ascii") + "1.5 -2 3 7 0\nnan 0 0 42 15\n"));
}

TEST(ReadPointCloud, ReadsPcdBinary) {
  ExpectTwoPoints(Read("a.pcd",
                       PcdHeader(2, "binary") + BinaryPoint(1.5F, -2, 3, 7, 0) +
                           BinaryPoint(std::nanf(""), 0, 0, 42, 15)));
}

/// LZF of bytes that it does not shorten: runs of up to 32, each after its length less one.
std::string Lzf(const std::string& bytes) {
  std::string packed;
  for (std::size_t i = 0; i < bytes.size(); i += 32) {
    const std::string run = bytes.substr(i, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  return packed;
}

/// The same two points, field by field as this format stores them.
std::string CompressedBody() {
  const std::string fields = Bytes(1.5F) + Bytes(std::nanf("")) + Bytes(-2.0F) + Bytes(0.0F) +
                             Bytes(3.0F) + Bytes(0.0F) + Bytes(7.0F) + Bytes(42.0F) +
                             Bytes(std::uint16_t{0}) + Bytes(std::uint16_t{15});
  const std::string packed = Lzf(fields);
  return Bytes(static_cast<std::uint32_t>(packed.size())) +
         Bytes(static_cast<std::uint32_t>(fields.size())) + packed;
}

TEST(ReadPointCloud, ReadsPcdCompressed) {
  ExpectTwoPoints(Read("a.pcd", PcdHeader(2, "binary_compressed") + CompressedBody()));
}

std::string PlyHeader(int num_points, const std::string& format) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(num_points) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
         "property ushort ring\nend_header\n";
}

TEST(ReadPointCloud, ReadsPlyTextAndBinary) {
  ExpectTwoPoints(Read("a.ply", PlyHeader(2, "ascii") + "1.5 -2 3 7 0\nnan 0 0 42 15\n"));
  ExpectTwoPoints(Read("a.ply",
                       PlyHeader(2, "binary_little_endian") + BinaryPoint(1.5F, -2, 3, 7, 0) +
                           BinaryPoint(std::nanf(""), 0, 0, 42, 15)));
}

TEST(ReadPointCloud, ReadsBigEndianPlyAndLeavesFieldsOfSeveralNumbers) {
  const auto swapped = [](std::string bytes) { return std::string(bytes.rbegin(), bytes.rend()); };
  const PointCloud ply =
      Read("a.ply",
           PlyHeader(1, "binary_big_endian") + swapped(Bytes(1.5F)) + swapped(Bytes(-2.0F)) +
               swapped(Bytes(3.0F)) + swapped(Bytes(7.0F)) + swapped(Bytes(std::uint16_t{9})));
  EXPECT_EQ(ply.points.at(0).position_m, Eigen::Vector3f(1.5F, -2, 3));
  EXPECT_EQ(ply.points.at(0).ring, 9);
  const std::string header =
      "FIELDS x normal y z\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 3 1 1\nWIDTH 1\nHEIGHT 1\n"
      "POINTS 1\nDATA ";
  const std::string numbers =
      Bytes(1.0F) + Bytes(9.0F) + Bytes(9.0F) + Bytes(9.0F) + Bytes(2.0F) + Bytes(3.0F);
  EXPECT_EQ(Read("a.pcd", header + "ascii\n1 9 9 9 2 3\n").points.at(0).position_m,
            Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(Read("a.pcd", header + "binary\n" + numbers).points.at(0).position_m,
            Eigen::Vector3f(1, 2, 3));
}

TEST(ReadPointCloud, RefusesTypesThatAreNone) {
  EXPECT_THAT(ReadError("a.pcd",
                        "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
                        "DATA ascii\n1 2 3\n"),
              EndsWith("the type of field z is not known: F of 3 bytes"));
  EXPECT_THAT(ReadError("a.pcd",
                        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 2000000000\nWIDTH 1\n"
                        "HEIGHT 1\nPOINTS 1\nDATA binary\n"),
              EndsWith("the COUNT of field z is too large"));
}

TEST(ReadPointCloud, TellsWhatTheFileDoesNotCarry) {
  const PointCloud cloud = Read("a.pcd",
                                "FIELDS x y z time\nSIZE 8 8 8 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\n"
                                "POINTS 1\nDATA ascii\n1 2 3 0.05\n");
  EXPECT_FALSE(cloud.has_intensity);
  EXPECT_FALSE(cloud.has_ring);
  EXPECT_TRUE(cloud.has_time);
  EXPECT_EQ(cloud.points.at(0).time_s, 0.05F);
  EXPECT_EQ(cloud.points.at(0).position_m.z(), 3);
}

TEST(ReadPointCloud, KnowsOtherProgramsNamesAndUnits) {
  const PointCloud cloud =
      Read("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 2\nproperty float X\nproperty float Y\n"
           "property float Z\nproperty float scalar_Intensity\nproperty uint t\nend_header\n"
           "1 2 3 50 0\n4 5 6 60 50000000\n");
  EXPECT_TRUE(cloud.has_intensity);
  EXPECT_EQ(cloud.points.at(1).position_m, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.points.at(1).intensity, 60);
  EXPECT_FLOAT_EQ(cloud.points.at(1).time_s, 0.05F);
}

TEST(ReadPointCloud, RefusesFilesThatAreCutShort) {
  const std::string point = BinaryPoint(1, 2, 3, 4, 5);
  EXPECT_EQ(ReadError("a.pcd", PcdHeader(3, "ascii") + "1 2 3 4 5\n"),
            "a.pcd:12: is cut short: has 1 of 3 points");
  EXPECT_EQ(ReadError("a.pcd", PcdHeader(1000000, "binary") + point),
            "a.pcd:11: is cut short: the header tells of 18000000 bytes of points, 18 follow");
  EXPECT_EQ(ReadError("a.ply", PlyHeader(3, "binary_little_endian") + point),
            "a.ply:9: is cut short: the header tells of 54 bytes of points, 18 follow");
  EXPECT_THAT(ReadError("a.ply", PlyHeader(3, "ascii") + "1 2 3 4 5"),
              HasSubstr("has 1 of 3 points"));
  const std::string body = CompressedBody();
  EXPECT_THAT(ReadError("a.pcd", PcdHeader(2, "binary_compressed") + body.substr(0, 20)),
              HasSubstr("is cut short"));
  EXPECT_THAT(ReadError("a.pcd", PcdHeader(90000000, "binary_compressed") + body),
              HasSubstr("must unpack"));
}

// Every length of a good file: an error or, where only trailing bytes are missing, the cloud; no
// crash.
TEST(ReadPointCloud, SurvivesEveryTruncation) {
  for (const std::string& whole : {PcdHeader(2, "binary_compressed") + CompressedBody(),
                                   PcdHeader(1, "binary") + BinaryPoint(1, 2, 3, 4, 5)}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_NE(ReadError("a.pcd", whole.substr(0, length)), "") << length;
    }
  }
  const std::string ply = PlyHeader(1, "binary_little_endian") + BinaryPoint(1, 2, 3, 4, 5);
  for (std::size_t length = 0; length < ply.size(); ++length) {
    EXPECT_NE(ReadError("a.ply", ply.substr(0, length)), "") << length;
  }
}

TEST(ReadPointCloud, RefusesDamagedCompression) {
  std::string body = CompressedBody();
  body[8] = '\x7f';  // a back reference before the beginning
  EXPECT_THAT(ReadError("a.pcd", PcdHeader(2, "binary_compressed") + body),
              HasSubstr("cannot be read as a cloud"));
}

TEST(ReadPointCloud, RefusesWhatIsNoCloud) {
  EXPECT_EQ(ReadError("a.pcd", ""), "a.pcd: is empty");
  EXPECT_EQ(ReadError("a.ply", ""), "a.ply: is empty");
  EXPECT_THAT(ReadError("a.pcd", "hello\n"), HasSubstr("is no PCD file"));
  EXPECT_THAT(ReadError("a.pcd", "FIELDS x y z\nSIZE 4 4\nDATA ascii\n"), HasSubstr("SIZE"));
  EXPECT_THAT(ReadError("a.ply", "hello\n"), HasSubstr("is no PLY file"));
  EXPECT_THAT(ReadError("a.xyz", "1 2 3\n"), EndsWith("must be a .pcd or .ply file"));
  EXPECT_THAT(ReadError("a.pcd", PcdHeader(0, "ascii")), EndsWith("has no points"));
  EXPECT_EQ(ReadError("a.pcd", PcdHeader(1, "ascii") + "1 2 abc 4 5\n"),
            "a.pcd:12: must be numbers, has \"abc\"");
  EXPECT_EQ(ReadError("a.pcd", PcdHeader(1, "ascii") + "1 2 3\n"),
            "a.pcd:12: has 3 numbers, must have 5");
  EXPECT_THAT(ReadError("a.pcd",
                        "FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
                        "DATA ascii\n1 2\n"),
              EndsWith("must have the fields x, y and z"));
  EXPECT_THAT(test::ErrorOf([] { ReadPointCloud("/none.pcd"); }),
              EndsWith("none.pcd: cannot be read: No such file or directory"));
}

TEST(ReadPointCloud, ReadsARealSweep) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data beside the sources";
  const PointCloud cloud = ReadPointCloud(*data / "acfr-vlp16/pcd/pose2_full.pcd");
  ASSERT_EQ(cloud.points.size(), 24163U);
  EXPECT_TRUE(cloud.has_intensity && cloud.has_ring && !cloud.has_time);
  EXPECT_EQ(cloud.points[0].position_m, Eigen::Vector3f(-1.2484956F, 2.2013252F, -0.67810601F));
  for (const LidarPoint& point : cloud.points) ASSERT_LT(point.ring, 16);
}

}  // namespace
}  // namespace voqcal
