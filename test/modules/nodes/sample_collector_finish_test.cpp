// When a session of the collector ends, and what is kept then.

#include <map>

#include "messaging/session_misses.hpp"
#include "modules/nodes/sample_collector_fixture.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(SampleCollectorNodeTest, ResetAndFinishTakeBackACaptureThatWaits) {
  for (const std::string command : {"reset", "finish"}) {
    Restart();
    Command("capture");
    Command(command);
    Republish();
    const auto frames = test::StillFrames(samples_, 0);
    test::Send(bus_.get(), rig_.channels.lidar_board, frames[0].lidar);
    test::Send(bus_.get(), rig_.channels.camera_board, frames[0].camera);
    test::Send(bus_.get(), rig_.channels.camera_board, frames[1].camera);  // closes the pair
    EXPECT_THAT(Ids(), IsEmpty()) << command;
    // After "finish" no frame is even judged.
    EXPECT_EQ(last_event().reason, command == "reset" ? "not yet still for long enough" : "");
  }
}

TEST_F(SampleCollectorNodeTest, FinishesOnlyOnceNoFrameHasComeForASecond) {
  ShowStop(0);
  Command("finish");
  Republish();  // frames have come since the last one
  EXPECT_FALSE(last().is_finished);
  ShowStop(1);  // detectors were still at work
  Republish();
  EXPECT_FALSE(last().is_finished);
  node_->Republish();  // a stalled process: the queue has not been seen empty since
  EXPECT_FALSE(last().is_finished);
  Republish();
  EXPECT_TRUE(last().is_finished);
  EXPECT_EQ(last_event().kind, "finished");
  EXPECT_EQ(node_->State(), "finished: 2 samples");
}

TEST_F(SampleCollectorNodeTest, FinishesWhileSensorsGoOnOnceDetectorsArePastIt) {
  ShowStop(0, {0, 1, 2, 3});
  const std::int64_t utime = test::StillFrames(samples_, 1).back().camera.utime;
  image_t image{};
  image.utime = utime;
  test::Send(bus_.get(), rig_.channels.camera_image, image);
  Command("finish");
  ShowStop(1);        // detectors come up to that image, not past it
  Command("finish");  // said again, it asks for nothing more
  Republish();
  EXPECT_FALSE(last().is_finished);
  ShowStop(2);
  Republish();
  EXPECT_TRUE(last().is_finished);
  EXPECT_EQ(node_->State(), "finished: 2 samples");  // what comes later is not taken...
  Command("capture");
  ShowStop(3);
  EXPECT_THAT(Ids(), ElementsAre(1, 2, 3));  // ...until that is asked for
  EXPECT_FALSE(last().is_finished);
}

// The camera never came, or has stopped: there is nothing of it to wait for.
TEST_F(SampleCollectorNodeTest, FinishesThoughOneSensorIsSilentWhileTheOtherGoesOn) {
  const auto frames = test::StillFrames(samples_, 0);
  const auto show_to_lidar = [&](std::size_t i) {
    pointcloud2_t sweep{};
    sweep.utime = frames[i].lidar.utime;
    test::Send(bus_.get(), rig_.channels.lidar_points, sweep);
    test::Send(bus_.get(), rig_.channels.lidar_board, frames[i].lidar);
  };
  test::Send(bus_.get(), rig_.channels.camera_image, image_t{});
  show_to_lidar(0);
  Command("finish");
  show_to_lidar(1);
  Republish();  // the image's detector may still be at work
  EXPECT_FALSE(last().is_finished);
  show_to_lidar(2);
  Republish();
  EXPECT_TRUE(last().is_finished);
}

// As the end of its recording does: the replay gives the same samples.
TEST_F(SampleCollectorNodeTest, FinishJudgesTheFramesThatWaitAlsoWhileSensorsGoOn) {
  auto frames = test::StillFrames(samples_, 0);
  frames.pop_back();  // nothing closes the third pair
  for (const test::SightingMessages& frame : frames) {
    test::Send(bus_.get(), rig_.channels.lidar_board, frame.lidar);
    test::Send(bus_.get(), rig_.channels.camera_board, frame.camera);
  }
  image_t image{};
  image.utime = frames.back().camera.utime;
  test::Send(bus_.get(), rig_.channels.camera_image, image);
  Command("finish");
  ShowStop(1);
  Republish();
  EXPECT_THAT(Ids(), ElementsAre(1));
  EXPECT_EQ(last_event().kind, "finished");
}

TEST_F(SampleCollectorNodeTest, FinishJudgesTheFramesThatWait) {
  auto frames = test::StillFrames(samples_, 0);
  frames.pop_back();  // nothing closes the third pair
  for (const test::SightingMessages& frame : frames) {
    test::Send(bus_.get(), rig_.channels.lidar_board, frame.lidar);
    test::Send(bus_.get(), rig_.channels.camera_board, frame.camera);
  }
  EXPECT_THAT(Ids(), IsEmpty());
  node_->Finish();
  EXPECT_THAT(Ids(), ElementsAre(1));
}

TEST_F(SampleCollectorNodeTest, KeepsFramesWithoutABoardWhereFinishLeavesTooFewSamples) {
  constexpr int kNumFrames = 9;
  for (int i = 0; i < kNumFrames; ++i) {
    const std::int64_t utime = 100'000 * i;
    pointcloud2_t sweep{};
    sweep.utime = utime;
    sweep.seq = i;
    test::Send(bus_.get(), rig_.channels.lidar_points, sweep);
    const std::string miss = "joined to something: " + std::to_string(i) + " mm";
    test::Send(bus_.get(), rig_.channels.lidar_board, LidarBoardMessage({}, miss, utime, 0, i));
    // Its image never came.
    test::Send(bus_.get(),
               rig_.channels.camera_board,
               CameraBoardMessage(std::nullopt, "no board", "", utime, i));
  }
  node_->Finish();
  const SessionMisses misses = ReadMisses(folder_.path());
  std::map<std::string, std::int64_t> counts;
  for (const counter_t& counter : misses.counts) counts[counter.name] = counter.count;
  EXPECT_EQ(counts["LIDAR_MISS: joined to something: N mm"], kNumFrames);
  EXPECT_EQ(counts["CAMERA_MISS: no board"], kNumFrames);
  EXPECT_THAT(misses.images, IsEmpty());
  // The fourth and the eighth of the reason, each with what was said of it.
  ASSERT_THAT(misses.sweeps, SizeIs(2));
  EXPECT_EQ(misses.sweeps[0].sweep.seq, 3);
  EXPECT_EQ(misses.sweeps[1].sweep.seq, 7);
  EXPECT_EQ(misses.sweeps[1].board.miss, "joined to something: 7 mm");

  // With samples enough for a result there is nothing to explain.
  Restart();
  for (int stop = 0; stop < 3; ++stop) ShowStop(stop);
  node_->Finish();
  ASSERT_THAT(Ids(), SizeIs(3));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / kMissesLogName));
}

}  // namespace
}  // namespace voqcal
