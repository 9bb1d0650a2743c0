// What the collector makes of boards and commands; its end is in sample_collector_finish_test.cpp.

#include "files/sha256.hpp"
#include "modules/nodes/sample_collector_fixture.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(SampleCollectorNodeTest, AcceptsAStillNewPoseAndAnnouncesIt) {
  ShowStop(0);
  ASSERT_THAT(inbox_->messages, SizeIs(1));
  EXPECT_EQ(last().num_samples, 1);
  EXPECT_EQ(last().revision, 1);
  EXPECT_FALSE(last().is_finished);
  ASSERT_THAT(node_->samples(), SizeIs(1));
  EXPECT_EQ(node_->samples()[0].num_frames, 3);
  EXPECT_EQ(node_->counters().at("accepted"), 1);
  // An event for each decision: two frames are too few, the third makes the sample.
  ASSERT_THAT(events_->messages, SizeIs(3));
  EXPECT_EQ(events_->messages[0].kind, "rejected");
  EXPECT_EQ(events_->messages[0].reason, "not yet still for long enough");
  EXPECT_EQ(last_event().kind, "accepted");
  EXPECT_EQ(last_event().sample_id, 1);
}

TEST_F(SampleCollectorNodeTest, HasTheSampleOnTheDiskBeforeItAnnouncesIt) {
  int num_seen = 0;
  bus_->Subscribe<samples_t>(
      rig_.channels.calib_samples, Queue::kEvery, [this, &num_seen](const samples_t& message) {
        const test::TemporaryFolder copy;
        std::filesystem::copy_file(folder_.path() / kSamplesLogName, copy.path() / kSamplesLogName);
        const SessionLog on_disk(copy.path());
        EXPECT_EQ(on_disk.samples().size(), static_cast<std::size_t>(message.num_samples));
        EXPECT_EQ(on_disk.Sha256(), message.log_sha256);
        ++num_seen;
      });
  ShowStop(0);
  ShowStop(1);
  EXPECT_EQ(num_seen, 2);
}

TEST_F(SampleCollectorNodeTest, GoesOnWithTheSessionOfTheLastRun) {
  ShowStop(0);
  ShowStop(1);
  Command("discard", 2);
  const samples_t before = last();
  Restart();
  Republish();
  EXPECT_EQ(last().revision, before.revision);
  EXPECT_EQ(last().num_samples, before.num_samples);
  EXPECT_EQ(last().log_sha256, before.log_sha256);
  ShowStop(0);  // known from the last run
  EXPECT_THAT(Ids(), ElementsAre(1));
  ShowStop(2);
  EXPECT_THAT(Ids(), ElementsAre(1, 3));  // 2 was discarded: never again
}

TEST_F(SampleCollectorNodeTest, DiscardsTheNewestOrTheNamedSample) {
  for (int stop = 0; stop < 3; ++stop) ShowStop(stop);
  Command("discard");
  EXPECT_THAT(Ids(), ElementsAre(1, 2));
  EXPECT_EQ(last_event().kind, "discarded");
  EXPECT_EQ(last_event().sample_id, 3);
  Command("discard", 1);
  EXPECT_THAT(Ids(), ElementsAre(2));
  EXPECT_EQ(last().num_samples, 1);
  Command("discard", 1);
  EXPECT_EQ(last_event().kind, "rejected");
  EXPECT_EQ(last_event().reason, "there is no sample 1");
  EXPECT_THAT(Ids(), ElementsAre(2));
}

TEST_F(SampleCollectorNodeTest, ObeysWhatIsMeantForItsPairOrForAll) {
  for (int stop = 0; stop < 3; ++stop) ShowStop(stop);
  Command("reset", 0, "front_left");
  EXPECT_THAT(Ids(), ElementsAre(1, 2, 3));
  Command("discard", 0, "lidar_camera");
  EXPECT_THAT(Ids(), ElementsAre(1, 2));
  Command("reset");
  EXPECT_THAT(Ids(), IsEmpty());
}

TEST_F(SampleCollectorNodeTest, TakesADiscardedPoseAnew) {
  ShowStop(0);
  Command("discard");
  samples_[0].utime = 500'000'000;  // the board is shown there again, later
  ShowStop(0);
  EXPECT_THAT(Ids(), ElementsAre(2));
}

TEST_F(SampleCollectorNodeTest, ResetTakesAllSamplesAway) {
  ShowStop(0);
  ShowStop(1);
  Command("reset");
  EXPECT_THAT(Ids(), IsEmpty());
  EXPECT_EQ(last().num_samples, 0);
  EXPECT_EQ(last_event().kind, "reset");
}

TEST_F(SampleCollectorNodeTest, AnswersAnUnknownCommandWithARejection) {
  Command("explode");
  EXPECT_EQ(last_event().kind, "rejected");
  EXPECT_EQ(last_event().reason, "unknown command 'explode'");
  EXPECT_EQ(node_->counters().at("unknown command"), 1);
}

