#include "core/assessment/lens_cause.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kMaxRmsPx = 1.5;
constexpr std::size_t kNumViews = 12;

/// Corners of the test board as `lens` shows it, each off by `noise_px`, 1 sigma.
std::vector<std::vector<Eigen::Vector2d>> ViewsThrough(const CameraModel& lens, double noise_px) {
  test::SyntheticSamplesOptions options;
  test::Random random(3);
  std::vector<std::vector<Eigen::Vector2d>> views_px;
  for (const BoardSample& sample : test::SynthesizeSamples(options)) {
    if (views_px.size() == kNumViews) break;
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    auto& corners_px = views_px.emplace_back();
    for (const Eigen::Vector3d& corner_board_m : test::TestBoard().InnerCornersBoardM()) {
      corners_px.push_back(lens.Project(T_camera_board * corner_board_m) +
                           noise_px * random.NormalVector().head<2>());
    }
  }
  return views_px;
}

std::optional<LensCause> CauseSaid(const CameraModel& said, const CameraModel& lens) {
  return FindLensCause(ViewsThrough(lens, 0.1), test::TestBoard(), said, kMaxRmsPx);
}

TEST(FindLensCause, NamesTheModelThatTheLensFollows) {
  CameraModel said = test::TestCamera();
  said.lens = LensModel::kPlumbBob;
  ASSERT_NE(said.lens, test::TestCamera().lens);
  const auto cause = CauseSaid(said, test::TestCamera());
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->cause, "lens model");
  EXPECT_THAT(cause->remedy, StartsWith("give camera.lens_model: equidistant, "));
  EXPECT_EQ(cause->num_fitting, kNumViews);
}

TEST(FindLensCause, NamesTheSizeOfTheImagesThatTheIntrinsicsAreOf) {
  CameraModel said = test::TestCamera();
  said.fx_px *= 2;
  said.fy_px *= 2;
  said.cx_px = 2 * said.cx_px + 0.5;
  said.cy_px = 2 * said.cy_px + 0.5;
  const auto cause = CauseSaid(said, test::TestCamera());
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->cause, "image size");
  EXPECT_THAT(cause->remedy, HasSubstr(Format("fx_px: %g", test::TestCamera().fx_px)));
  EXPECT_EQ(cause->num_fitting, kNumViews);
}

TEST(FindLensCause, NamesANumberThatWasTypedWrongly) {
  CameraModel said = test::TestCamera();
  said.fy_px *= 1.2;
  const auto cause = CauseSaid(said, test::TestCamera());
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->cause, "focal length fy");
  EXPECT_THAT(cause->remedy, StartsWith("give about camera.fy_px: "));
}

TEST(FindLensCause, PrefersTheAnswerThatFitsBest) {
  CameraModel pinhole = test::TestCamera();
  pinhole.lens = LensModel::kPlumbBob;
  pinhole.distortion = {};
  const auto cause = CauseSaid(test::TestCamera(), pinhole);
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->cause, "rectified images");
  EXPECT_THAT(cause->remedy, HasSubstr("plumb_bob"));
}

TEST(FindLensCause, SaysNothingOfCornersThatNoLensExplains) {
  // Far above what corners are off by; and as little above the limit as some lens might mend.
  for (const double noise_px : {10.0, 1.2}) {
    EXPECT_FALSE(FindLensCause(ViewsThrough(test::TestCamera(), noise_px),
                               test::TestBoard(),
                               test::TestCamera(),
                               kMaxRmsPx))
        << noise_px;
  }
}

TEST(FindLensCause, SaysNothingOfFewViews) {
  CameraModel said = test::TestCamera();
  said.lens = LensModel::kPlumbBob;
  auto views_px = ViewsThrough(test::TestCamera(), 0.1);
  views_px.resize(4);
  EXPECT_FALSE(FindLensCause(views_px, test::TestBoard(), said, kMaxRmsPx));
}

}  // namespace
}  // namespace voqcal
