// What the picker says of places at which the lidar was unsure of the board.
#include <gtest/gtest.h>

#include "core/sampling/picker_streams.hpp"
#include "core/sampling/sample_picker.hpp"

namespace voqcal {
namespace {

using test::Append;
using test::Board;
using test::Camera;
using test::kFrameUs;
using test::Lidar;

LidarSighting Unsure(std::int64_t frame, double x_m) {
  LidarSighting sighting = Lidar(frame, x_m);
  sighting.unsure = {*sighting.board};
  sighting.board.reset();
  sighting.miss = "joined";
  return sighting;
}

std::vector<UnsureStop> StopsOf(const std::vector<PickerDecision>& decisions) {
  std::vector<UnsureStop> stops;
  for (const PickerDecision& decision : decisions) {
    if (decision.unsure) stops.push_back(*decision.unsure);
  }
  return stops;
}

TEST(SamplePicker, TellsOfAStopThatTheLidarWasUnsureOf) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 5; ++frame) {
    Append(picker.Add(Unsure(frame, 0.5)), &decisions);
    Append(picker.Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  const std::vector<UnsureStop> stops = StopsOf(decisions);
  ASSERT_EQ(stops.size(), 1u);  // once, however long it lasts
  ASSERT_EQ(stops[0].lidar.size(), 3u);
  EXPECT_EQ(stops[0].lidar[0].unsure.size(), 1u);
  EXPECT_EQ(stops[0].camera[2].utime, 2 * kFrameUs);
}

TEST(SamplePicker, TakesAStopOnceItsBoardIsFound) {
  SamplePicker picker(Board(), {});
  UnsureStop stop;
  for (int frame = 0; frame < 3; ++frame) {
    stop.lidar.push_back(Lidar(frame, 0.5));
    stop.camera.push_back(Camera(frame, 0.5));
  }
  const PickerDecision first = picker.TakeStop(stop);
  ASSERT_TRUE(first.accepted);
  EXPECT_EQ(first.accepted->num_frames, 3);
  EXPECT_EQ(picker.TakeStop(stop).reason, "pose is not new");
}

// The board rests at 0.5 m again, unseen by the lidar.
std::size_t NumStopsAgain(std::int64_t first_frame, SamplePicker* picker) {
  std::vector<PickerDecision> decisions;
  for (std::int64_t frame = first_frame; frame < first_frame + 3; ++frame) {
    Append(picker->Add(Unsure(frame, 0.5)), &decisions);
    Append(picker->Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker->Flush(), &decisions);
  return StopsOf(decisions).size();
}

TEST(SamplePicker, TellsOfAStopOnceThoughASampleIsDiscarded) {
  SamplePicker picker(Board(), {});
  EXPECT_EQ(NumStopsAgain(0, &picker), 1u);
  picker.SetKnown({});  // another place's sample was discarded: the stop is still kept
  EXPECT_EQ(NumStopsAgain(3, &picker), 0u);
  picker.StartAnew();
  EXPECT_EQ(NumStopsAgain(6, &picker), 1u);
}

TEST(SamplePicker, TellsOfAStopAgainOnceItsOwnSampleIsDiscarded) {
  SamplePicker picker(Board(), {});
  UnsureStop stop;
  for (int frame = 0; frame < 3; ++frame) {
    stop.lidar.push_back(Lidar(frame, 0.5));
    stop.camera.push_back(Camera(frame, 0.5));
  }
  EXPECT_EQ(NumStopsAgain(0, &picker), 1u);
  ASSERT_TRUE(picker.TakeStop(stop).accepted);
  picker.SetKnown({});
  EXPECT_EQ(NumStopsAgain(3, &picker), 1u);
}

TEST(SamplePicker, TellsOfNoStopWhileTheCameraSeesTheBoardMove) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 6; ++frame) {
    Append(picker.Add(Unsure(frame, 0.1 * frame)), &decisions);
    Append(picker.Add(Camera(frame, 0.1 * frame)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  EXPECT_TRUE(StopsOf(decisions).empty());
}

}  // namespace
}  // namespace voqcal
