#include "messaging/convert_board.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "messaging/bus.hpp"
#include "messaging/encode.hpp"

namespace voqcal {
namespace {

/// `count` numbers with full mantissas, no two alike: whatever is swapped or rounded shows.
class Numbers {
 public:
  double Next() { return std::sqrt(static_cast<double>(++num_)) / 7.0; }
  Eigen::Vector3d Vector() {
    const double x = Next();
    const double y = Next();
    return {x, y, Next()};
  }

 private:
  int num_ = 1;
};

BoardPose Pose(Numbers* numbers) {
  BoardPose pose;
  pose.centre_m = numbers->Vector();
  pose.normal = numbers->Vector().normalized();
  for (auto& corner_m : pose.corners_m) corner_m = numbers->Vector();
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) pose.covariance(row, column) = numbers->Next();
  }
  return pose;
}

LidarBoard Lidar(Numbers* numbers) {
  LidarBoard board;
  board.pose = Pose(numbers);
  for (double& length_m : board.edge_lengths_m) length_m = numbers->Next();
  board.sides = {SideView::kJoined, SideView::kMeasured, SideView::kGap, SideView::kCutOff};
  board.plane_rms_m = numbers->Next();
  board.num_beams = 9;
  board.log_likelihood = -numbers->Next();
  board.points_lidar_m.has_intensity = true;
  board.points_lidar_m.has_ring = true;
  for (int i = 0; i < 4; ++i) {
    LidarPoint point;
    point.position_m = numbers->Vector().cast<float>();
    point.intensity = static_cast<float>(numbers->Next());
    point.ring = static_cast<std::uint16_t>(65535 - i);
    board.points_lidar_m.points.push_back(point);
  }
  return board;
}

CameraBoard Camera(Numbers* numbers) {
  CameraBoard board;
  board.pose = Pose(numbers);
  board.reprojection_rms_px = numbers->Next();
  for (int i = 0; i < 6; ++i) board.corners_px.push_back(numbers->Vector().head<2>());
  board.warnings = {{"blurred", "edge width 4.1 px, at most 3"}, {"cut off", "12 %"}};
  return board;
}

BoardSample Sample(std::int64_t id) {
  Numbers numbers;
  BoardSample sample;
  sample.id = id;
  sample.utime = 1'000'000 * id + 1;
  sample.num_frames = 3;
  sample.lidar = Lidar(&numbers);
  sample.camera = Camera(&numbers);
  return sample;
}

void ExpectSame(const BoardPose& a, const BoardPose& b) {
  EXPECT_EQ(a.centre_m, b.centre_m);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.corners_m, b.corners_m);
  EXPECT_EQ(a.covariance, b.covariance);
}

void ExpectSame(const LidarBoard& a, const LidarBoard& b) {
  ExpectSame(a.pose, b.pose);
  EXPECT_EQ(a.sides, b.sides);
  EXPECT_EQ(a.edge_lengths_m, b.edge_lengths_m);
  EXPECT_EQ(a.plane_rms_m, b.plane_rms_m);
  EXPECT_EQ(a.num_beams, b.num_beams);
  EXPECT_EQ(a.log_likelihood, b.log_likelihood);
  EXPECT_EQ(a.points_lidar_m.has_intensity, b.points_lidar_m.has_intensity);
  EXPECT_EQ(a.points_lidar_m.has_ring, b.points_lidar_m.has_ring);
  ASSERT_EQ(a.points_lidar_m.points.size(), b.points_lidar_m.points.size());
  for (std::size_t i = 0; i < a.points_lidar_m.points.size(); ++i) {
    EXPECT_EQ(a.points_lidar_m.points[i].position_m, b.points_lidar_m.points[i].position_m);
    EXPECT_EQ(a.points_lidar_m.points[i].intensity, b.points_lidar_m.points[i].intensity);
    EXPECT_EQ(a.points_lidar_m.points[i].ring, b.points_lidar_m.points[i].ring);
  }
}

void ExpectSame(const CameraBoard& a, const CameraBoard& b) {
  ExpectSame(a.pose, b.pose);
  EXPECT_EQ(a.reprojection_rms_px, b.reprojection_rms_px);
  EXPECT_EQ(a.corners_px, b.corners_px);
  ASSERT_EQ(a.warnings.size(), b.warnings.size());
  for (std::size_t i = 0; i < a.warnings.size(); ++i) {
    EXPECT_EQ(a.warnings[i].reason, b.warnings[i].reason);
    EXPECT_EQ(a.warnings[i].detail, b.warnings[i].detail);
  }
}

