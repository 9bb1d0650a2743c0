// The dashboard of a rig of several sensors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dashboard/dashboard_node.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"
#include "modules/dashboard/page_client.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {
namespace {

using test::Await;
using test::Json;
using test::Next;
using test::TestOptions;

/// A lidar and two cameras.
class DashboardOfARigTest : public ::testing::Test {
 protected:
  static ShownPair PairOf(const std::string& camera, const std::filesystem::path& session) {
    ShownPair pair;
    pair.rig = test::TestRig();
    pair.rig.rig_name = "truck";
    pair.rig.lidar_name = "roof";
    pair.rig.camera_name = camera;
    Channels& channels = pair.rig.channels;
    for (std::string* channel : {&channels.camera_image, &channels.camera_board}) {
      *channel += "_" + camera;
    }
    for (std::string* channel :
         {&channels.calib_samples, &channels.calib_event, &channels.next_pose}) {
      *channel += "_roof_" + camera;
    }
    pair.session_folder = session / ("roof_" + camera);
    pair.report_command = {"/bin/true"};
    return pair;
  }
  static ServerOptions Options() {
    ServerOptions options = TestOptions();
    options.pairs = {"roof_front", "roof_rear"};
    return options;
  }
  SessionPlan Plan() const {
    SessionPlan plan;
    const auto add = [&plan](const std::string& channel, const std::string& sender) {
      Stream stream;
      stream.channel = channel;
      stream.sender = sender;
      stream.name = sender;
      plan.streams.push_back(stream);
    };
    add(pairs_[0].rig.channels.lidar_points, "lidar_driver_roof");
    add(pairs_[0].rig.channels.lidar_board, "lidar_board_detector_roof");
    for (const ShownPair& pair : pairs_) {
      const std::string& camera = pair.rig.camera_name;
      add(pair.rig.channels.camera_image, "camera_driver_" + camera);
      add(pair.rig.channels.camera_board, "camera_board_detector_" + camera);
      plan.modules.push_back("sample_collector_roof_" + camera);
    }
    return plan;
  }
  /// Some module has heard all four streams of this pair lately.
  void LetFlow(const Channels& channels) {
    module_status_t status{};
    status.module = "recorder";
    for (const std::string& channel : {channels.lidar_points,
                                       channels.lidar_board,
                                       channels.camera_image,
                                       channels.camera_board}) {
      channel_status_t& heard = status.channels.emplace_back();
      heard.channel = channel;
      heard.num_received = 10;
      heard.rate_hz = 10;
    }
    status.num_channels = 4;
    test::Send(&bus_, "MODULE_STATUS", status);
  }
  void SendSamples(const std::string& camera, int num_samples, std::int64_t revision) {
    test::Send(&bus_,
               "CALIB_SAMPLES_roof_" + camera,
               ToMessage(test::NoisySamples(num_samples), revision, false, "its log's hash"));
  }
  /// Of both pairs, made from samples of this revision.
  static rig_extrinsics_t Results(const std::string& weakest, std::int64_t revision) {
    rig_extrinsics_t result{};
    result.weakest_pair = weakest;
    result.verdict_grade = "look";
    result.verdict_headline = "Usable";
    for (const char* const camera : {"front", "rear"}) {
      rig_pair_t& pair = result.pairs.emplace_back();
      pair.name = std::string("roof_") + camera;
      pair.from = "roof";
      pair.to = camera;
      pair.samples_revision = revision;
      pair.samples_sha256 = "its log's hash";
      pair.verdict_grade = "look";
    }
    result.num_pairs = 2;
    return result;
  }
  /// As a page that is opened now is told it.
  Json Table() {
    node_.Republish();
    test::SocketClient page = Page();
    return Next(&page, "pairs");
  }
  test::SocketClient Page() const { return test::OpenPage(server_); }
  command_t Clicked(const std::string& request) {
    test::SocketClient page = Page();
    page.Send(request);
    commands_.messages.clear();
    const bool has_come = Await([this] { return !commands_.messages.empty(); },
                                [this] {
                                  node_.Step();
                                  test::HandleAll(&bus_);
                                });
    EXPECT_TRUE(has_come) << request;
    return has_come ? commands_.messages.back() : command_t{};
  }

