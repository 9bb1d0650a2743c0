#include "result/rig_extrinsics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "result/tree_text.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Eigen::Isometry3d Shifted(double x_m, double yaw_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.1, 0, yaw_rad});
  T.translation() = Eigen::Vector3d(x_m, 0.1, -0.2);
  return T;
}

// Where each is in the frame of the lidar top.
Eigen::Isometry3d T_top_sensor(const std::string& name) {  // NOLINT: named for its frames
  if (name == "side") return Shifted(0.3, 0.5);
  if (name == "left") return Shifted(-0.4, -0.2);
  if (name == "right") return Shifted(0.9, 0.1);
  return Eigen::Isometry3d::Identity();
}

CalibratedPair Pair(const std::string& lidar, const std::string& camera) {
  CalibratedPair pair;
  pair.extrinsic.from = lidar;
  pair.extrinsic.to = camera;
  pair.extrinsic.T_to_from = T_top_sensor(camera).inverse() * T_top_sensor(lidar);
  pair.extrinsic.covariance = 1e-6 * Matrix6d::Identity();
  pair.folder = lidar + "_" + camera;
  pair.verdict.grade = Grade::kGood;
  pair.verdict.headline = "Good.";
  pair.num_samples = 30;
  pair.samples_sha256 = "aa";
  return pair;
}

void Join(RigExtrinsics* result) {
  std::vector<SensorPair> used;
  for (const CalibratedPair& pair : result->pairs) {
    if (pair.problem.empty()) used.push_back(pair.extrinsic);
  }
  result->network = JoinPairs({"top", "side", "left", "right"}, "top", used);
}

RigExtrinsics TwoByTwo() {
  RigExtrinsics result;
  result.rig = "truck";
  result.lidars = {"top", "side"};
  result.cameras = {"left", "right"};
  result.pairs = {
      Pair("top", "left"), Pair("top", "right"), Pair("side", "left"), Pair("side", "right")};
  result.rig_sha256 = "bb";
  result.version = "1";
  Join(&result);
  return result;
}

RigExtrinsics WithOneLeftOut() {
  RigExtrinsics result = TwoByTwo();
  result.pairs[1].problem = "fewer than three samples";
  Join(&result);
  return result;
}

YAML::Node PairIn(const YAML::Node& yaml, const std::string& from, const std::string& to) {
  for (const YAML::Node& pair : yaml["pairs"]) {
    if (pair["from"].as<std::string>() == from && pair["to"].as<std::string>() == to) return pair;
  }
  return {};
}

TEST(RigExtrinsics, TheFileHasTheTreeEveryTwoSensorsAndTheClosures) {
  const RigExtrinsics result = TwoByTwo();
  const YAML::Node yaml = YAML::Load(ToYaml(result));
  EXPECT_EQ(yaml["verdict"]["grade"].as<std::string>(), "good");
  EXPECT_EQ(yaml["sensors"]["right"]["kind"].as<std::string>(), "camera");
  EXPECT_EQ(yaml["covariance_of"].size(), 4U);
  EXPECT_EQ(yaml["covariance"].size(), 24U);
  EXPECT_EQ(yaml["pairs"].size(), 6U);
  EXPECT_EQ(yaml["made_from"]["rig_sha256"].as<std::string>(), "bb");
  const YAML::Node stereo = PairIn(yaml, "left", "right");
  const Eigen::Isometry3d T_right_left = T_top_sensor("right").inverse() * T_top_sensor("left");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(
        stereo["T_to_from"]["translation_m"][i].as<double>(), T_right_left.translation()[i], 1e-9);
  }
  EXPECT_FALSE(stereo["calibrated"]);
  const YAML::Node own = PairIn(yaml, "side", "left");
  EXPECT_TRUE(own["calibrated"]["is_used"].as<bool>());
  EXPECT_EQ(own["calibrated"]["samples_sha256"].as<std::string>(), "aa");
  EXPECT_NEAR(own["closure"]["translation_mm"].as<double>(), 0, 1e-6);
  EXPECT_FALSE(own["closure"]["contradicts"].as<bool>());
}

TEST(RigExtrinsics, ReadsBackAsATree) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(RigResultFileAt(folder.path()));
  folder.Write(kRigResultName, ToYaml(TwoByTwo()));
  const auto file = RigResultFileAt(folder.path());
  ASSERT_TRUE(file);
  const SensorTree tree = ReadSensorTree(*file);
  EXPECT_EQ(tree.rig, "truck");
  ASSERT_EQ(tree.sensors.size(), 4U);
  EXPECT_EQ(tree.sensors[0].name, "top");
  EXPECT_FALSE(tree.is_to_be_mended);
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    EXPECT_TRUE(sensor.T_reference_sensor.isApprox(T_top_sensor(sensor.name), 1e-9)) << sensor.name;
    EXPECT_EQ(sensor.is_lidar, sensor.name == "top" || sensor.name == "side");
  }
}

