#include "messaging/session_views.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/encode.hpp"
#include "modules/nodes/node_test.hpp"
#include "sample_collector/session_log.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

class SessionViewsTest : public ::testing::Test {
 protected:
  template <typename Message>
  static SensorFrame Frame(const Message& message) {
    return {message.utime, EncodeMessage(message)};
  }
  void Accept(std::size_t i, int image_width_px) {
    const cv::Mat image(rig_.camera.height_px, image_width_px, CV_8U, cv::Scalar(100));
    const SensorFrame sweep = Frame(ToMessage(PointCloud{}, samples_[i].utime, 0));
    const SensorFrame frame = Frame(ToMessage(image, samples_[i].utime, 0));
    SessionLog(folder_.path()).Accept(samples_[i], {&sweep, &frame});
  }
  std::vector<SceneView> Of(std::vector<const BoardSample*> samples) { return views_.Of(samples); }

  Rig rig_ = test::TestRig();
  test::TemporaryFolder folder_;
  std::vector<BoardSample> samples_ = test::SynthesizeSamples({});
  SessionViews views_{
      rig_.board, rig_.camera, rig_.scene_check.view, folder_.path() / kSamplesLogName};
};

TEST_F(SessionViewsTest, HasNoneWithoutALog) { EXPECT_THAT(Of({&samples_[0]}), IsEmpty()); }

TEST_F(SessionViewsTest, HasTheScenesOfTheSamplesAskedFor) {
  Accept(0, rig_.camera.width_px);
  Accept(1, rig_.camera.width_px);
  EXPECT_THAT(Of({&samples_[0], &samples_[1], &samples_[2]}), SizeIs(2));
  EXPECT_THAT(Of({&samples_[1]}), SizeIs(1));
  EXPECT_THAT(Of({&samples_[0], &samples_[1]}), SizeIs(2));  // read again
}

TEST_F(SessionViewsTest, LeavesOutASceneThatItCannotRead) {
  Accept(0, rig_.camera.width_px + 2);  // an image of another camera
  Accept(1, rig_.camera.width_px);
  EXPECT_THAT(Of({&samples_[0], &samples_[1]}), SizeIs(1));
}

}  // namespace
}  // namespace voqcal
