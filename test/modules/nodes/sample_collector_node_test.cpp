#include "sample_collector/sample_collector_node.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/sha256.hpp"
#include "messaging/session_misses.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/sightings.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class SampleCollectorNodeTest : public ::testing::Test {
 protected:
  SampleCollectorNodeTest() { Restart(); }

  void Restart() {
    node_.reset();
    inbox_.reset();
    events_.reset();
    bus_ = std::make_unique<Bus>("memq://");
    node_ = std::make_unique<SampleCollectorNode>(rig_, bus_.get(), folder_.path());
    inbox_ = std::make_unique<test::Inbox<samples_t>>(bus_.get(), rig_.channels.calib_samples);
    events_ = std::make_unique<test::Inbox<event_t>>(bus_.get(), rig_.channels.calib_event);
  }

  /// The board rests at a pose over three frames, and a fourth that closes the third. Of the frames
  /// listed the collector also sees what the detectors saw.
  void ShowStop(int stop, const std::vector<std::size_t>& with_scene = {}) {
    const auto frames = test::StillFrames(samples_, stop);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (std::count(with_scene.begin(), with_scene.end(), i) != 0) {
        pointcloud2_t sweep{};
        sweep.utime = frames[i].lidar.utime;
        sweep.seq = static_cast<std::int32_t>(i);
        test::Send(bus_.get(), rig_.channels.lidar_points, sweep);
        image_t image{};
        image.utime = frames[i].camera.utime;
        test::Send(bus_.get(), rig_.channels.camera_image, image);
      }
      test::Send(bus_.get(), rig_.channels.lidar_board, frames[i].lidar);
      test::Send(bus_.get(), rig_.channels.camera_board, frames[i].camera);
    }
  }

  void Command(const std::string& text, std::int64_t sample_id = 0, const std::string& pair = {}) {
    command_t command{};
    command.command = text;
    command.sample_id = sample_id;
    command.pair = pair;
    test::Send(bus_.get(), rig_.channels.calib_command, command);
  }

  /// A second passes.
  void Republish() {
    node_->Step();
    node_->Republish();
    test::HandleAll(bus_.get());
  }

  std::vector<std::int64_t> Ids() const { return IdsOf(SamplesWithout(node_->samples(), {})); }
  const samples_t& last() const { return inbox_->messages.back(); }
  const event_t& last_event() const { return events_->messages.back(); }

  Rig rig_ = test::TestRig();
  test::TemporaryFolder folder_;
  std::vector<BoardSample> samples_ = test::SynthesizeSamples({});
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<SampleCollectorNode> node_;
  std::unique_ptr<test::Inbox<samples_t>> inbox_;
  std::unique_ptr<test::Inbox<event_t>> events_;
};

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

TEST_F(SampleCollectorNodeTest, SaysThatASamplesFramesWereLost) {
  ShowStop(0, {1, 2});
  ASSERT_THAT(node_->samples(), SizeIs(1));
  EXPECT_EQ(last_event().reason, "its sweep or image did not arrive: no scene");
  EXPECT_EQ(node_->counters().at("accepted without its scene"), 1);
  EXPECT_FALSE(SessionSceneReader(folder_.path() / kSamplesLogName).Next());
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
