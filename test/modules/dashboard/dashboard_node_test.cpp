#include "dashboard/dashboard_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assessor/assessor_node.hpp"
#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "files/atomic_file.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"
#include "modules/dashboard/page_client.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/temporary_folder.hpp"
#include "voq_selector/voq_selector_node.hpp"
#include "voqcal/command_t.hpp"

namespace voqcal {
namespace {

using test::Await;
using test::Json;
using test::Next;
using test::TestOptions;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class DashboardNodeTest : public test::ChainTest {
 protected:
  test::SocketClient Page() const { return test::OpenPage(server_); }
  void Calibrate() {
    Step(&selector_);
    Step(&estimator_);
    Step(&refiner_);
    Step(&assessor_);
  }
  void SendEvent(const std::string& kind, const std::string& reason, std::int64_t seq) {
    event_t event{};
    event.kind = kind;
    event.reason = reason;
    event.seq = seq;
    test::Send(&bus_, rig_.channels.calib_event, event);
  }

  void ClickFinish() {
    test::SocketClient page = Page();
    page.Send(R"({"command": "finish"})");
    ASSERT_TRUE(Await([this] { return !commands_.messages.empty(); }, [this] { Step(&node_); }));
    commands_.messages.clear();
  }
  /// Once there is no more to wait for.
  Json ReportWhenDone() {
    Json report;
    const auto look = [&] {
      node_.Republish();
      test::SocketClient page = Page();
      report = Next(&page, "report");
    };
    look();
    EXPECT_TRUE(Await([&] { return report["state"] != "making"; }, look));
    return report;
  }
  test::http::response<test::http::string_body> Get(const std::string& file) const {
    const std::string host = "127.0.0.1:" + std::to_string(server_.port());
    return test::Request(server_.port(), "/" + TestOptions().token + "/export/" + file, {host, ""});
  }

  test::TemporaryFolder folder_;
  VoqSelectorNode selector_{rig_, &bus_};
  ExtrinsicEstimatorNode estimator_{rig_, &bus_};
  ExtrinsicRefinerNode refiner_{rig_, &bus_};
  AssessorNode assessor_{rig_, &bus_, folder_.path()};
  DashboardServer server_{TestOptions()};
  std::string report_script_ = folder_.path() / "make_report.sh";
  DashboardNode node_{{{rig_, folder_.path(), {"/bin/sh", report_script_}}},
                      PlanOfPair(rig_.channels),
                      &bus_,
                      &server_,
                      folder_.path()};
  test::Inbox<command_t> commands_{&bus_, rig_.channels.calib_command};
};

TEST_F(DashboardNodeTest, TellsWhatTheRigIs) {
  test::SocketClient page = Page();
  const Json rig = Next(&page, "rig");
  EXPECT_EQ(rig["name"], rig_.name);
  EXPECT_EQ(rig["camera"]["width_px"], rig_.camera.width_px);
}

TEST_F(DashboardNodeTest, ShowsSamplesResultAndVerdict) {
  SendSamples(test::NoisySamples(20), 20);
  Calibrate();
  Step(&node_);
  test::SocketClient page = Page();
  const Json samples = Next(&page, "samples");
  EXPECT_EQ(samples["samples"].size(), 20U);
  EXPECT_TRUE(samples["samples"][0].contains("held_out_mm"));
  const Json result = Next(&page, "result");
  EXPECT_EQ(result["is_current"], true);
  EXPECT_EQ(result["working_on"], "");
  EXPECT_EQ(result["num_samples"], 20);
  EXPECT_GE(result["verdict"]["checks"].size(), 8U);
  EXPECT_THAT(result["exports"], Contains("extrinsic.yaml"));
  EXPECT_THAT(result["exports"], Contains("extrinsic_kalibr.yaml"));
}

TEST_F(DashboardNodeTest, KeepsTheOldResultWhileItComputes) {
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  SendSamples(test::NoisySamples(9), 9);
  Step(&selector_);
  Step(&node_);
  test::SocketClient page = Page();
  const Json result = Next(&page, "result");
  EXPECT_EQ(result["is_current"], false);
  EXPECT_EQ(result["num_samples"], 8);
  EXPECT_EQ(result["working_on"], "calibrating each set");
}

TEST_F(DashboardNodeTest, SaysWhyThereIsNoResult) {
  SendSamples(test::NoisySamples(2), 2);
  Calibrate();
  Step(&node_);
  test::SocketClient page = Page();
  EXPECT_THAT(Next(&page, "result")["problem"].get<std::string>(), HasSubstr("three"));
}

TEST_F(DashboardNodeTest, ExportsAreThoseOfTheResultFile) {
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  Step(&node_);
  test::SocketClient page = Page();
  Next(&page, "result");
  const std::string host = "127.0.0.1:" + std::to_string(server_.port());
  const auto file = test::Request(
      server_.port(), "/" + TestOptions().token + "/export/extrinsic.yaml", {host, ""});
  EXPECT_EQ(file.body(), ToYaml(*assessor_.result()));
}

TEST_F(DashboardNodeTest, ExportsNoFileOfOtherSamples) {
  const std::string host = "127.0.0.1:" + std::to_string(server_.port());
  const auto exported = [&] {
    Step(&node_);
    test::SocketClient page = Page();
    return Next(&page, "result")["exports"].size();
  };
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  const std::string file = ReadWholeFile(folder_.path() / "extrinsic.yaml");
  std::string other = file;
  other.replace(other.find("log's hash"), 3, "old");
  folder_.Write("extrinsic.yaml", other);
  EXPECT_EQ(exported(), 0U);
  EXPECT_EQ(test::Request(
                server_.port(), "/" + TestOptions().token + "/export/extrinsic.yaml", {host, ""})
                .result_int(),
            404U);
  folder_.Write("extrinsic.yaml", file);
  assessor_.Republish();
  test::HandleAll(&bus_);
  EXPECT_GT(exported(), 0U);
}

TEST_F(DashboardNodeTest, SendsCommands) {
  test::SocketClient page = Page();
  page.Send(R"({"command": "discard", "sample_id": 5})");
  ASSERT_TRUE(Await([this] { return !commands_.messages.empty(); }, [this] { Step(&node_); }));
  ASSERT_THAT(commands_.messages, SizeIs(1));
  EXPECT_EQ(commands_.messages[0].command, "discard");
  EXPECT_EQ(commands_.messages[0].sample_id, 5);
  EXPECT_EQ(commands_.messages[0].pair, "lidar_camera");
  EXPECT_GT(commands_.messages[0].utime, 0);
}

TEST_F(DashboardNodeTest, MakesAndOffersTheReportOnceFinishWasClicked) {
  folder_.Write(
      "make_report.sh",
      "echo \"<p>of log's hash</p>\" > '" + (folder_.path() / "report.html").string() + "'");
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  EXPECT_EQ(ReportWhenDone()["state"], "");  // the samples are finished, by whoever did it
  ClickFinish();
  const Json report = ReportWhenDone();
  EXPECT_EQ(report["state"], "made");
  EXPECT_EQ(report["file"], "report.html");
  EXPECT_EQ(report["folder"], folder_.path().string());
  const auto page = Get("report.html");
  EXPECT_EQ(page.body(), "<p>of log's hash</p>\n");
  EXPECT_THAT(std::string(page["Content-Security-Policy"]),
              AllOf(HasSubstr("script-src 'none'"),
                    HasSubstr("connect-src 'none'"),
                    HasSubstr("style-src 'unsafe-inline'")));
  EXPECT_EQ(Get("extrinsic.yaml").result_int(), 200U);
  SendSamples(test::NoisySamples(9), 9, "another hash");
  EXPECT_EQ(ReportWhenDone()["state"], "");
  EXPECT_EQ(Get("report.html").result_int(), 404U);
}

// By tools' "command", say.
TEST_F(DashboardNodeTest, OffersAReportThatAnotherMade) {
  folder_.Write("report.html", "of other samples");
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  EXPECT_EQ(ReportWhenDone()["state"], "");
  folder_.Write("report.html", "of log's hash");
  EXPECT_EQ(ReportWhenDone()["state"], "made");
}

TEST_F(DashboardNodeTest, OffersWhatWasSeenWhereThereIsNoResult) {
  folder_.Write(
      "make_report.sh",
      "echo \"$$ of log's hash\" > '" + (folder_.path() / "no_result.html").string() + "'; exit 1");
  SendSamples(test::NoisySamples(2), 2);
  Calibrate();
  ClickFinish();
  const Json report = ReportWhenDone();
  EXPECT_EQ(report["state"], "made");
  EXPECT_EQ(report["file"], "no_result.html");
  const std::string first = Get("no_result.html").body();
  EXPECT_THAT(first, HasSubstr("log's hash"));
  ClickFinish();  // more may have been seen
  EXPECT_EQ(ReportWhenDone()["state"], "made");
  EXPECT_NE(Get("no_result.html").body(), first);
}

TEST_F(DashboardNodeTest, OffersWhatAnotherToldOfWhatWasSeen) {
  SendSamples(test::NoisySamples(2), 2);
  Calibrate();
  folder_.Write("no_result.html", "of earlier samples");
  EXPECT_EQ(ReportWhenDone()["state"], "");
  folder_.Write("no_result.html", "of log's hash");
  EXPECT_EQ(ReportWhenDone()["file"], "no_result.html");
  folder_.Write("no_result.html", "again of log's hash");
  EXPECT_EQ(ReportWhenDone()["file"], "no_result.html");
  EXPECT_EQ(Get("no_result.html").body(), "again of log's hash");
}

TEST_F(DashboardNodeTest, SaysThatNoReportCouldBeMade) {
  SendSamples(test::NoisySamples(8), 8);
  Calibrate();
  ClickFinish();
  EXPECT_EQ(ReportWhenDone()["state"], "failed");
}

// Step is never called: one message after the other is handled.
TEST_F(DashboardNodeTest, WorksWhileMessagesNeverCease) {
  SendSamples(test::NoisySamples(3), 3);
  test::SocketClient page = Page();
  page.Send(R"({"command": "capture"})");
  ASSERT_TRUE(Await([this] { return !commands_.messages.empty(); },
                    [this] { test::Send(&bus_, rig_.channels.lidar_points, pointcloud2_t{}); }));
  EXPECT_EQ(Next(&page, "samples")["samples"].size(), 3U);
}

TEST_F(DashboardNodeTest, CountsRejectsOfOneCause) {
  SendEvent("accepted", "", 1);
  SendEvent("rejected", "board is moving: 0.12 m", 2);
  SendEvent("rejected", "board is moving: 0.13 m", 3);
  SendEvent("rejected", "pose is not new", 4);
  SendEvent("rejected", "board is moving: 0.14 m", 5);
  test::SocketClient page = Page();
  const Json events = Next(&page, "events")["events"];
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0]["reason"], "board is moving: 0.14 m");
  EXPECT_EQ(events[0]["count"], 3);
  EXPECT_EQ(events[1]["reason"], "pose is not new");
  EXPECT_EQ(events[2]["event"], "accepted");
}

