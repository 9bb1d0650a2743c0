#include "core/sampling/sample_picker.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/sampling/picker_streams.hpp"

namespace voqcal {
namespace {

using test::Append;
using test::Board;
using test::Camera;
using test::kFrameUs;
using test::Lidar;
using test::PoseAt;

std::vector<std::string> Outcomes(const std::vector<PickerDecision>& decisions) {
  std::vector<std::string> outcomes;
  for (const auto& decision : decisions) {
    outcomes.push_back(decision.accepted ? "accepted" : decision.reason);
  }
  return outcomes;
}

TEST(SamplePicker, AcceptsAStillBoardOnce) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 5; ++frame) {
    Append(picker.Add(Lidar(frame, 0.5)), &decisions);
    Append(picker.Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions),
              testing::ElementsAre("not yet still for long enough",
                                   "not yet still for long enough",
                                   "accepted",
                                   "pose is not new",
                                   "pose is not new"));
  EXPECT_EQ(decisions[2].accepted->num_frames, 3);
  EXPECT_EQ(decisions[2].accepted->utime, 0);
  // What all frames share does not average out: three frames claim no more than one.
  EXPECT_NEAR(decisions[2].accepted->lidar.pose.covariance(0, 0), 1.0, 1e-12);
}

TEST(SamplePicker, NamesNoFrameThatIsNotInUse) {
  SamplePicker picker(Board(), {});
  for (int frame = 0; frame < 40; ++frame) {
    std::vector<std::int64_t> lidar_in_use = picker.InUse().lidar_utimes;
    lidar_in_use.push_back(frame * kFrameUs);
    std::vector<PickerDecision> decisions;
    const double x_m = 0.5 + 0.1 * (frame / 5);  // a stop of five frames each
    LidarSighting lidar = Lidar(frame, x_m);
    if (frame / 5 % 2 == 1) lidar = {frame * kFrameUs, {}, "unsure"};
    Append(picker.Add(lidar), &decisions);
    // The camera's frames come two later.
    std::vector<std::int64_t> camera_in_use = picker.InUse().camera_utimes;
    camera_in_use.push_back((frame - 2) * kFrameUs);
    if (frame >= 2)
      Append(picker.Add(Camera(frame - 2, 0.5 + 0.1 * ((frame - 2) / 5))), &decisions);
    for (const PickerDecision& decision : decisions) {
      if (decision.accepted) {
        EXPECT_THAT(lidar_in_use, testing::Contains(decision.accepted->utime));
        EXPECT_THAT(camera_in_use, testing::Contains(decision.accepted->camera_utime));
      }
      if (!decision.unsure) continue;
      for (std::size_t i = 0; i < decision.unsure->lidar.size(); ++i) {
        EXPECT_THAT(lidar_in_use, testing::Contains(decision.unsure->lidar[i].utime));
        EXPECT_THAT(camera_in_use, testing::Contains(decision.unsure->camera[i].utime));
      }
    }
    // Three of a window, three that are followed, and those that wait.
    EXPECT_LE(picker.InUse().lidar_utimes.size(), 9U);
    EXPECT_LE(picker.InUse().camera_utimes.size(), 9U);
  }
}