void ExpectSame(const BoardSample& a, const BoardSample& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.utime, b.utime);
  EXPECT_EQ(a.num_frames, b.num_frames);
  ExpectSame(a.lidar, b.lidar);
  ExpectSame(a.camera, b.camera);
  ASSERT_EQ(a.runners_up.size(), b.runners_up.size());
  for (std::size_t i = 0; i < a.runners_up.size(); ++i) {
    ExpectSame(a.runners_up[i], b.runners_up[i]);
  }
}

/// The message as a reader on the other side of LCM has it.
template <typename Message>
Message OverTheWire(const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  Message decoded;
  EXPECT_EQ(DecodeMessage(bytes.data(), bytes.size(), &decoded), "");
  return decoded;
}

TEST(SamplesMessage, ComesBackExactly) {
  std::vector<BoardSample> samples = {Sample(1), Sample(7)};
  samples[1].runners_up = {samples[0].lidar, samples[1].lidar};
  const samples_t message = OverTheWire(ToMessage(samples, 12, true, "abc"));
  EXPECT_EQ(message.revision, 12);
  EXPECT_TRUE(message.is_finished);
  EXPECT_EQ(message.log_sha256, "abc");
  EXPECT_EQ(message.utime, samples[1].utime);
  const auto back = FromMessage(message);
  ASSERT_EQ(back.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) ExpectSame(back[i], samples[i]);
}

TEST(SamplesMessage, MayBeEmpty) {
  const samples_t message = ToMessage(std::vector<BoardSample>{}, 1, false, "");
  EXPECT_EQ(message.utime, 0);
  EXPECT_TRUE(FromMessage(message).empty());
}

TEST(LidarBoardMessage, GivesTheCandidatesInTheirOrder) {
  Numbers numbers;
  const std::vector<LidarBoard> candidates = {Lidar(&numbers), Lidar(&numbers)};
  const LidarSighting sighting =
      SightingFromMessage(OverTheWire(LidarBoardMessage(candidates, "", 12, 300, 3)));
  EXPECT_EQ(sighting.utime, 12);
  EXPECT_EQ(sighting.accumulated_us, 300);
  ASSERT_TRUE(sighting.board);
  ExpectSame(*sighting.board, candidates[0]);
  ASSERT_EQ(sighting.runners_up.size(), 1U);
  ExpectSame(sighting.runners_up[0], candidates[1]);
}

TEST(LidarBoardMessage, GivesTheReasonForNone) {
  const LidarSighting sighting =
      SightingFromMessage(OverTheWire(LidarBoardMessage({}, "no plane", 12, 0, 3)));
  EXPECT_FALSE(sighting.board);
  EXPECT_EQ(sighting.miss, "no plane");
}

TEST(LidarBoardMessage, KeepsThatThereAreNoRingsAndNoIntensity) {
  Numbers numbers;
  LidarBoard board = Lidar(&numbers);
  board.points_lidar_m.has_intensity = false;
  board.points_lidar_m.has_ring = false;
  for (LidarPoint& point : board.points_lidar_m.points) {
    point.intensity = 0;
    point.ring = 0;
  }
  ExpectSame(FromMessage(OverTheWire(ToMessage(board))), board);
}

TEST(LidarBoardMessage, IsRefusedIfRingsAreMissing) {
  Numbers numbers;
  lidar_candidate_t message = ToMessage(Lidar(&numbers));
  message.rings.pop_back();
  EXPECT_THROW(FromMessage(message), std::runtime_error);
}

TEST(CameraBoardMessage, ComesBackExactly) {
  Numbers numbers;
  const CameraBoard board = Camera(&numbers);
  const camera_board_t message = OverTheWire(CameraBoardMessage(board, "", "", 12, 3));
  EXPECT_EQ(message.seq, 3);
  const CameraSighting sighting = SightingFromMessage(message);
  EXPECT_EQ(sighting.utime, 12);
  ASSERT_TRUE(sighting.board);
  ExpectSame(*sighting.board, board);
}

TEST(CameraBoardMessage, GivesTheReasonForNone) {
  const CameraSighting sighting = SightingFromMessage(
      OverTheWire(CameraBoardMessage({}, "cut off", "28 of 35 corners", 12, 3)));
  EXPECT_FALSE(sighting.board);
  EXPECT_EQ(sighting.miss, "cut off");
}

}  // namespace
}  // namespace voqcal