TEST_F(DashboardNodeTest, CountsWhatItCannotShow) {
  image_t image{};
  image.width = 10;
  image.height = 10;
  image.pixelformat = 7;
  test::Send(&bus_, rig_.channels.camera_image, image);
  EXPECT_EQ(node_.counters().at("messages that cannot be shown"), 1);
}

TEST_F(DashboardNodeTest, SurvivesAnImageWithoutBytes) {
  image_t image{};
  image.width = 1920;
  image.height = 1208;
  image.pixelformat = kPixelMjpeg;
  EXPECT_NO_THROW(test::Send(&bus_, rig_.channels.camera_image, image));
  EXPECT_EQ(node_.counters().at("messages that cannot be shown"), 1);
}

// Without a page it makes a frame a second at most: two images in a row cost one.
TEST_F(DashboardNodeTest, ShowsNoMoreImagesThanItsRate) {
  for (int i = 0; i < 5; ++i) {
    test::Send(
        &bus_, rig_.channels.camera_image, ToMessage(cv::Mat(8, 8, CV_8UC1, cv::Scalar(9)), i, i));
  }
  test::SocketClient page = Page();
  EXPECT_EQ(Next(&page, "image")["utime"], 0);
}

// Whichever comes first; another image's board is never drawn on it.
TEST_F(DashboardNodeTest, ShowsAnImageWithTheBoardThatWasFoundInIt) {
  const auto send_board = [this](const std::string& miss, std::int64_t utime) {
    test::Send(&bus_,
               rig_.channels.camera_board,
               CameraBoardMessage(std::nullopt, miss, "", utime, utime));
  };
  send_board("no board", 1);
  test::Send(
      &bus_, rig_.channels.camera_image, ToMessage(cv::Mat(8, 8, CV_8UC1, cv::Scalar(9)), 5, 0));
  send_board("blurred", 4);
  send_board("glare", 5);
  send_board("no board", 6);
  test::SocketClient page = Page();
  const Json image = Next(&page, "image");
  EXPECT_EQ(image["utime"], 5);
  EXPECT_EQ(image["board"]["utime"], 5);
  EXPECT_EQ(image["board"]["miss"], "glare");
}

TEST_F(DashboardNodeTest, SaysWhatIsWrong) {
  module_status_t status{};
  status.module = "assessor";
  status.state = "failed: disk full";
  test::Send(&bus_, rig_.channels.module_status, status);
  node_.Republish();
  test::SocketClient page = Page();
  const Json health = Next(&page, "modules");
  const Json module = health["modules"].at(0);
  EXPECT_EQ(module["name"], "assessor");
  EXPECT_EQ(module["health"], "failed");
  EXPECT_EQ(health["faults"].at(0)["what"], "assessor has failed");
  EXPECT_EQ(health["faults"].at(0)["cause"], "assessor failed: disk full");
  EXPECT_EQ(health["flows"]["lidar"], "nothing yet");
}

}  // namespace
}  // namespace voqcal