TEST_F(SampleCollectorNodeTest, CaptureTakesASinglePair) {
  Command("capture");
  const auto frames = test::StillFrames(samples_, 0);
  test::Send(bus_.get(), rig_.channels.lidar_board, frames[0].lidar);
  test::Send(bus_.get(), rig_.channels.camera_board, frames[0].camera);
  test::Send(bus_.get(), rig_.channels.camera_board, frames[1].camera);  // closes the pair
  ASSERT_THAT(node_->samples(), SizeIs(1));
  EXPECT_EQ(node_->samples()[0].num_frames, 1);
  EXPECT_EQ(last_event().kind, "accepted");
  EXPECT_EQ(last_event().reason, "by command; its sweep or image did not arrive: no scene");
  ShowStop(1, {0, 1, 2});  // by itself
  EXPECT_EQ(last_event().kind, "accepted");
  EXPECT_EQ(last_event().reason, "");
}

TEST_F(SampleCollectorNodeTest, KeepsTheSweepAndTheImageOfTheSamplesFirstFrame) {
  ShowStop(0, {0, 1, 2});
  SessionSceneReader reader(folder_.path() / kSamplesLogName);
  const auto scene = reader.Next();
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->sample_id, 1);
  EXPECT_EQ(scene->sweep.utime, samples_[0].utime);
  EXPECT_EQ(scene->image.utime, samples_[0].utime);
  EXPECT_EQ(scene->sweep.seq, 0);
  EXPECT_FALSE(reader.Next());
  EXPECT_EQ(last_event().reason, "");
  EXPECT_EQ(node_->counters().count("accepted without its scene"), 0U);
}

TEST_F(SampleCollectorNodeTest, KeepsFramesOnlyUntilTheyAreJudged) {
  ShowStop(0, {0, 1, 2, 3});
  const std::size_t num_bytes = node_->NumFrameBytes();
  EXPECT_GT(num_bytes, 0U);
  for (int stop = 1; stop < 4; ++stop) ShowStop(stop, {0, 1, 2, 3});
  EXPECT_EQ(node_->NumFrameBytes(), num_bytes);
  EXPECT_EQ(node_->counters().count("accepted without its scene"), 0U);
}

TEST_F(SampleCollectorNodeTest, SaysThatASamplesFramesWereLost) {
  ShowStop(0, {1, 2});
  ASSERT_THAT(node_->samples(), SizeIs(1));
  EXPECT_EQ(last_event().reason, "its sweep or image did not arrive: no scene");
  EXPECT_EQ(node_->counters().at("accepted without its scene"), 1);
  EXPECT_FALSE(SessionSceneReader(folder_.path() / kSamplesLogName).Next());
}

TEST_F(SampleCollectorNodeTest, SaysThatTheSensorsClocksDiffer) {
  for (std::int64_t frame = 0; frame < 4; ++frame) {
    pointcloud2_t sweep{};
    sweep.utime = 100'000 * frame;
    test::Send(bus_.get(), rig_.channels.lidar_points, sweep);
    image_t image{};
    image.utime = sweep.utime + 3'600'000'000;
    test::Send(bus_.get(), rig_.channels.camera_image, image);
  }
  EXPECT_THAT(node_->State(), HasSubstr("trouble: The camera's clock is 3599.9 s (60 min) ahead"));
}

// Nobody can tell whose boards they are.
TEST_F(SampleCollectorNodeTest, TakesNothingWhileTwoSessionsRunOnOneNetwork) {
  module_status_t status{};
  status.module = "camera_board_detector";
  status.state = "running";
  status.session = "host:/one";
  test::Send(bus_.get(), rig_.channels.module_status, status);
  ShowStop(0);
  EXPECT_THAT(Ids(), ElementsAre(1));
  status.session = "host:/another";
  test::Send(bus_.get(), rig_.channels.module_status, status);
  ShowStop(1);
  EXPECT_THAT(Ids(), ElementsAre(1));
  EXPECT_EQ(node_->counters().at("frames while two sessions ran on one network"), 8);
}

TEST_F(SampleCollectorNodeTest, OrderOfArrivalDoesNotMatter) {
  for (int stop = 0; stop < 4; ++stop) ShowStop(stop);
  node_->Finish();
  const std::string as_shown = Sha256OfFile(folder_.path() / kSamplesLogName);

  const test::TemporaryFolder other_folder;
  Bus bus("memq://");
  SampleCollectorNode other(rig_, &bus, other_folder.path());
  for (int stop = 0; stop < 4; ++stop) {  // all of the camera's frames before the lidar's
    for (const auto& frame : test::StillFrames(samples_, stop)) {
      test::Send(&bus, rig_.channels.camera_board, frame.camera);
    }
  }
  for (int stop = 0; stop < 4; ++stop) {
    for (const auto& frame : test::StillFrames(samples_, stop)) {
      test::Send(&bus, rig_.channels.lidar_board, frame.lidar);
    }
  }
  other.Finish();
  EXPECT_THAT(other.samples(), SizeIs(4));
  EXPECT_EQ(Sha256OfFile(other_folder.path() / kSamplesLogName), as_shown);
}

}  // namespace
}  // namespace voqcal