  test::TemporaryFolder folder_;
  std::vector<ShownPair> pairs_ = {PairOf("front", folder_.path()), PairOf("rear", folder_.path())};
  Bus bus_{"memq://"};
  DashboardServer server_{Options()};
  DashboardNode node_{pairs_, Plan(), &bus_, &server_, folder_.path()};
  test::Inbox<command_t> commands_{&bus_, pairs_[0].rig.channels.calib_command};
};

TEST_F(DashboardOfARigTest, ShowsThePairThatIsWatchedAndTheTableOfAll) {
  SendSamples("rear", 3, 3);
  next_pose_t next_pose{};
  next_pose.worst_error = 12.5;
  next_pose.unit = "mm";
  next_pose.is_enough = 1;
  next_pose.samples_revision = 3;
  next_pose.samples_sha256 = "its log's hash";
  test::Send(&bus_, "NEXT_POSE_roof_rear", next_pose);
  SendSamples("front", 8, 8);
  rig_extrinsics_t result = Results("roof_rear", 8);
  result.problem = "no pair joins these parts of the rig: roof, front | rear";
  result.pairs[1] = {};
  result.pairs[1].name = "roof_rear";
  result.pairs[1].samples_revision = -1;
  result.pairs[1].problem = "not calibrated yet";
  test::Send(&bus_, "RIG_EXTRINSICS", result);
  node_.Republish();

  test::SocketClient page = Page();
  page.Send(R"({"watch": "roof_rear"})");
  Json rig;
  do {
    rig = Next(&page, "rig");
  } while (rig["pair"]["name"] != "roof_rear");
  EXPECT_EQ(rig["name"], "truck");
  EXPECT_EQ(rig["pair"]["camera"], "rear");
  const Json pairs = Next(&page, "pairs");
  EXPECT_EQ(pairs["next"], "roof_rear");
  EXPECT_EQ(pairs["is_enough"], true);
  EXPECT_EQ(pairs["problem"], result.problem);
  EXPECT_EQ(pairs["pairs"][0]["grade"], "look");
  EXPECT_FALSE(pairs["pairs"][0].contains("worst_error"));
  EXPECT_EQ(pairs["pairs"][1]["num_samples"], 3);
  EXPECT_EQ(pairs["pairs"][1]["worst_error"], 12.5);
  EXPECT_EQ(pairs["pairs"][1]["problem"], "not calibrated yet");
  EXPECT_EQ(Next(&page, "samples")["samples"].size(), 3U);
}

TEST_F(DashboardOfARigTest, CallsNothingNextOrEnoughBeforeItHears) {
  EXPECT_EQ(Table()["next"], "");
  EXPECT_EQ(Table()["is_enough"], false);
}

// A camera that never starts would else hold the operator for ever.
TEST_F(DashboardOfARigTest, SendsToNoPairWhoseSensorSendsNothing) {
  SendSamples("rear", 8, 8);
  rig_extrinsics_t result = Results("roof_front", 8);
  result.pairs[0].verdict_grade.clear();
  result.pairs[0].problem = "the two never saw the board rest at one time";
  test::Send(&bus_, "RIG_EXTRINSICS", result);
  next_pose_t enough{};
  enough.is_enough = 1;
  enough.samples_revision = 8;
  enough.samples_sha256 = "its log's hash";
  test::Send(&bus_, "NEXT_POSE_roof_rear", enough);
  EXPECT_EQ(Table()["next"], "roof_front");  // none can be sampled: all are as good
  LetFlow(pairs_[1].rig.channels);
  const Json table = Table();
  EXPECT_EQ(table["next"], "roof_rear");
  EXPECT_EQ(table["pairs"][0]["unheard"], "front");
  EXPECT_EQ(table["pairs"][1]["unheard"], "");
  EXPECT_EQ(table["is_enough"], false);  // the rig lacks the other all the same
  LetFlow(pairs_[0].rig.channels);
  EXPECT_EQ(Table()["next"], "roof_front");
}

TEST_F(DashboardOfARigTest, AResultIsOfTheSamplesThatAreThere) {
  SendSamples("front", 8, 8);
  SendSamples("rear", 8, 8);
  test::Send(&bus_, "RIG_EXTRINSICS", Results("roof_front", 8));
  EXPECT_EQ(Table()["pairs"][0]["grade"], "look");
  EXPECT_EQ(Table()["is_current"], true);
  SendSamples("front", 9, 9);  // the older one stays in sight while it is renewed
  const Json renewed = Table();
  EXPECT_EQ(renewed["pairs"][0]["grade"], "look");
  EXPECT_EQ(renewed["pairs"][0]["is_current"], false);
  EXPECT_EQ(renewed["pairs"][1]["is_current"], true);
  EXPECT_EQ(renewed["is_current"], false);
  SendSamples("front", 0, 10);  // a reset
  SendSamples("front", 1, 11);
  const Json reset = Table();
  EXPECT_EQ(reset["pairs"][0]["num_samples"], 1);
  EXPECT_EQ(reset["pairs"][0]["grade"], "");
  EXPECT_EQ(reset["pairs"][1]["grade"], "look");
  EXPECT_EQ(reset["is_current"], false);
}

TEST_F(DashboardOfARigTest, CommandsOnePairOrAll) {
  EXPECT_EQ(Clicked(R"({"command": "capture", "pair": "roof_rear"})").pair, "roof_rear");
  EXPECT_EQ(Clicked(R"({"command": "finish"})").pair, "");
  const command_t discard =
      Clicked(R"({"command": "discard", "sample_id": 1, "pair": "roof_rear"})");
  EXPECT_EQ(discard.pair, "roof_rear");
  EXPECT_EQ(discard.sample_id, 1);
}

TEST_F(DashboardOfARigTest, AFaultOfAnotherPairIsMarkedSo) {
  module_status_t status{};
  status.module = "sample_collector_roof_rear";
  status.state = "trouble: The clocks differ; set them";
  test::Send(&bus_, "MODULE_STATUS", status);
  node_.Republish();
  test::SocketClient page = Page();
  EXPECT_EQ(Next(&page, "modules")["faults"][0]["is_of_others"], true);
  page.Send(R"({"watch": "roof_rear"})");
  while (Next(&page, "rig")["pair"]["name"] != "roof_rear") {
  }
  const Json faults = Next(&page, "modules")["faults"];
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0]["of"], "sample_collector_roof_rear");
  EXPECT_FALSE(faults[0].contains("is_of_others"));
}

}  // namespace
}  // namespace voqcal
