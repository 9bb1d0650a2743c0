// calibrate_rig: a rig of several sensors from one recording, and what is said where it cannot be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "core/geometry/rigid.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "result/camera_yaml.hpp"
#include "result/rig_extrinsics.hpp"
#include "rig/board_lines.hpp"
#include "support/simulated_rig_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string RigText(const RigSimulationOptions& rig) {
  std::string text = "rig: truck\n";
  for (const std::string& line : BoardSectionLines(test::TestBoard())) text += line + "\n";
  text += "sample_collector: {num_still_frames: 1}\nlidars:\n";
  for (const auto& lidar : rig.lidars) text += "  " + lidar.name + ":\n";
  text += "cameras:\n";
  for (const auto& camera : rig.cameras) {
    text += "  " + camera.name + ":\n    camera:\n" + CameraYaml(camera.model, "      ");
  }
  return text;
}

class CalibrateRig : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  test::Outcome Run(const std::string& place, const std::vector<std::string>& flags = {}) const {
    std::vector<std::string> args = {
        test::Program("calibrate_rig"), rig_ + place, "--log", log_, "--out", out_};
    args.insert(args.end(), flags.begin(), flags.end());
    return test::Run(args);
  }

  /// A log with nothing but one unreadable message on each of these channels.
  void WriteEmptyLog(const std::vector<std::string>& channels) const {
    LogWriter log(log_);
    for (const std::string& channel : channels) log.Write({0, 1, channel, {1, 2, 3}});
  }

  test::TemporaryFolder folder_;
  RigSimulationOptions truth_ = test::SmallRig();
  std::string rig_ = folder_.Write("rig.yaml", RigText(truth_));
  std::string log_ = Path("raw.lcm");
  std::string out_ = Path("out");
};

Eigen::Isometry3d TransformOf(const YAML::Node& node) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) T(i, j) = node["matrix"][i][j].as<double>();
  }
  return T;
}

YAML::Node PairIn(const YAML::Node& result, const std::string& from, const std::string& to) {
  for (const YAML::Node& pair : result["pairs"]) {
    if (pair["from"].as<std::string>() == from && pair["to"].as<std::string>() == to) return pair;
  }
  ADD_FAILURE() << "no pair " << from << ", " << to;
  return {};
}

TEST_F(CalibrateRig, JoinsEveryPairOfTwoLidarsAndTwoCameras) {
  test::WriteStopsLog(truth_, test::TestBoard(), log_);
  const test::Outcome outcome = Run("", {"--reference", "rear", "--require", "usable"});
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  std::cout << outcome.out;  // the figures, for who reads the tests' log
  const YAML::Node result = YAML::LoadFile(out_ + "/rig_extrinsics.yaml");
  EXPECT_EQ(result["reference"].as<std::string>(), "rear");
  EXPECT_EQ(result["covariance"].size(), 24U);
  EXPECT_EQ(result["pairs"].size(), 6U);

  // Every pair of sensors, those of one kind too, within what it says of itself: 4 sigma of each of
  // six numbers.
  const auto expect_near =
      [&](const std::string& from, const std::string& to, const Eigen::Isometry3d& T_to_from) {
        const YAML::Node pair = PairIn(result, from, to);
        const Vector6d error = DifferenceLeft(T_to_from, TransformOf(pair["T_to_from"]));
        for (int i = 0; i < 6; ++i) {
          const double sigma = std::sqrt(pair["covariance"][i][i].as<double>());
          EXPECT_LT(std::abs(error[i]), 4 * sigma) << from << ", " << to << ": " << i;
          EXPECT_LT(sigma, i < 3 ? 0.3 * kRadPerDeg : 0.01) << from << ", " << to << ": " << i;
        }
      };
  const auto& lidars = truth_.lidars;
  const auto& cameras = truth_.cameras;
  expect_near("front", "rear", lidars[1].T_rig_lidar.inverse() * lidars[0].T_rig_lidar);
  expect_near("left", "right", cameras[1].T_camera_rig * cameras[0].T_camera_rig.inverse());
  for (const SimulatedLidar& lidar : lidars) {
    for (const SimulatedCamera& camera : cameras) {
      expect_near(lidar.name, camera.name, camera.T_camera_rig * lidar.T_rig_lidar);
      EXPECT_TRUE(PairIn(result, lidar.name, camera.name)["closure"]);
    }
  }
  EXPECT_GT(PairIn(result, "left", "right")["calibrated"]["num_samples"].as<int>(), 8);

  // The pair's own session is what calibrate makes of the pair alone, byte for byte.
  const test::Outcome alone = test::Run({test::Program("calibrate"),
                                         "--rig",
                                         rig_ + "#rear,right",
                                         "--log",
                                         log_,
                                         "--out",
                                         Path("alone")});
  ASSERT_EQ(alone.status, 0) << alone.err;
  for (const char* name : {"/extrinsic.yaml", "/samples.lcm", "/result.json"}) {
    EXPECT_EQ(ReadWholeFile(Path("alone") + name), ReadWholeFile(out_ + "/rear_right" + name))
        << name;
  }
}

