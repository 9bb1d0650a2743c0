#include "core/simulation/simulation.hpp"

#include <functional>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulated_rig.hpp"

namespace voqcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// With every fault at its default.
test::SimulatedRig FaultyRig(std::uint32_t seed) {
  test::SimulatedRig rig = test::CleanRig();
  SimulationOptions options;
  options.T_camera_lidar = rig.options.T_camera_lidar;
  options.num_poses = 4;
  options.seed = seed;
  rig.options = options;
  rig.camera = test::HalfSize(test::HalfSize(rig.camera));  // rendered often
  return rig;
}

Simulation SimulationOf(const test::SimulatedRig& rig) {
  return Simulation(rig.options, rig.board, rig.camera);
}

bool AreSame(const PointCloud& a, const PointCloud& b) {
  return std::equal(a.points.begin(),
                    a.points.end(),
                    b.points.begin(),
                    b.points.end(),
                    [](const LidarPoint& p, const LidarPoint& q) {
                      return p.position_m == q.position_m && p.intensity == q.intensity &&
                             p.ring == q.ring && p.time_s == q.time_s;
                    });
}

bool AreSame(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(Simulation, IsAFunctionOfOptionsAndTime) {
  const Simulation one = SimulationOf(FaultyRig(5));
  const Simulation other = SimulationOf(FaultyRig(5));
  for (const double time_s : {2.0, 0.3, 1.2}) {
    EXPECT_TRUE(AreSame(one.Sweep(time_s), other.Sweep(time_s))) << time_s;
    EXPECT_TRUE(AreSame(one.Image(time_s), other.Image(time_s))) << time_s;
  }
  // In another order, after other frames.
  EXPECT_TRUE(AreSame(one.Sweep(2.0), other.Sweep(2.0)));
  EXPECT_TRUE(AreSame(one.Image(2.0), other.Image(2.0)));
}

TEST(Simulation, ChangesWithTimeAndSeed) {
  const Simulation one = SimulationOf(FaultyRig(5));
  const Simulation other = SimulationOf(FaultyRig(6));
  EXPECT_FALSE(AreSame(one.Sweep(0.3), one.Sweep(0.4)));
  EXPECT_FALSE(AreSame(one.Image(0.3), one.Image(0.4)));
  EXPECT_FALSE(AreSame(one.Sweep(0.3), other.Sweep(0.3)));
  EXPECT_FALSE(AreSame(one.Image(0.3), other.Image(0.3)));
  EXPECT_NE(one.T_lidar_board(0.3).matrix(), other.T_lidar_board(0.3).matrix());
}

TEST(Simulation, SeesTheBoardAmongClutterWithEveryPattern) {
  for (const ScanPattern pattern :
       {ScanPattern::kVlp16, ScanPattern::kRaster, ScanPattern::kRosette}) {
    test::SimulatedRig rig = FaultyRig(9);
    rig.options.num_poses = 2;
    rig.options.min_distance_m = 2.5;
    rig.options.scan.pattern = pattern;
    rig.options.has_clutter = true;
    rig.options.second_board_scale = 1.3;
    const Simulation simulation = SimulationOf(rig);
    for (const double time_s : {0.5, 2.0}) {
      const Eigen::Isometry3d T_board_lidar = simulation.T_lidar_board(time_s).inverse();
      int num_on_board = 0;
      for (const LidarPoint& point : simulation.Sweep(time_s).points) {
        const Eigen::Vector3d point_board_m = T_board_lidar * point.position_m.cast<double>();
        // Six sigma of noise, ring bias and shade, and a board of 0.61 x 0.85 m.
        if (std::abs(point_board_m.z()) < 0.09 && point_board_m.head<2>().norm() < 0.3) {
          ++num_on_board;
        }
      }
      EXPECT_GT(num_on_board, 50) << ToString(pattern);
    }
  }
}

TEST(Simulation, RefusesBadOptions) {
  test::SimulatedRig rig = FaultyRig(1);
  rig.options.num_poses = 0;
  try {
    SimulationOf(rig);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("simulation: num_poses must be at least 1, is 0"));
  }
  rig = FaultyRig(1);
  rig.board.square_m = 0.0;
  EXPECT_THROW(SimulationOf(rig), std::invalid_argument);
  rig = FaultyRig(1);
  rig.camera.fx_px = 0.0;
  EXPECT_THROW(SimulationOf(rig), std::invalid_argument);
}

