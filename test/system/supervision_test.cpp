// tools/up, status and down; and what a killed module changes in the end: nothing.

#include <csignal>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Supervision : public ::testing::Test {
 protected:
  ~Supervision() override { Down(); }

  test::Outcome Up(const std::vector<std::string>& flags) const {
    std::vector<std::string> args = {test::Tool("up"), rig_, "--session", session_};
    args.insert(args.end(), flags.begin(), flags.end());
    return test::Run(args);
  }
  test::Outcome Down() const { return test::Run({test::Tool("down"), "--session", session_}); }
  test::Outcome Status(const std::string& modules) const {
    return test::Run({test::Tool("status"), rig_, "--once", "--modules", modules});
  }
  pid_t PidOf(const std::string& module) const {
    const std::string config = session_ + "/supervisor.conf";
    return std::stoi(test::Run({"supervisorctl", "-c", config, "pid", module}).out);
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", test::ShortRigText());
  std::string session_ = folder_.path() / "a session";
};

TEST_F(Supervision, UpRunsTheModulesUntilDown) {
  const test::Outcome up = Up({"--only", "voq_selector,assessor", "--record"});
  ASSERT_EQ(up.status, 0) << up.err;
  EXPECT_THAT(up.out, HasSubstr("running: 3 programs"));
  EXPECT_EQ(ReadWholeFile(session_ + "/rig.yaml"), test::ShortRigText());

  const test::Outcome good = Status("voq_selector,assessor");
  EXPECT_EQ(good.status, 0) << good.out << good.err;
  EXPECT_THAT(good.out, AllOf(HasSubstr("\nsilent  nobody\n"), HasSubstr("\nlost    nothing\n")));
  const test::Outcome bad = Status("voq_selector,camera_driver");
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out, HasSubstr("\nsilent  camera_driver\n"));

  const test::Outcome again = Up({});
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.err, HasSubstr("running already"));

  const test::Outcome down = Down();
  EXPECT_EQ(down.status, 0) << down.err;
  EXPECT_THAT(ReadWholeFile(session_ + "/assessor.txt"), HasSubstr("assessor: info"));
  EXPECT_GT(std::filesystem::file_size(session_ + "/raw.lcm"), 0u);
  EXPECT_EQ(Down().status, 1);  // nothing is left to stop
}

TEST_F(Supervision, ASecondSessionOnTheNetworkIsRefused) {
  ASSERT_EQ(Up({"--only", "voq_selector"}).status, 0);
  const auto other = [this](const std::string& modules) {
    return test::Run(
        {test::Tool("up"), rig_, "--session", folder_.path() / "other", "--only", modules});
  };
  const test::Outcome refused = other("voq_selector,assessor");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("voq_selector of "), HasSubstr("a session runs on this network")));
  EXPECT_THAT(test::NamesIn(folder_.path()), Not(::testing::Contains("other")));
  // One session may run on two hosts, each with modules of its own.
  EXPECT_EQ(other("assessor").status, 0);
  test::Run({test::Tool("down"), "--session", folder_.path() / "other"});
}

// Neither reads a message of the other: the network is taken before anything is started.
TEST_F(Supervision, OfTwoSessionsThatStartAtOnceAtMostOneRuns) {
  const std::string second = folder_.path() / "second";
  test::Process other({test::Tool("up"), rig_, "--session", second, "--only", "voq_selector"},
                      folder_.path() / "second.txt");
  const test::Outcome first = Up({"--only", "voq_selector"});
  const bool has_second_started = other.Wait() == 0;
  EXPECT_FALSE(first.status == 0 && has_second_started);
  if (first.status != 0) {
    EXPECT_THAT(first.err, HasSubstr("on this network"));
    EXPECT_THAT(test::NamesIn(folder_.path()), Not(::testing::Contains("a session")));
  }
  if (!has_second_started) {
    EXPECT_THAT(ReadWholeFile(folder_.path() / "second.txt"), HasSubstr("on this network"));
    EXPECT_THAT(test::NamesIn(folder_.path()), Not(::testing::Contains("second")));
  }
  test::Run({test::Tool("down"), "--session", second});
}

TEST_F(Supervision, AFolderOfAnotherRigIsRefused) {
  std::filesystem::create_directories(session_);
  folder_.Write("a session/rig.yaml", "rig: another\n");
  folder_.Write("a session/samples.lcm", "samples");
  const test::Outcome refused = Up({"--only", "voq_selector"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("another rig file"), HasSubstr("< rig: another")));
  EXPECT_EQ(ReadWholeFile(session_ + "/rig.yaml"), "rig: another\n");
  ASSERT_EQ(Up({"--only", "voq_selector", "--new"}).status, 0);
  EXPECT_EQ(ReadWholeFile(session_ + "-2/rig.yaml"), test::ShortRigText());
  session_ += "-2";
}

TEST_F(Supervision, UpSaysThatADriverEndedAtOnce) {
  rig_ = folder_.Write(
      "rig.yaml",
      test::Replaced(test::ShortRigText(),
                     "lidar_driver:\n  source: simulator\n",
                     "lidar_driver:\n  source: vlp16\n  sensor: {pcap: no_such.pcap}\n"));
  const test::Outcome up = Up({"--only", "lidar_driver"});
  EXPECT_EQ(up.status, 1) << up.out;
  EXPECT_THAT(up.err, AllOf(HasSubstr("lidar_driver ended at once"), HasSubstr("no_such.pcap")));
}