// Its topics have the sensors' names.
TEST_F(CalibrateRig, TakesARecordingOfRos) {
  const std::string folder = std::string(VOQCAL_SOURCE_DIR) + "/test/system/";
  test::WriteStopsLog(truth_, test::TestBoard(), log_);
  const test::Outcome made = test::Run(
      {folder + "with_node.sh", "node", folder + "log_to_recording.mjs", log_, Path("raw.bag")});
  if (made.status == 77) GTEST_SKIP() << made.out;
  ASSERT_EQ(made.status, 0) << made.err;
  ASSERT_EQ(Run("").status, 0);
  const std::string expected = ReadWholeFile(out_ + "/rig_extrinsics.yaml");
  std::string rig = rig_;
  const auto run_bag = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> args = {
        test::Program("calibrate_rig"), rig, "--bag", Path("raw.bag"), "--out", Path("of_bag")};
    args.insert(args.end(), flags.begin(), flags.end());
    return test::Run(args);
  };
  const test::Outcome outcome = run_bag({});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(ReadWholeFile(Path("of_bag/rig_extrinsics.yaml")), expected);
  std::filesystem::remove_all(Path("of_bag"));
  EXPECT_EQ(run_bag({"--topic", "lefd=/x"}).err,
            "calibrate_rig: --topic lefd=/x must be a sensor of " + rig_ +
                ", is 'lefd' (did you mean left?); it has front, rear, left, right\n");
  const auto expect_no_topic = [&](const std::string& sensor) {
    const test::Outcome none = run_bag({"--topic", sensor + "=/x"});
    EXPECT_EQ(none.status, 1);
    EXPECT_THAT(none.err, HasSubstr("no topic /x of type sensor_msgs/"));
    EXPECT_FALSE(std::filesystem::exists(Path("of_bag")));
  };
  expect_no_topic("left");
  rig = folder_.Write("pair.yaml", test::SimulatedRigText());  // its sensors have no names
  expect_no_topic("lidar");
}

TEST_F(CalibrateRig, NamesTheSensorThatIsNotInTheLogAndHowToGoOnWithoutIt) {
  WriteEmptyLog({"LIDAR_POINTS_front", "LIDAR_POINTS_rear", "CAMERA_IMAGE_left", "IMU"});
  const test::Outcome outcome = Run("");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "calibrate_rig: " + log_ +
                ": has no channel CAMERA_IMAGE_right (right); it has CAMERA_IMAGE_left, IMU, "
                "LIDAR_POINTS_front, LIDAR_POINTS_rear. Name each sensor's own channel under its "
                "`channels`, or leave sensors out: " +
                rig_ + "#front,rear,left\n");
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(CalibrateRig, SaysWhyThereIsNoRigWhereNoBoardIsSeen) {
  WriteEmptyLog({"LIDAR_POINTS_front", "LIDAR_POINTS_rear", "CAMERA_IMAGE_left"});
  const test::Outcome outcome = Run("#left");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("front_left: "),
                    HasSubstr("no calibration of the rig: no pair joins these parts of the rig: "
                              "front | rear | left"),
                    HasSubstr("hold the board where")));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rig_extrinsics.yaml"));
}

TEST_F(CalibrateRig, RefusesWhatIsNoSensorAndNoLog) {
  const test::Outcome reference = Run("", {"--reference", "reer"});
  EXPECT_EQ(reference.status, 1);
  EXPECT_THAT(reference.err,
              HasSubstr("--reference must be a sensor of " + rig_ +
                        ", is 'reer' (did you mean rear?); it has front, rear, left, right"));
  const test::Outcome name = Run("#front,lefd");
  EXPECT_EQ(name.status, 1);
  EXPECT_THAT(name.err, HasSubstr("has no sensor 'lefd' (did you mean left?)"));
  const test::Outcome log = Run("");
  EXPECT_EQ(log.status, 1);
  EXPECT_THAT(log.err, HasSubstr(log_ + ": no such file"));
  folder_.Write("out", "a file");
  WriteEmptyLog({"X"});
  EXPECT_THAT(Run("").err, HasSubstr("is in the way"));
}

TEST_F(CalibrateRig, AProgramForOnePairAsksForOne) {
  const test::Outcome outcome =
      test::Run({test::Program("calibrate"), "--rig", rig_, "--log", log_, "--out", out_});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("name a pair of them, as in " + rig_ + "#front,left"));
  const test::Outcome check = test::Run({test::Program("check_rig"), rig_});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out,
              AllOf(HasSubstr("rig        truck\n"),
                    HasSubstr("lidar      rear: reads LIDAR_POINTS_rear"),
                    HasSubstr("pair       " + rig_ + "#rear,right")));
  const test::Outcome channels = test::Run({test::Program("check_rig"), rig_, "--input-channels"});
  EXPECT_THAT(channels.out, AllOf(HasSubstr("|CAMERA_IMAGE_right|"), Not(HasSubstr("BOARD"))));
}

}  // namespace
}  // namespace voqcal
