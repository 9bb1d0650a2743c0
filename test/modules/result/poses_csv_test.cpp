#include "result/poses_csv.hpp"

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "support/real_data.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

BoardSpec Board() {
  BoardSpec board;
  board.width_m = 0.6;
  board.height_m = 0.8;
  return board;
}

/// How one sensor's corners are listed: BoardSpec's order turned by `first`, or backwards from
/// there.
struct Listing {
  int first = 0;
  bool is_backwards = false;
  bool has_normal_away = false;
};

Eigen::Isometry3d T_sensor_board() {  // NOLINT: named for its frames
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.2, 2.9, 0.4});  // the board's z towards the sensor
  T.translation() = Eigen::Vector3d(0.1, -0.2, 2.0);
  return T;
}

void AppendLine(const Eigen::Vector3d& v, std::string* text) {
  std::ostringstream line;
  line.precision(9);
  line << v.x() << ',' << v.y() << ',' << v.z() << '\n';
  *text += line.str();
}

void AppendPose(const Listing& listing, std::string* text) {
  const BoardPose pose = PoseFromTransform(T_sensor_board(), Board());
  AppendLine(pose.centre_m * 1000, text);
  AppendLine(listing.has_normal_away ? Eigen::Vector3d(-pose.normal) : pose.normal, text);
  for (int i = 0; i < 4; ++i) {
    const int corner = (listing.first + (listing.is_backwards ? 4 - i : i)) % 4;
    AppendLine(pose.corners_m[static_cast<std::size_t>(corner)] * 1000, text);
  }
}

/// One pose of the file: 19 lines.
std::string Csv(const Listing& camera, const Listing& lidar, int number = 7) {
  std::string text;
  AppendPose(camera, &text);
  AppendPose(lidar, &text);
  for (int i = 0; i < 4; ++i) text += "1,2,0\n";
  return text + "2.0,0,0\n0.0015,0,0\n" + std::to_string(number) + ",0,0\n";
}

PosesCsv Read(const std::string& text, const BoardSpec& board = Board()) {
  const test::TemporaryFolder folder;
  return ReadPosesCsv(folder.Write("poses.csv", text), board);
}

std::string ReadError(const std::string& text) {
  const std::string error = test::ErrorOf([&] { Read(text); });
  const std::size_t at = error.find("poses.csv");
  return at == std::string::npos ? error : error.substr(at);
}

/// Largest distance between corners, up to the half-turn that the file leaves open. Nine digits of
/// millimetres: 1e-8 m.
double CornerErrorM(const BoardPose& pose) {
  const BoardPose truth = PoseFromTransform(T_sensor_board(), Board());
  double errors_m[2] = {0, 0};
  for (int turn = 0; turn < 2; ++turn) {
    const BoardPose turned = turn == 0 ? pose : TurnedByHalf(pose);
    for (std::size_t i = 0; i < 4; ++i) {
      errors_m[turn] = std::max(errors_m[turn], (turned.corners_m[i] - truth.corners_m[i]).norm());
    }
  }
  return std::min(errors_m[0], errors_m[1]);
}

TEST(ReadPosesCsv, PutsCornersInOurOrderHoweverTheyAreListed) {
  ASSERT_LT(T_sensor_board().linear().col(2).dot(T_sensor_board().translation()), 0);
  for (int first = 0; first < 4; ++first) {
    for (const bool is_backwards : {false, true}) {
      const PosesCsv poses =
          Read(Csv({first, is_backwards, false}, {(first + 1) % 4, !is_backwards, true}));
      ASSERT_EQ(poses.samples.size(), 1U);
      const BoardSample& sample = poses.samples[0];
      EXPECT_LT(CornerErrorM(sample.camera.pose), 1e-7) << first << is_backwards;
      EXPECT_LT(CornerErrorM(sample.lidar.pose), 1e-7) << first << is_backwards;
      EXPECT_LT(sample.lidar.pose.normal.dot(sample.lidar.pose.centre_m), 0);
      EXPECT_NEAR(sample.lidar.edge_lengths_m[0], 0.6, 1e-7);
      EXPECT_NEAR(sample.lidar.edge_lengths_m[3], 0.8, 1e-7);
    }
  }
}

