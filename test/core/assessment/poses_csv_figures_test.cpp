// The figures that the method must reach on the real session's features (poses.csv of acfr-vlp16).

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "core/assessment/scores.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "core/estimation/average.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/selection/consistency.hpp"
#include "core/selection/voq.hpp"
#include "result/poses_csv.hpp"
#include "support/real_data.hpp"
#include "support/real_sweeps.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

class PosesCsvFigures : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto data = test::RealDataFolder();
    if (!data) GTEST_SKIP() << "no ../shared/data and no VOQCAL_DATA";
    csv_ = ReadPosesCsv(*data / "acfr-vlp16" / "poses.csv", test::TestBoard());
    all_ = test::Pointers(csv_.samples);
  }

  AveragedExtrinsic Average() const {
    std::vector<SetExtrinsic> extrinsics;
    for (const VoqSet& set : SelectByVoq(csv_.samples, test::TestBoard(), 50)) {
      std::vector<const BoardSample*> members;
      for (const int i : set.samples) members.push_back(all_[static_cast<std::size_t>(i)]);
      extrinsics.push_back(EstimateSetExtrinsic(members, camera_, {}));
    }
    return AverageExtrinsics(extrinsics, {});
  }

  CameraModel camera_ = test::TestCamera();
  PosesCsv csv_;
  std::vector<const BoardSample*> all_;
};

TEST_F(PosesCsvFigures, EveryRowIsConsistent) {
  // Pose 1's row belongs to another image and cloud, but both its halves do: it agrees with the
  // rest.
  EXPECT_EQ(FindConsistent(csv_.samples, {}).consistent.size(), 30u);
}

TEST_F(PosesCsvFigures, AHalfOfAnotherCaptureIsFound) {
  for (std::size_t i = 0; i + 1 < csv_.samples.size(); ++i) {
    auto mixed = csv_.samples;
    mixed[i].lidar = csv_.samples[i + 1].lidar;
    const Consistency found = FindConsistent(mixed, {});
    ASSERT_EQ(found.inconsistent.size(), 1u) << "sample " << mixed[i].id;
    EXPECT_EQ(found.inconsistent[0].sample, static_cast<int>(i));
  }
}

// Pose 1 as its own image shows it, with the lidar's row of the table, which is another capture's:
// turned by 26 degrees and moved by 80 mm.
class PoseOne : public PosesCsvFigures {
 protected:
  void SetUp() override {
    PosesCsvFigures::SetUp();
    if (IsSkipped()) return;
    const std::filesystem::path session = *test::RealDataFolder() / "acfr-vlp16";
    const auto camera = DetectCameraBoard(
        cv::imread((session / "images/pose1.png").string()), camera_, test::TestBoard(), {});
    const auto lidar =
        DetectLidarBoard(test::LoadPcd(session / "pcd/pose1_full.pcd"), test::TestBoard(), {});
    ASSERT_TRUE(camera);
    ASSERT_TRUE(lidar);
    const auto is_first = [](const BoardSample& sample) { return sample.id == 1; };
    sample_ = std::find_if(csv_.samples.begin(), csv_.samples.end(), is_first);
    ASSERT_NE(sample_, csv_.samples.end());
    sample_->camera.pose = camera->pose;
    lidar_of_its_cloud_ = lidar->front();
  }

  std::vector<BoardSample>::iterator sample_;
  LidarBoard lidar_of_its_cloud_;
};

TEST_F(PoseOne, IsDroppedWithAReason) {
  const Consistency found = FindConsistent(csv_.samples, {});
  EXPECT_EQ(found.consistent.size(), 29u);
  ASSERT_EQ(found.inconsistent.size(), 1u);
  EXPECT_EQ(found.inconsistent[0].sample, sample_ - csv_.samples.begin());
  EXPECT_THAT(found.inconsistent[0].reason, testing::HasSubstr("of 29 consistent samples"));
}

TEST_F(PoseOne, IsMendedByTheRunnerUpOfItsOwnCloud) {
  sample_->runners_up = {lidar_of_its_cloud_};
  const Consistency found = FindConsistent(csv_.samples, {});
  EXPECT_EQ(found.consistent.size(), 30u);
  ASSERT_EQ(found.chosen.size(), 1u);
  EXPECT_EQ(found.chosen[0].sample, sample_ - csv_.samples.begin());
  EXPECT_EQ(found.chosen[0].candidate, 1);
}

TEST_F(PosesCsvFigures, MetresPerPixelAgreeWithTheAuthors) {
  // Theirs is within 8 % pose by pose, as tilted boards have no one scale, and 3 % over the
  // session.
  double ratio_sum = 0.0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const double ratio = MetresPerPixel(all_[i]->camera.pose, camera_) / csv_.metres_per_pixel[i];
    EXPECT_NEAR(ratio, 1.0, 0.08) << "pose " << all_[i]->id;
    ratio_sum += ratio;
  }
  EXPECT_NEAR(ratio_sum / static_cast<double>(all_.size()), 1.0, 0.03);
}

TEST_F(PosesCsvFigures, AverageIsNoWorseThanTheReference) {
  const AveragedExtrinsic average = Average();
  ASSERT_TRUE(average.IsUsable());
  EXPECT_GE(average.num_kept, 35);
  // The reference implementation's own result on this session: 9.0 mm.
  EXPECT_LE(ScoreScene(all_, camera_, average.T_camera_lidar).centre_mm.mean, 9.0);
}

TEST_F(PosesCsvFigures, RefinedLeaveOneOutIsWithinFourAndAHalfMillimetres) {
  const Eigen::Isometry3d T_start = Average().T_camera_lidar;
  EXPECT_LE(LeaveOneOutScore(all_, camera_, T_start, {}).centre_mm.mean, 4.5);
}

TEST_F(PosesCsvFigures, RefinementOfTenPosesHoldsOnTheOthers) {
  // 20 random splits: what is fitted to 10 poses must hold on the 20 that it never saw.
  test::Random random(5);
  double sum_mm = 0.0;
  for (int split = 0; split < 20; ++split) {
    auto shuffled = all_;
    for (std::size_t i = shuffled.size() - 1; i > 0; --i) {
      std::swap(shuffled[i], shuffled[random.Index(i + 1)]);
    }
    const std::vector<const BoardSample*> fitted(shuffled.begin(), shuffled.begin() + 10);
    const std::vector<const BoardSample*> held_out(shuffled.begin() + 10, shuffled.end());
    const RefinedExtrinsic refined =
        RefineExtrinsic(fitted, camera_, AnalyticExtrinsic(fitted), {});
    ASSERT_TRUE(refined.IsUsable());
    sum_mm += ScoreScene(held_out, camera_, refined.T_camera_lidar).centre_mm.mean;
  }
  EXPECT_LE(sum_mm / 20.0, 5.5);
}

}  // namespace
}  // namespace voqcal