TEST(RigExtrinsics, APairWithoutACalibrationIsToldAndFollowsFromTheOthers) {
  const RigExtrinsics result = WithOneLeftOut();
  const YAML::Node pair = PairIn(YAML::Load(ToYaml(result)), "top", "right");
  EXPECT_EQ(pair["calibrated"]["problem"].as<std::string>(), "fewer than three samples");
  EXPECT_FALSE(pair["closure"]);
  const Eigen::Isometry3d T = T_top_sensor("right").inverse();
  EXPECT_NEAR(pair["T_to_from"]["translation_m"][0].as<double>(), T.translation()[0], 1e-9);
  EXPECT_THAT(Summary(result),
              AllOf(HasSubstr("left out: fewer than three samples"),
                    HasSubstr("Closure: No pair can be tested by others")));
}

TEST(RigExtrinsics, TwoCamerasMayBeAPairWithoutASession) {
  RigExtrinsics result = TwoByTwo();
  CalibratedPair stereo = Pair("left", "right");
  stereo.extrinsic.T_to_from = T_top_sensor("right").inverse() * T_top_sensor("left");
  stereo.folder.clear();
  result.pairs.push_back(stereo);
  Join(&result);
  const YAML::Node pair = PairIn(YAML::Load(ToYaml(result)), "left", "right");
  EXPECT_EQ(pair["calibrated"]["num_samples"].as<int>(), 30);
  EXPECT_FALSE(pair["calibrated"]["folder"]);
  EXPECT_NEAR(pair["closure"]["rotation_deg"].as<double>(), 0, 1e-6);
  EXPECT_THAT(Summary(result), HasSubstr("left_right           -     30 samples"));
}

TEST(RigExtrinsics, ABadPairThatNothingElseTestsMakesTheRigBad) {
  RigExtrinsics tested = TwoByTwo();
  tested.pairs[2].verdict.grade = Grade::kBad;
  EXPECT_EQ(VerdictOf(tested).grade, Grade::kLook);
  RigExtrinsics alone = WithOneLeftOut();
  alone.pairs[2].verdict.grade = Grade::kBad;
  alone.pairs[2].verdict.checks = {{"Number of poses", Grade::kBad, "Only 4."}};
  EXPECT_EQ(VerdictOf(alone).grade, Grade::kBad);
  EXPECT_THAT(Summary(alone),
              AllOf(StartsWith("verdict  Do not use it: side_left, bad by itself and tested by no "
                               "other, is part of it; the others hold"),
                    HasSubstr("Not good by themselves: side_left (bad: Number of poses)")));
}

TEST(RigExtrinsics, AContradictionIsSaid) {
  RigExtrinsics result = TwoByTwo();
  result.pairs[0].extrinsic.T_to_from.translation().x() += 0.1;
  Join(&result);
  EXPECT_EQ(VerdictOf(result).grade, Grade::kLook);
  EXPECT_THAT(
      Summary(result),
      AllOf(HasSubstr("Closure: at least one of these pairs is wrong"), HasSubstr("contradicts")));
}

TEST(TreeText, NamesTheFormatsThatThereAre) {
  EXPECT_THROW(TreeText("opencv", SensorTree(), {}), std::invalid_argument);
}

SensorTree Tree() {
  SensorTree tree;
  tree.rig = "truck";
  tree.reference = "top";
  for (const char* name : {"top", "side", "left", "right"}) {
    const bool is_lidar = tree.sensors.size() < 2;
    tree.sensors.push_back({name, is_lidar, T_top_sensor(name)});
  }
  return tree;
}

TEST(TreeText, EveryFormatHasEverySensorThatItCanHave) {
  for (const std::string& format : TreeFormats()) {
    const std::string text = TreeText(format, Tree(), {});
    for (const char* name : {"top", "left", "right"}) {
      EXPECT_THAT(text, HasSubstr(name)) << format;
    }
    if (format != "kalibr") {
      EXPECT_THAT(text, HasSubstr("side")) << format;
    }
  }
}

TEST(TreeText, CamerasWithoutALensInTheCamchainAreNamed) {
  CameraModel known;
  CameraModel unknown;  // a fifth coefficient, which Kalibr's radtan has not
  unknown.distortion[4] = 0.1;
  EXPECT_THAT(CamerasWithoutKalibrLens(Tree(), {}), ElementsAre("left", "right"));
  EXPECT_THAT(CamerasWithoutKalibrLens(Tree(), {{"left", known}, {"right", unknown}}),
              ElementsAre("right"));
}

}  // namespace
}  // namespace voqcal
