// The dashboard as people use it: in a browser, with the real modules behind it.

#include <atomic>
#include <chrono>
#include <iostream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/assessment/worst_error.hpp"
#include "core/geometry/rigid.hpp"
#include "core/simulation/simulation.hpp"
#include "files/atomic_file.hpp"
#include "images/jpeg.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/wall_clock.hpp"
#include "result/result_file.hpp"
#include "support/sanitizers.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

constexpr char kWithNode[] = VOQCAL_SOURCE_DIR "/test/system/with_node.sh";
constexpr int kSkipped = 77;

std::string Script(const std::string& name) {
  return std::string(VOQCAL_SOURCE_DIR) + "/test/system/" + name;
}

class DashboardInBrowser : public ::testing::Test {
 protected:
  ~DashboardInBrowser() override {
    for (const std::string& session : {session_ + "/sensors", session_}) {
      test::Run({test::Tool("down"), "--session", session});
    }
  }

  void Up(const std::string& rig_text, const std::vector<std::string>& flags) {
    rig_ = folder_.Write("rig.yaml", rig_text);
    std::vector<std::string> args = {test::Tool("up"), rig_, "--session", session_};
    args.insert(args.end(), flags.begin(), flags.end());
    const test::Outcome up = test::Run(args);
    ASSERT_EQ(up.status, 0) << up.err;
  }

  test::TemporaryFolder folder_;
  std::string rig_;
  std::string session_ = folder_.path() / "session";
};

// Minutes of stops: more than the script needs, which ends the sensors itself.
TEST_F(DashboardInBrowser, RunsASessionFromStartToExportByClicks) {
  ASSERT_NO_FATAL_FAILURE(
      Up(test::Replaced(test::ShortRigText(), "num_poses: 8", "num_poses: 200"), {}));
  const test::Outcome outcome =
      test::Run({kWithNode, "node", Script("dashboard_session.mjs"), session_});
  if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

// The simulated board is held where the page asks, until it says that it is enough.
TEST_F(DashboardInBrowser, GuidesASessionFromStartToEnough) {
  constexpr double kToleranceMm = 5.0;
  std::string rig_text =
      test::Replaced(test::ShortRigText(), "follows_guidance: false", "follows_guidance: true");
  rig_text = test::Replaced(rig_text, "num_poses: 8", "num_poses: 40");
  rig_text = test::Replaced(
      rig_text, "\n  tolerance: 5.0", "\n  tolerance: " + std::to_string(kToleranceMm));
  const std::string readers =
      "lidar_board_detector,camera_board_detector,sample_collector,voq_selector,"
      "extrinsic_estimator,extrinsic_refiner,assessor,pose_guide,dashboard";
  ASSERT_NO_FATAL_FAILURE(Up(rig_text, {"--record", "--only", readers}));
  const test::Outcome outcome =
      test::Run({kWithNode, "node", Script("dashboard_guided.mjs"), session_});
  if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  std::cout << outcome.out;

  const Rig rig = LoadRig(rig_);
  const std::string result = session_ + "/extrinsic.yaml";
  const ErrorScene scene(
      rig.camera, rig.simulation.T_camera_lidar, rig.pose_guide.enough.tolerance);
  const Vector6d error = DifferenceLeft(rig.simulation.T_camera_lidar, ReadExtrinsic(result));
  // What was promised is an RMS: one session's error may well be larger.
  EXPECT_LT(scene.Worst(error * error.transpose()).error, 3.0 * kToleranceMm);

  // What was recorded gives the same result again.
  test::Run({test::Tool("down"), "--session", session_});
  const std::string offline = folder_.path() / "offline";
  const test::Outcome again = test::Run({test::Program("calibrate"),
                                         "--rig",
                                         rig_,
                                         "--log",
                                         session_ + "/raw.lcm",
                                         "--out",
                                         offline});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(ReadWholeFile(offline + "/extrinsic.yaml"), ReadWholeFile(result));
}

// Two lidars, three cameras: more stops than the script needs.
TEST_F(DashboardInBrowser, ShowsARigOfSeveralSensorsPairByPair) {
  VOQCAL_LEAVE_TO_RELEASE();
  ASSERT_NO_FATAL_FAILURE(
      Up(test::Replaced(test::SmallRigOfSeveralText(), "num_poses: 12", "num_poses: 300"), {}));
  const test::Outcome outcome =
      test::Run({kWithNode, "node", Script("dashboard_rig.mjs"), session_});
  if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

/// Sensors faster than the page is shown: one image at 30 Hz and one sweep at 20 Hz, again and
/// again, with the wall clock's times.
class FastSensors {
 public:
  explicit FastSensors(const Rig& rig) : rig_(rig), bus_(rig.lcm_url) {
    const Simulation simulation(rig.simulation, rig.board, rig.camera);
    jpeg_ = EncodeJpeg(simulation.Image(0), rig.camera_driver.jpeg_quality);
    sweep_ = simulation.Sweep(0);
  }

  /// Publishes until `is_done`.
  template <typename Condition>
  void Run(const Condition& is_done) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    for (std::int32_t tick = 0; !is_done(); ++tick) {  // 60 Hz
      std::this_thread::sleep_until(start + tick * std::chrono::microseconds(1000000 / 60));
      const std::int64_t utime = WallClockUs();
      if (tick % 2 == 0) {
        bus_.Publish(rig_.channels.camera_image, EncodedToMessage(jpeg_, utime, tick / 2));
      }
      if (tick % 3 == 0) {
        bus_.Publish(rig_.channels.lidar_points, ToMessage(sweep_, utime, tick / 3));
      }
    }
  }

 private:
  Rig rig_;
  Bus bus_;
  std::vector<std::uint8_t> jpeg_;
  PointCloud sweep_;
};

// A page that fell behind would grow older by the second: after ten seconds of twice what it can
// draw it would be five seconds old. A busy machine draws late, but not ever later.
TEST_F(DashboardInBrowser, DoesNotFallBehindFastSensors) {
  ASSERT_NO_FATAL_FAILURE(Up(test::SimulatedRigText(), {"--only", "dashboard"}));
  FastSensors sensors(LoadRig(rig_));
  test::Outcome outcome;
  std::atomic<bool> is_done{false};
  std::thread browser([&] {
    outcome = test::Run({kWithNode, "node", Script("dashboard_load.mjs"), session_, "10"});
    is_done = true;
  });
  sensors.Run([&is_done] { return is_done.load(); });
  browser.join();
  if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  std::cout << outcome.out;
  const auto figures = nlohmann::json::parse(outcome.out);
  for (const char* what : {"image", "cloud"}) {
    EXPECT_GT(figures[what]["rate_hz"].get<double>(), 1) << outcome.out;
    EXPECT_LT(figures[what]["median_age_s"].get<double>(), 3) << outcome.out;
  }
}

}  // namespace
}  // namespace voqcal
