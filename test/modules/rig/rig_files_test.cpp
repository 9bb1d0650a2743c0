// The rig files that users copy from.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "files/number_text.hpp"
#include "files/yaml_reader.hpp"
#include "rig/rig.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

const std::filesystem::path kRigs = std::filesystem::path(VOQCAL_SOURCE_DIR) / "config/rigs";

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What follows the last "default " of a line; nothing if there is none.
std::string StatedDefault(const std::string& line) {
  const std::size_t at = line.rfind("default ");
  if (at == std::string::npos) return "";
  const std::string text = line.substr(at + std::string("default ").size());
  return text == "\"\"" ? "" : text;
}

/// Equal as text, or as numbers to the four digits that a comment shows.
bool IsSame(const std::string& stated, const std::string& actual) {
  double a = 0;
  double b = 0;
  const bool are_numbers = ParseNumber(stated, &a) && ParseNumber(actual, &b);
  return are_numbers ? std::abs(a - b) <= 1e-3 * std::abs(b) : stated == actual;
}

TEST(SimulatedRig, ListsEveryOptionWithItsTrueDefault) {
  const auto path = kRigs / "simulated_vlp16.yaml";
  const std::string text = ReadWholeFile(path);
  const std::vector<std::string> lines = LinesOf(text);
  YamlDocument document(path.string(), text);
  Rig rig;
  ReadRigSections({path, {}}, &document, &rig);
  document.ThrowIfWrong();
  EXPECT_GT(document.known_keys().size(), 60U);
  for (const YamlDocument::KnownKey& key : document.known_keys()) {
    if (key.line == 0) {
      ADD_FAILURE() << key.path << " is not in the file";
      continue;
    }
    const std::string& line = lines.at(static_cast<std::size_t>(key.line - 1));
    const bool has_default = line.rfind("default ") != std::string::npos;
    EXPECT_EQ(has_default, key.has_default) << key.path;
    if (has_default) {
      EXPECT_TRUE(IsSame(StatedDefault(line), key.default_text))
          << key.path << " defaults to " << key.default_text << ", but the file says: " << line;
    }
  }
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