TEST(SamplePicker, TakesNoBoardOfSweepsFromBeforeItCameToRest) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  // It comes to rest with the fourth frame; the lidar puts up to five sweeps together.
  for (int frame = 0; frame < 10; ++frame) {
    LidarSighting lidar = Lidar(frame, 0.5);
    lidar.accumulated_us = std::min(frame, 4) * kFrameUs;
    Append(picker.Add(lidar), &decisions);
    Append(picker.Add(Camera(frame, frame < 3 ? 0.35 + 0.05 * frame : 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  const std::vector<std::string> outcomes = Outcomes(decisions);
  // Of the still frames the first is the eighth, whose sweeps begin with the fourth.
  const auto accepted = std::find(outcomes.begin(), outcomes.end(), "accepted");
  ASSERT_NE(accepted, outcomes.end());
  EXPECT_EQ(accepted - outcomes.begin(), 9);
  EXPECT_EQ(decisions[9].accepted->utime, 7 * kFrameUs);
}

const Eigen::Vector2d kUnseenPx = Eigen::Vector2d::Constant(std::nan(""));

// Three frames of a board that the camera sees move, while the lidar does not.
std::vector<std::string> OutcomesOfCorners(
    const std::vector<std::vector<Eigen::Vector2d>>& corners_px_of_frames) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  std::int64_t frame = 0;
  for (const auto& corners_px : corners_px_of_frames) {
    CameraSighting camera = Camera(frame, 0.5);
    camera.board->corners_px = corners_px;
    Append(picker.Add(Lidar(frame++, 0.5)), &decisions);
    Append(picker.Add(camera), &decisions);
  }
  Append(picker.Flush(), &decisions);
  return Outcomes(decisions);
}

TEST(SamplePicker, SeesAPartlySeenBoardMove) {
  EXPECT_THAT(
      OutcomesOfCorners({{{10, 10}, {60, 10}, kUnseenPx, kUnseenPx},
                         {{20, 10}, {70, 10}, kUnseenPx, kUnseenPx},
                         {{30, 10}, {80, 10}, kUnseenPx, kUnseenPx}}),
      testing::ElementsAre("not yet still for long enough", "board is moving", "board is moving"));
  // No corner of the one is a corner of the other: nothing says that it rests.
  EXPECT_THAT(
      OutcomesOfCorners({{{10, 10}, {60, 10}, kUnseenPx, kUnseenPx},
                         {kUnseenPx, kUnseenPx, {60, 90}, {10, 90}},
                         {{10, 10}, {60, 10}, kUnseenPx, kUnseenPx}}),
      testing::ElementsAre("not yet still for long enough", "board is moving", "board is moving"));
}

TEST(SamplePicker, TakesAPartlySeenBoardThatRests) {
  EXPECT_THAT(OutcomesOfCorners({{{10, 10}, {60, 10}, kUnseenPx, {10, 90}},
                                 {{10, 10}, {60, 10}, kUnseenPx, kUnseenPx},
                                 {{10, 10}, kUnseenPx, {60, 90}, {10, 90}}}),
              testing::ElementsAre(
                  "not yet still for long enough", "not yet still for long enough", "accepted"));
}

TEST(SamplePicker, AnswersTheSameWhateverTheArrivalOrderOfTheStreams) {
  const auto run = [](int camera_lag) {
    SamplePicker picker(Board(), {});
    std::vector<PickerDecision> decisions;
    for (int frame = 0; frame < 40 + camera_lag; ++frame) {
      const auto x_m = [](int f) { return 0.5 + 0.1 * (f / 5); };
      if (frame < 40) Append(picker.Add(Lidar(frame, x_m(frame))), &decisions);
      const int late = frame - camera_lag;
      if (late >= 0) Append(picker.Add(Camera(late, x_m(late))), &decisions);
    }
    Append(picker.Flush(), &decisions);
    return Outcomes(decisions);
  };
  const auto in_step = run(0);
  EXPECT_EQ(std::count(in_step.begin(), in_step.end(), "accepted"), 8);
  EXPECT_EQ(run(7), in_step);
  EXPECT_EQ(run(40), in_step);
}

TEST(SamplePicker, SaysWhyAPairGivesNoSample) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker picker(Board(), options);
  std::vector<PickerDecision> decisions;
  const auto add = [&](const LidarSighting& lidar, const CameraSighting& camera) {
    Append(picker.Add(lidar), &decisions);
    Append(picker.Add(camera), &decisions);
  };
  add({0, {}, "no plane"}, Camera(0, 0.5));
  add(Lidar(1, 0.5), {kFrameUs, {}, "no chessboard"});
  auto wrong_size = Lidar(2, 0.5);
  wrong_size.board->edge_lengths_m[1] = 1.0;
  add(wrong_size, Camera(2, 0.5));
  Append(picker.Add(Lidar(3, 0.5)), &decisions);  // without a camera frame
  add(Lidar(4, 0.5), Camera(4, 0.5));
  Append(picker.Add(Lidar(4, 0.5)), &decisions);
  Append(picker.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions),
              testing::ElementsAre("lidar: no plane",
                                   "camera: no chessboard",
                                   "wrong board size",
                                   "no camera frame at that time",
                                   "lidar frame out of order",
                                   "accepted"));
}