TEST_F(Supervision, ADriverHasEndedOnlyInTheSessionThatRuns) {
  std::filesystem::create_directories(session_);
  const std::string end =
      "INFO spawned: 'camera_driver' with pid 9\n"
      "INFO exited: camera_driver (exit status 0; expected)\n";
  folder_.Write("a session/supervisord.log", end);
  const std::vector<std::string> status = {
      test::Tool("status"), rig_, "--session", session_, "--once", "--modules", "camera_driver"};
  EXPECT_THAT(test::Run(status).out, HasSubstr("\nsilent  camera_driver\n"));

  ASSERT_EQ(Up({"--only", "voq_selector"}).status, 0);
  std::ofstream(session_ + "/supervisord.log", std::ios::app) << end;
  EXPECT_THAT(test::Run(status).out, HasSubstr("camera_driver          done\n"));
}

TEST_F(Supervision, AKilledModuleIsStartedAgainAndARecorderThatEndedIsTold) {
  ASSERT_EQ(Up({"--only", "voq_selector", "--record"}).status, 0);
  const pid_t before = PidOf("voq_selector");
  kill(before, SIGKILL);
  const test::Outcome status = Status("voq_selector");
  EXPECT_EQ(status.status, 0) << status.out << status.err;
  EXPECT_NE(PidOf("voq_selector"), before);

  test::Run({"supervisorctl", "-c", session_ + "/supervisor.conf", "stop", "lcm-logger"});
  const test::Outcome told = test::Run(
      {test::Tool("status"), rig_, "--session", session_, "--once", "--modules", "voq_selector"});
  EXPECT_EQ(told.status, 1);
  EXPECT_THAT(told.out,
              AllOf(HasSubstr("WRONG   Nothing is recorded: lcm-logger was stopped\n"),
                    HasSubstr("note    voq_selector was started again")));
}

TEST_F(Supervision, DownEndsWhatAKilledSupervisorLeft) {
  std::filesystem::create_directories(session_);
  folder_.Write("a session/report.html", "of an earlier result");
  ASSERT_EQ(Up({"--only", "voq_selector", "--record"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(session_ + "/report.html"));
  kill(std::stoi(ReadWholeFile(session_ + "/supervisord.pid")), SIGKILL);
  const test::Outcome up = Up({"--only", "voq_selector"});
  EXPECT_EQ(up.status, 1);
  EXPECT_THAT(up.err, HasSubstr("its supervisor was killed"));
  const test::Outcome down = Down();
  EXPECT_EQ(down.status, 0) << down.err;
  EXPECT_THAT(down.out, HasSubstr("ending the 2 programs"));
}

TEST_F(Supervision, UpSaysWhyAModuleDoesNotStart) {
  session_ = folder_.path() / "session";
  std::filesystem::create_directories(session_ + "/samples.lcm");  // a folder in the way
  const test::Outcome up = Up({"--only", "sample_collector"});
  EXPECT_EQ(up.status, 1);
  EXPECT_THAT(up.err, AllOf(HasSubstr("sample_collector did not start"), HasSubstr("samples.lcm")));
  EXPECT_EQ(Down().status, 1);  // nothing is left running
}

TEST_F(Supervision, UpRefusesWhatItDoesNotKnow) {
  EXPECT_EQ(Up({"--only", "no_such_module"}).status, 2);
  EXPECT_EQ(Up({"--no-such-flag"}).status, 2);
  rig_ = folder_.Write("rig.yaml", "rig: [\n");
  EXPECT_EQ(Up({}).status, 1);
  EXPECT_THAT(test::NamesIn(folder_.path()), Not(::testing::Contains("a session")));
}

// The full numbers, of sessions and of faults: test/system/live_truth.py by hand.
TEST_F(Supervision, PageStatusAndExitStatusTellWhatFails) {
  const test::Outcome outcome =
      test::Run({std::string(VOQCAL_SOURCE_DIR) + "/test/system/live_truth.py",
                 "faults",
                 "--rig",
                 rig_,
                 "--tries",
                 "2",
                 "--out",
                 folder_.path() / "faults"});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

TEST_F(Supervision, ThePagesAddressIsAQrCodeForAPhone) {
  const auto tell = [this](const std::string& addresses) {
    const std::string file = folder_.Write("dashboard_url.txt", addresses);
    return test::Run({"bash", test::Tool("common/tell_page.sh"), file}).out;
  };
  EXPECT_THAT(tell("http://127.0.0.1:8765/token/\n"),
              AllOf(HasSubstr("the page: http://127.0.0.1:8765/token/\n"),
                    HasSubstr("no QR code: this host alone reaches it")));
  const std::string both = tell("http://192.0.2.7:8765/token/\nhttp://198.51.100.7:8765/token/\n");
  EXPECT_THAT(both, HasSubstr("or: http://198.51.100.7:8765/token/\n"));
  const bool has_qrencode = test::Run({"sh", "-c", "command -v qrencode"}).status == 0;
  EXPECT_THAT(both, HasSubstr(has_qrencode ? "\u2588\u2588" : "qrencode is not installed"));
}

// The full number of 50 kills: test/system/kill_test.py by hand.
TEST_F(Supervision, KilledModulesChangeNothingInTheEnd) {
  const test::Outcome outcome =
      test::Run({std::string(VOQCAL_SOURCE_DIR) + "/test/system/kill_test.py",
                 rig_,
                 "--out",
                 folder_.path() / "kills",
                 "--kills",
                 "3"});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace voqcal
