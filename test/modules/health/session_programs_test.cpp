#include "health/session_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "health/heartbeats.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr char kTruck[] = "rig: truck\nlidars: {front: , rear: }\ncameras: {left: , right: }\n";

std::vector<std::string> NamesOf(const std::vector<SessionProgram>& programs) {
  std::vector<std::string> names;
  for (const SessionProgram& each : programs) names.push_back(each.name);
  return names;
}

TEST(SessionPrograms, OfSeveralSensorsADriverAndADetectorEachAndACollectorAPair) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", kTruck);
  const std::vector<SessionProgram> programs = ProgramsOfRig(path + "#front,left,right");
  EXPECT_THAT(NamesOf(programs),
              ElementsAre("lidar_driver_front",
                          "camera_driver_left",
                          "camera_driver_right",
                          "lidar_board_detector_front",
                          "camera_board_detector_left",
                          "camera_board_detector_right",
                          "sample_collector_front_left",
                          "sample_collector_front_right",
                          "rig_calibrator",
                          "dashboard"));
  EXPECT_EQ(programs[1].sensors, "left");
  EXPECT_EQ(programs[1].folder, "");
  EXPECT_EQ(programs[7].sensors, "front,right");
  EXPECT_EQ(programs[7].folder, "front_right");
  EXPECT_THAT(ProgramsOfRig(path), SizeIs(4 + 4 + 4 + 2));
}

TEST(SessionPrograms, OfAPairEveryModuleByItsOwnName) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", kTruck);
  EXPECT_EQ(NamesOf(ProgramsOfRig(path + "#front,left")), AllModuleNames());
  EXPECT_EQ(NamesOf(ProgramsOfRig(folder.Write("one.yaml", "rig: one\n"))), AllModuleNames());
}

TEST(SessionPrograms, ANameTellsItsModule) {
  EXPECT_EQ(ModuleOf("lidar_driver"), "lidar_driver");
  EXPECT_EQ(ModuleOf("sample_collector_front_left"), "sample_collector");
  EXPECT_EQ(ModuleOf("rig_calibrator"), "rig_calibrator");
  EXPECT_EQ(ModuleOf("extrinsic_monitor"), "");
  EXPECT_EQ(ModuleOf("lidar_drivers"), "");
  EXPECT_TRUE(IsDriver("camera_driver_left"));
  EXPECT_FALSE(IsDriver("sample_collector_x_driver"));
}

module_status_t StatusOf(const std::string& module, const std::string& session) {
  module_status_t status{};
  status.module = module;
  status.session = session;
  status.state = "running";
  return status;
}

TEST(SessionPrograms, APairsSessionWithinARigsIsNoRival) {
  Heartbeats heartbeats;
  const Heartbeats::Time now{};
  heartbeats.Take(StatusOf("lidar_driver_front", "host:/logs/truck"), now);
  heartbeats.Take(StatusOf("sample_collector_front_left", "host:/logs/truck/front_left"), now);
  EXPECT_THAT(heartbeats.Rivals(now, "host:/logs/truck", {"front_left"}), IsEmpty());
  EXPECT_THAT(heartbeats.Rivals(now, "host:/logs/truck"), SizeIs(1));  // another's, in its folder
  EXPECT_THAT(heartbeats.Rivals(now), IsEmpty());
  EXPECT_THAT(heartbeats.Rivals(now, "host:/logs/tru"), SizeIs(2));
}

TEST(SessionPrograms, ThePagesOfTwoPairsAreNoRivals) {
  Heartbeats heartbeats;
  const Heartbeats::Time now{};
  for (const char* pair : {"host:/logs/truck/front_left", "host:/logs/truck/front_right"}) {
    heartbeats.Take(StatusOf("dashboard", pair), now);
    heartbeats.Take(StatusOf("pose_guide", pair), now);
  }
  EXPECT_THAT(heartbeats.Rivals(now), IsEmpty());
  for (const char* pair : {"host:/logs/truck/front_left", "host:/logs/truck/front_right"}) {
    heartbeats.Take(StatusOf("assessor", pair), now);
  }
  EXPECT_THAT(heartbeats.Rivals(now), SizeIs(1));
}

}  // namespace
}  // namespace voqcal