TEST(SamplePicker, GoesOnWhereADriverIsStartedAgainInThePast) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker picker(Board(), options);
  std::vector<PickerDecision> decisions;
  const auto add = [&](int frame, double x_m) {
    Append(picker.Add(Lidar(frame, x_m)), &decisions);
    Append(picker.Add(Camera(frame, x_m)), &decisions);
  };
  // Frames are 0.1 s apart: back by 9.9 s, while the last pair before still waits.
  add(100, 0.0);
  add(1, 0.5);
  add(2, 1.0);
  Append(picker.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions), testing::ElementsAre("accepted", "accepted", "accepted"));
}

// The camera's detector lags: its last sightings come after the operator's "reset".
TEST(SamplePicker, MakesNoSampleOfWhatWaitedWhenItStartsAnew) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 5; ++frame) Append(picker.Add(Lidar(frame, 0.5)), &decisions);
  picker.StartAnew();
  for (int frame = 0; frame < 5; ++frame) Append(picker.Add(Camera(frame, 0.5)), &decisions);
  Append(picker.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions), testing::Each("no lidar frame at that time"));
  decisions.clear();
  for (int frame = 5; frame < 8; ++frame) {
    Append(picker.Add(Lidar(frame, 0.5)), &decisions);
    Append(picker.Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions), testing::Contains("accepted"));
}

TEST(SamplePicker, AccountsForCameraFramesWithoutALidarFrame) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker picker(Board(), options);
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 4; ++frame) Append(picker.Add(Camera(frame, 0.5)), &decisions);
  Append(picker.Add(Lidar(2, 0.5)), &decisions);
  Append(picker.Flush(), &decisions);
  // Frames 0 and 1 before the sample, 3 after it: each has its reason.
  EXPECT_THAT(Outcomes(decisions),
              testing::ElementsAre("no lidar frame at that time",
                                   "no lidar frame at that time",
                                   "accepted",
                                   "no lidar frame at that time"));
}

TEST(SamplePicker, SaysWhichEdgeIsWrong) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker picker(Board(), options);
  auto wrong_size = Lidar(0, 0.5);
  wrong_size.board->edge_lengths_m[1] = 1.0;
  picker.Add(wrong_size);
  picker.Add(Camera(0, 0.5));
  const auto decisions = picker.Flush();
  ASSERT_EQ(decisions.size(), 1U);
  EXPECT_EQ(decisions[0].detail, "the lidar measures an edge of 0.800 m as 1.000 m");
}

TEST(SamplePicker, RejectsAMovingBoardAndTakesItOnRequest) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 6; ++frame) {
    if (frame == 4) picker.RequestCapture();
    Append(picker.Add(Lidar(frame, 0.1 * frame)), &decisions);
    Append(picker.Add(Camera(frame, 0.1 * frame)), &decisions);
  }
  const auto outcomes = Outcomes(decisions);
  EXPECT_EQ(std::count(outcomes.begin(), outcomes.end(), "board is moving"), 2);
  EXPECT_EQ(std::count(outcomes.begin(), outcomes.end(), "accepted"), 1);
}

// A second board that rests at 5 m, as the candidate that is ranked first.
LidarSighting BehindASecondBoard(LidarSighting sighting) {
  sighting.runners_up = {*sighting.board};
  sighting.board->pose = PoseFromTransform(PoseAt(5.0), Board());
  return sighting;
}

LidarSighting BeforeASecondBoard(const LidarSighting& sighting) {
  LidarSighting turned = BehindASecondBoard(sighting);
  std::swap(*turned.board, turned.runners_up[0]);
  return turned;
}