TEST(ReadPosesCsv, PutsTheWidthFirstEvenIfItIsTheLongSide) {
  BoardSpec board = Board();
  std::swap(board.width_m, board.height_m);
  const PosesCsv poses = Read(Csv({}, {}), board);
  EXPECT_NEAR(poses.samples[0].lidar.edge_lengths_m[0], 0.8, 1e-7);
}

TEST(ReadPosesCsv, SaysWhatItTurned) {
  EXPECT_TRUE(Read(Csv({}, {})).remarks.empty());
  EXPECT_THAT(Read(Csv({1, true, false}, {0, false, true})).remarks,
              ::testing::ElementsAre("1 poses: the camera's corners ran clockwise",
                                     "1 poses: the lidar's normal pointed away from it"));
}

TEST(ReadPosesCsv, NamesFileLineWantedAndThere) {
  const std::string good = Csv({}, {});
  std::string bad = good;
  bad.replace(0, bad.find('\n'), "1,2");
  EXPECT_EQ(ReadError(bad),
            "poses.csv:1: wanted the camera centre, three numbers, there is \"1,2\"");
  bad = good;
  bad.replace(0, bad.find(','), "abc");
  EXPECT_THAT(ReadError(bad),
              HasSubstr("poses.csv:1: wanted the camera centre, three numbers, there is \"abc,"));
  bad.replace(0, 3, "nan");
  EXPECT_THAT(ReadError(bad), HasSubstr("poses.csv:1: wanted the camera centre"));
  EXPECT_THAT(ReadError(good.substr(0, good.size() - 6)),
              EndsWith(":19: wanted the pose number, three numbers, there is the end of the file"));
  EXPECT_THAT(
      ReadError(good + "1,2,3\n"),
      EndsWith(":21: wanted the camera normal, three numbers, there is the end of the file"));
  EXPECT_EQ(ReadError(""), "poses.csv: has no pose, is empty");
}

TEST(ReadPosesCsv, RefusesPosesThatCannotBe) {
  const std::string good = Csv({}, {});
  EXPECT_EQ(ReadError(good + good),
            "poses.csv:38: wanted the pose number, one that is not given twice, there is 7,0,0");
  EXPECT_THAT(ReadError(Csv({}, {}, 0)),
              HasSubstr("poses.csv:19: wanted the pose number, a whole number"));
  std::string bad = good;
  const std::size_t second = bad.find('\n') + 1;
  bad.replace(second, bad.find('\n', second) - second, "0,0,0");
  EXPECT_EQ(ReadError(bad),
            "poses.csv:2: wanted the camera normal, a direction of length 1, there is 0,0,0");
}

TEST(ReadPosesCsv, ReadsTheRealFile) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data beside the sources";
  BoardSpec board;
  board.width_m = 0.61;
  board.height_m = 0.85;
  const PosesCsv poses = ReadPosesCsv(*data / "acfr-vlp16/poses.csv", board);
  ASSERT_EQ(poses.samples.size(), 30U);
  EXPECT_EQ(poses.samples[2].id, 3);
  EXPECT_EQ(poses.samples[3].id, 5);  // the file keeps its pose numbers
  EXPECT_EQ(poses.samples[3].utime, 5'000'000);
  EXPECT_EQ(poses.metres_per_pixel[0], 0.00142094);
  for (const BoardSample& sample : poses.samples) {
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    // The camera's corners come from the board's true size, written with 6 digits of millimetres.
    const BoardPose ideal = PoseFromTransform(T_camera_board, board);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT((sample.camera.pose.corners_m[i] - ideal.corners_m[i]).norm(), 2e-5) << sample.id;
    }
    // The lidar's were measured: within 5 cm an edge on this data.
    EXPECT_NEAR(sample.lidar.edge_lengths_m[0], 0.61, 0.05) << sample.id;
    EXPECT_NEAR(sample.lidar.edge_lengths_m[1], 0.85, 0.05) << sample.id;
    EXPECT_LT(sample.lidar.pose.normal.dot(sample.lidar.pose.centre_m), 0) << sample.id;
  }
  EXPECT_THAT(poses.remarks,
              ::testing::ElementsAre("30 poses: the camera's corners ran clockwise"));
}

}  // namespace
}  // namespace voqcal
