// How good the detected boards of the real session are, judged by two things that the detector
// does not know: the camera, and an outline that a brute-force search lays over the cropped clouds.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/assessment/scores.hpp"
#include "core/lidar/plane_fit.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/median.hpp"
#include "result/poses_csv.hpp"
#include "support/real_data.hpp"
#include "support/real_sweeps.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRad = 3.14159265358979323846 / 180.0;

class RealBoards : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::RealDataFolder();
    if (!folder) GTEST_SKIP() << "no ../shared/data on this machine";
    folder_ = *folder / "acfr-vlp16";
  }

  PointCloud Sweep(std::int64_t pose, const std::string& kind) const {
    return test::LoadPcd(folder_ / "pcd" / ("pose" + std::to_string(pose) + "_" + kind + ".pcd"));
  }

  std::filesystem::path folder_;
};

TEST_F(RealBoards, LeaveOneOutIsWithinThreeAndAHalfMillimetres) {
  std::vector<BoardSample> samples = ReadPosesCsv(folder_ / "poses.csv", test::kAcfrBoard).samples;
  // The camera's half of pose 1 belongs to another capture than its cloud.
  samples.erase(
      std::remove_if(
          samples.begin(), samples.end(), [](const auto& sample) { return sample.id == 1; }),
      samples.end());
  ASSERT_EQ(samples.size(), 29U);
  Eigen::Matrix3Xd lidar_m(3, samples.size());
  Eigen::Matrix3Xd camera_m(3, samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto boards = DetectLidarBoard(Sweep(samples[i].id, "full"), test::kAcfrBoard, {});
    ASSERT_TRUE(boards) << "pose " << samples[i].id << ": " << ToString(boards.error());
    samples[i].lidar = boards->front();
    const auto column = static_cast<Eigen::Index>(i);
    lidar_m.col(column) = samples[i].lidar.pose.centre_m;
    camera_m.col(column) = samples[i].camera.pose.centre_m;
  }
  const Eigen::Isometry3d T_start(Eigen::umeyama(lidar_m, camera_m, false));
  const SceneScore score =
      LeaveOneOutScore(test::Pointers(samples), test::TestCamera(), T_start, {});
  RecordProperty("held_out_mm", std::to_string(score.centre_mm.mean));
  EXPECT_LE(score.centre_mm.mean, 3.5);
}

/// The plane that most points lie on: one that any three of them span.
PlaneFit PlaneOfMost(const std::vector<Eigen::Vector3d>& points_m, double band_m) {
  constexpr int kNumTrials = 300;  // half the points on the board: 1 in 8 trials is good
  test::Random random(7);
  PlaneFit best;
  std::size_t best_num = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    PlaneFit plane;
    plane.point_m = points_m[random.Index(points_m.size())];
    const Eigen::Vector3d a_m = points_m[random.Index(points_m.size())] - plane.point_m;
    const Eigen::Vector3d b_m = points_m[random.Index(points_m.size())] - plane.point_m;
    plane.normal = a_m.cross(b_m).normalized();
    const auto num = static_cast<std::size_t>(
        std::count_if(points_m.begin(), points_m.end(), [&](const auto& point_m) {
          return std::abs(plane.DistanceM(point_m)) < band_m;
        }));
    if (num > best_num) {
      best = plane;
      best_num = num;
    }
  }
  PointMoments moments;
  for (const auto& point_m : points_m) {
    if (std::abs(best.DistanceM(point_m)) < band_m) moments.Add(point_m);
  }
  return FitPlane(moments);
}

/// The centre of all places where a rectangle of the board's size holds nearly as many points as
/// it can anywhere.
Eigen::Vector3d CentreByBruteForce(const std::vector<Eigen::Vector3d>& points_m,
                                   const PlaneFit& plane,
                                   double band_m) {
  constexpr double kSpillM = 0.005;
  constexpr double kStepM = 0.01;
  constexpr int kReach = 15;         // steps from the points' mean
  constexpr double kNearly = 0.995;  // of the best count
  const Eigen::Vector3d e1 = plane.normal.unitOrthogonal();
  const Eigen::Vector3d e2 = plane.normal.cross(e1);
  std::vector<Eigen::Vector2d> in_plane_m;
  for (const auto& point_m : points_m) {
    if (std::abs(plane.DistanceM(point_m)) > band_m) continue;
    const Eigen::Vector3d offset_m = point_m - plane.point_m;
    in_plane_m.emplace_back(e1.dot(offset_m), e2.dot(offset_m));
  }
  const double half_x_m = test::kAcfrBoard.width_m / 2 + kSpillM;
  const double half_y_m = test::kAcfrBoard.height_m / 2 + kSpillM;
  struct Place {
    Eigen::Vector2d centre_m;
    int num;
  };
  std::vector<Place> places;
  for (int degrees = 0; degrees < 180; degrees += 3) {
    const Eigen::Rotation2Dd R(degrees * kRad);
    std::vector<Eigen::Vector2d> turned_m;
    for (const auto& p_m : in_plane_m) turned_m.push_back(R.inverse() * p_m);
    for (int i = -kReach; i <= kReach; ++i) {
      for (int j = -kReach; j <= kReach; ++j) {
        const Eigen::Vector2d centre_m(i * kStepM, j * kStepM);
        const auto num = std::count_if(turned_m.begin(), turned_m.end(), [&](const auto& p_m) {
          return std::abs(p_m.x() - centre_m.x()) < half_x_m &&
                 std::abs(p_m.y() - centre_m.y()) < half_y_m;
        });
        places.push_back({R * centre_m, static_cast<int>(num)});
      }
    }
  }
  int most = 0;
  for (const Place& place : places) most = std::max(most, place.num);
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  int num_places = 0;
  for (const Place& place : places) {
    if (place.num < kNearly * most) continue;
    sum_m += place.centre_m;
    ++num_places;
  }
  const Eigen::Vector2d centre_m = sum_m / num_places;
  return plane.point_m + centre_m.x() * e1 + centre_m.y() * e2;
}

TEST_F(RealBoards, AgreeWithFitsToTheHandCroppedClouds) {
  VOQCAL_LEAVE_TO_RELEASE();
  constexpr double kBandM = 0.03;  // three sigma of this lidar
  std::vector<double> centre_errors_m;
  std::vector<double> normal_errors_rad;
  for (const BoardSample& sample : ReadPosesCsv(folder_ / "poses.csv", test::kAcfrBoard).samples) {
    const auto boards = DetectLidarBoard(Sweep(sample.id, "full"), test::kAcfrBoard, {});
    ASSERT_TRUE(boards) << "pose " << sample.id << ": " << ToString(boards.error());
    std::vector<Eigen::Vector3d> points_m;
    for (const LidarPoint& point : Sweep(sample.id, "target").points) {
      points_m.push_back(point.position_m.cast<double>());
    }
    const PlaneFit plane = PlaneOfMost(points_m, kBandM);
    const BoardPose& pose = boards->front().pose;
    centre_errors_m.push_back((pose.centre_m - CentreByBruteForce(points_m, plane, kBandM)).norm());
    normal_errors_rad.push_back(AngleBetween(pose.normal, plane.normal));
  }
  ASSERT_EQ(centre_errors_m.size(), 30U);
  RecordProperty("centre_median_mm", std::to_string(1e3 * Median(centre_errors_m)));
  RecordProperty("normal_median_rad", std::to_string(Median(normal_errors_rad)));
  EXPECT_LE(Median(centre_errors_m), 0.010);
  EXPECT_LE(Median(normal_errors_rad), 1.5 * kRad);
}

}  // namespace
}  // namespace voqcal