TEST(SimulationOptionsProblems, NoneByDefault) {
  EXPECT_THAT(SimulationOptions().Problems(), IsEmpty());
}

TEST(SimulationOptionsProblems, NamesTheRuleAndTheValue) {
  const auto problems_after = [](const std::function<void(SimulationOptions&)>& change) {
    SimulationOptions options;
    change(options);
    return options.Problems();
  };
  using Options = SimulationOptions;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(problems_after([](Options& o) { o.T_camera_lidar.linear() *= 2; }),
              ElementsAre(HasSubstr("T_camera_lidar must be a rotation and a translation")));
  EXPECT_THAT(problems_after([](Options& o) { o.T_camera_lidar.translation().x() = 3; }),
              ElementsAre(HasSubstr("within 1 m of the lidar: |t|, is 3")));
  EXPECT_THAT(problems_after([](Options& o) { o.num_poses = 0; }),
              ElementsAre("num_poses must be at least 1, is 0"));
  EXPECT_THAT(problems_after([](Options& o) { o.hold_s = 0; }),
              ElementsAre("hold_s must be positive, is 0"));
  EXPECT_THAT(problems_after([](Options& o) { o.move_s = -1; }),
              ElementsAre("move_s must be positive, is -1"));
  EXPECT_THAT(problems_after([](Options& o) { o.min_distance_m = 0; }),
              ElementsAre("min_distance_m must be positive, is 0"));
  EXPECT_THAT(problems_after([](Options& o) { o.max_distance_m = 1; }),
              ElementsAre("max_distance_m must be at least min_distance_m, is 1"));
  EXPECT_THAT(problems_after([](Options& o) { o.second_board_scale = 3; }),
              ElementsAre("second_board_scale must be 0 or within 0.2 and 2, is 3"));
  EXPECT_THAT(problems_after([](Options& o) { o.scan.dense_to_rad = -1; }),
              ElementsAre(HasSubstr("dense_from_deg must be at most dense_to_deg")));
  EXPECT_THAT(problems_after([](Options& o) { o.range_noise_m = -0.01; }),
              ElementsAre("range_noise_m must not be negative, is -0.01"));
  EXPECT_THAT(problems_after([](Options& o) { o.ring_bias_m = -0.01; }),
              ElementsAre("ring_bias_m must not be negative, is -0.01"));
  EXPECT_THAT(problems_after([=](Options& o) { o.common_bias_m = kNaN; }),
              ElementsAre("common_bias_m must be finite, is nan"));
  EXPECT_THAT(problems_after([=](Options& o) { o.dark_bias_m = kNaN; }),
              ElementsAre("dark_bias_m must be finite, is nan"));
  EXPECT_THAT(problems_after([](Options& o) { o.intensity_noise = -1; }),
              ElementsAre("intensity_noise must not be negative, is -1"));
  EXPECT_THAT(problems_after([](Options& o) { o.beam_divergence_rad = 0.1; }),
              ElementsAre("beam_divergence_deg must be within 0 and 2.86, is 5.72958"));
  EXPECT_THAT(problems_after([](Options& o) { o.dropout = 1; }),
              ElementsAre(HasSubstr("dropout must be")));
  EXPECT_THAT(problems_after([](Options& o) { o.image_noise = -2; }),
              ElementsAre("image_noise must not be negative, is -2"));
  EXPECT_THAT(problems_after([](Options& o) { o.image_blur_px = 11; }),
              ElementsAre("image_blur_px must be within 0 and 10, is 11"));
}

}  // namespace
}  // namespace voqcal
