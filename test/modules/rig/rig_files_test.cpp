// The rig files that users copy from.
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/option_section.hpp"
#include "rig/default_rig.hpp"
#include "rig/rig.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

using testing::EndsWith;

const std::filesystem::path kRigs = std::filesystem::path(VOQCAL_SOURCE_DIR) / "config/rigs";

/// What is known of a rig file's keys, whose pair of sensors `place` names.
std::vector<YamlDocument::KnownKey> KnownKeys(const RigPlace& place,
                                              const std::string& text,
                                              Rig* rig) {
  YamlDocument document(place.file.string(), text);
  ReadRigSections(place, &document, rig);
  document.ThrowIfWrong();
  return document.known_keys();
}

TEST(ExampleRigs, HaveKeysWithMeaningsAlone) {
  for (const char* name :
       {"simulated_vlp16", "acfr_vlp16", "several_sensors", "simulated_several"}) {
    for (const auto& path : PairsOfRig(kRigs / (std::string(name) + ".yaml"))) {
      const RigPlace place = PlaceOfRig(path);
      Rig rig;
      const auto keys = KnownKeys(place, ReadWholeFile(place.file), &rig);
      EXPECT_GT(keys.size(), 200U);
      for (const auto& key : keys) EXPECT_FALSE(key.meaning.empty()) << name << ": " << key.path;
    }
  }
}

// What it prints for itself is what it was printed from: every key is read as it was shown.
TEST(DefaultRig, ReadsAsItWasPrinted) {
  const std::string text = DefaultRigText();
  Rig rig;
  EXPECT_THAT(text, EndsWith(DocumentedYaml(KnownKeys({"rig.yaml", {}}, text, &rig))));
  EXPECT_EQ(rig.rig_name, "my_rig");
  EXPECT_EQ(rig.lcm_url, kDefaultLcmUrl);
  EXPECT_EQ(rig.extrinsic_estimator.sigma_normal_rad, SetExtrinsicOptions().sigma_normal_rad);
  EXPECT_EQ(rig.pose_guide.sensors.max_azimuth_rad, SensorExpectation().max_azimuth_rad);
  EXPECT_FALSE(rig.T_camera_lidar_guess);
  EXPECT_FALSE(rig.lidar_board_detector.region_of_interest);
}

TEST(DefaultRig, TakesWhatTheUserWritesInstead) {
  std::string text = DefaultRigText();
  const auto set = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  set("\n  num_sets: 50", "\n  num_sets: 51");
  set("\n  # min_new_angle_deg: 2.865", "\n  min_new_angle_deg: 90");
  set("\n  # region_of_interest:", "\n  region_of_interest:");
  set("\n  # T_camera_lidar_guess:", "\n  T_camera_lidar_guess:");
  Rig rig;
  KnownKeys({"rig.yaml", {}}, text, &rig);
  EXPECT_EQ(rig.voq_selector.num_sets, 51);
  EXPECT_EQ(rig.sample_collector.min_new_angle_rad, 90 * kRadPerDeg);
  EXPECT_TRUE(rig.lidar_board_detector.region_of_interest);
  EXPECT_TRUE(rig.T_camera_lidar_guess);
}

TEST(DefaultRig, FitsIntoAHundredColumns) {
  std::istringstream lines(DefaultRigText());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(SimulatedRig, LooksForwardNearTheLidar) {
  const Rig rig = LoadRig(kRigs / "simulated_vlp16.yaml");
  const Eigen::Isometry3d& T_camera_lidar = rig.simulation.T_camera_lidar;
  // Camera z is near lidar x, camera x near lidar -y: within the few degrees of the mounting.
  EXPECT_GT(T_camera_lidar.linear()(2, 0), std::cos(5 * M_PI / 180));
  EXPECT_LT(T_camera_lidar.linear()(0, 1), -std::cos(5 * M_PI / 180));
  EXPECT_NEAR(T_camera_lidar.translation().norm(), 0.12, 0.02);
  EXPECT_EQ(rig.lidar_driver.source, LidarDriverOptions::Source::kSimulator);
  EXPECT_EQ(rig.camera_driver.rate_hz, 5);
}

TEST(SimulatedRig, SeesAboutAHundredDegrees) {
  const CameraModel camera = LoadRig(kRigs / "simulated_vlp16.yaml").camera;
  const double y_px = camera.cy_px;
  const auto left = camera.Unproject(Eigen::Vector2d(0, y_px));
  const auto right = camera.Unproject(Eigen::Vector2d(camera.width_px - 1, y_px));
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(std::acos(left->dot(*right)) * 180 / M_PI, 100, 1);
}

TEST(AcfrRig, IsTheRigOfTheRealSession) {
  const Rig rig = LoadRig(kRigs / "acfr_vlp16.yaml");
  EXPECT_EQ(rig.camera.lens, LensModel::kEquidistant);
  EXPECT_EQ(rig.camera.distortion[3], -0.0515253);
  EXPECT_EQ(rig.board.height_m, 0.85);
  EXPECT_EQ(rig.sample_collector.num_still_frames, 1);
}

TEST(SeveralSensors, AreFourPairs) {
  const std::vector<Rig> pairs = LoadPairs(kRigs / "several_sensors.yaml");
  ASSERT_EQ(pairs.size(), 4U);
  EXPECT_EQ(pairs[0].name, "truck_front_left");
  EXPECT_EQ(pairs[3].channels.camera_image, "RIGHT_CAMERA");
  EXPECT_EQ(pairs[3].lidar_board_detector.max_range_m, 20);
}

}  // namespace
}  // namespace voqcal