TEST(SamplePicker, KeepsBothOfTwoRestingCandidatesWhoseRanksChange) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 3; ++frame) {
    LidarSighting sighting = BeforeASecondBoard(Lidar(frame, 0.5));
    sighting.board->log_likelihood = -1.0;
    sighting.runners_up[0].log_likelihood = -2.0;
    if (frame == 1) {  // once it is the other way round
      sighting = BehindASecondBoard(Lidar(frame, 0.5));
      sighting.board->log_likelihood = -1.0;
      sighting.runners_up[0].log_likelihood = -1.2;
    }
    Append(picker.Add(sighting), &decisions);
    Append(picker.Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  ASSERT_EQ(decisions.size(), 3U);
  ASSERT_TRUE(decisions[2].accepted);
  const BoardSample& sample = *decisions[2].accepted;
  ASSERT_EQ(sample.runners_up.size(), 1U);
  EXPECT_NEAR(sample.lidar.pose.centre_m.x(), 0.5, 1e-12);
  EXPECT_NEAR(sample.runners_up[0].pose.centre_m.x(), 5.0, 1e-12);
  EXPECT_NEAR(sample.lidar.log_likelihood, (-1.0 - 1.2 - 1.0) / 3, 1e-12);
}

TEST(SamplePicker, DropsACandidateThatIsNotInEveryFrame) {
  SamplePicker picker(Board(), {});
  std::vector<PickerDecision> decisions;
  for (int frame = 0; frame < 3; ++frame) {
    const LidarSighting sighting = Lidar(frame, 0.5);
    Append(picker.Add(frame == 2 ? BeforeASecondBoard(sighting) : sighting), &decisions);
    Append(picker.Add(Camera(frame, 0.5)), &decisions);
  }
  Append(picker.Flush(), &decisions);
  ASSERT_TRUE(decisions.at(2).accepted);
  EXPECT_TRUE(decisions[2].accepted->runners_up.empty());
}

TEST(SamplePicker, PassesOverACandidateOfTheWrongSize) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker picker(Board(), options);
  LidarSighting sighting = BehindASecondBoard(Lidar(0, 0.5));
  sighting.board->edge_lengths_m[1] = 1.0;
  std::vector<PickerDecision> decisions = picker.Add(sighting);
  Append(picker.Add(Camera(0, 0.5)), &decisions);
  Append(picker.Flush(), &decisions);
  ASSERT_TRUE(decisions.at(0).accepted);
  EXPECT_NEAR(decisions[0].accepted->lidar.pose.centre_m.x(), 0.5, 1e-12);
  EXPECT_TRUE(decisions[0].accepted->runners_up.empty());
}

TEST(SamplePicker, KeepsNoMoreCandidatesThanAsked) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  options.max_candidates = 2;
  SamplePicker picker(Board(), options);
  LidarSighting sighting = BeforeASecondBoard(Lidar(0, 0.5));
  sighting.runners_up.push_back(sighting.runners_up[0]);
  std::vector<PickerDecision> decisions = picker.Add(sighting);
  Append(picker.Add(Camera(0, 0.5)), &decisions);
  Append(picker.Flush(), &decisions);
  ASSERT_TRUE(decisions.at(0).accepted);
  EXPECT_EQ(decisions[0].accepted->runners_up.size(), 1U);
}

TEST(SamplePicker, KnowsTheSamplesOfARestartedSession) {
  SamplePickerOptions options;
  options.num_still_frames = 1;
  SamplePicker first(Board(), options);
  std::vector<PickerDecision> decisions = first.Add(Lidar(0, 0.5));
  Append(first.Add(Camera(0, 0.5)), &decisions);
  Append(first.Flush(), &decisions);
  ASSERT_TRUE(decisions.at(0).accepted);

  SamplePicker second(Board(), options);
  second.SetKnown({*decisions[0].accepted});
  decisions = second.Add(Lidar(1, 0.5));
  Append(second.Add(Camera(1, 0.5)), &decisions);
  Append(second.Flush(), &decisions);
  EXPECT_THAT(Outcomes(decisions), testing::ElementsAre("pose is not new"));
}

TEST(SamplePicker, BoundsWhatWaitsForASilentSensor) {
  SamplePicker picker(Board(), {});
  std::size_t num_judged = 0;
  for (int frame = 0; frame < 1000; ++frame) num_judged += picker.Add(Lidar(frame, 0.5)).size();
  EXPECT_EQ(num_judged, 400U);  // 600 wait
}

TEST(SamplePicker, NamesABadOption) {
  SamplePickerOptions options;
  options.num_still_frames = 0;
  EXPECT_THAT(options.Problems(),
              testing::ElementsAre("num_still_frames must be at least 1, is 0"));
  EXPECT_THROW(SamplePicker(Board(), options), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
