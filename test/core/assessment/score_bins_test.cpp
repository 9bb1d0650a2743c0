#include "core/assessment/score_bins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

class ScoreBins : public ::testing::Test {
 protected:
  /// The board's centre is seen at a pixel, so far away, with an error of so many millimetres.
  void Add(double x_px, double y_px, double range_m, double error_mm) {
    BoardSample sample;
    sample.camera.pose.centre_m = range_m * *camera_.Unproject({x_px, y_px});
    samples_.push_back(sample);
    PoseScore pose;
    pose.centre_mm = error_mm;
    score_.poses.push_back(pose);
  }
  std::vector<std::string> Names(const std::vector<ScoreBin>& bins) const {
    std::vector<std::string> names;
    for (const ScoreBin& bin : bins) names.push_back(bin.name);
    return names;
  }

  CameraModel camera_ = test::SmallCamera(LensModel::kEquidistant);  // 640 x 400
  std::vector<BoardSample> samples_;
  SceneScore score_;
};

TEST_F(ScoreBins, SortsByImageCell) {
  Add(320, 200, 3, 1);
  Add(300, 190, 5, 3);
  Add(600, 40, 2, 7);
  Add(212, 200, 2, 9);  // the last column of the left third: 640 / 3 = 213.3
  const auto bins = BinByImageCell(test::Pointers(samples_), score_, camera_);
  EXPECT_THAT(Names(bins), ::testing::ElementsAre("top right", "left", "middle"));
}

TEST_F(ScoreBins, SortsByRange) {
  Add(320, 200, 1.5, 1);
  Add(320, 200, 2.5, 2);
  Add(320, 200, 2.9, 4);
  Add(320, 200, 30, 8);
  const auto bins = BinByRange(test::Pointers(samples_), score_);
  EXPECT_THAT(Names(bins), ::testing::ElementsAre("up to 2 m", "2 to 3 m", "beyond 10 m"));
  EXPECT_EQ(bins[1].score.poses.size(), 2u);
  EXPECT_DOUBLE_EQ(bins[1].score.centre_mm.mean, 3);
  EXPECT_DOUBLE_EQ(bins[1].score.centre_mm.max, 4);
}

TEST_F(ScoreBins, ARangeOnTheEdgeIsOfTheFartherBinAsACellsPixelIs) {
  Add(320, 200, 2, 1);
  samples_.back().camera.pose.centre_m = Eigen::Vector3d(0, 0, 2);  // exactly
  EXPECT_THAT(Names(BinByRange(test::Pointers(samples_), score_)),
              ::testing::ElementsAre("2 to 3 m"));
}

TEST_F(ScoreBins, NoPosesGiveNoBins) {
  EXPECT_THAT(BinByImageCell({}, {}, camera_), ::testing::IsEmpty());
  EXPECT_THAT(BinByRange({}, {}), ::testing::IsEmpty());
}

}  // namespace
}  // namespace voqcal
