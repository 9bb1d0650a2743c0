#include "camera_board_detector/camera_board_detector_node.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

Rig SmallRig() {
  Rig rig = test::TestRig();
  rig.camera = test::SmallCamera(LensModel::kEquidistant);
  return rig;
}

class CameraBoardDetectorNodeTest : public ::testing::Test {
 protected:
  void Send(const image_t& message) { test::Send(&bus_, rig_.channels.camera_image, message); }
  const std::vector<camera_board_t>& found() const { return inbox_.messages; }

  Rig rig_ = SmallRig();
  Bus bus_{"memq://"};
  CameraBoardDetectorNode node_{rig_, &bus_};
  test::Inbox<camera_board_t> inbox_{&bus_, rig_.channels.camera_board};
};

Eigen::Isometry3d BoardAhead() {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() = ExpSO3({0.25, -0.3, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, 0.5});
  T_camera_board.translation() << 0.05, -0.02, 1.5;
  return T_camera_board;
}

cv::Mat ImageOfBoard(const Rig& rig) {
  return test::RenderBoard(rig.camera, rig.board, BoardAhead());
}

TEST_F(CameraBoardDetectorNodeTest, PublishesTheBoardOfAnImage) {
  Send(ToMessage(ImageOfBoard(rig_), 77, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].utime, 77);
  EXPECT_EQ(found()[0].frame, "camera");
  EXPECT_EQ(found()[0].miss, "");
  const CameraSighting sighting = SightingFromMessage(found()[0]);
  ASSERT_TRUE(sighting.board);
  // 0.1 px of a corner's position, as in the detector's own test.
  EXPECT_THAT(TransformFromPose(sighting.board->pose), test::IsNear(BoardAhead(), 3e-3, 3e-3));
  EXPECT_EQ(node_.counters(), (test::Counters{{"boards", 1}}));
}

TEST_F(CameraBoardDetectorNodeTest, AnswersAnImageWithoutABoardWithTheReason) {
  Send(ToMessage(
      cv::Mat(rig_.camera.height_px, rig_.camera.width_px, CV_8UC1, cv::Scalar(110)), 78, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_THAT(found()[0].miss, Not(IsEmpty()));
  EXPECT_EQ(node_.counters(), (test::Counters{{found()[0].miss, 1}}));
}

TEST_F(CameraBoardDetectorNodeTest, CountsACorruptJpegAndGoesOn) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", ImageOfBoard(rig_), jpeg);
  const image_t good = EncodedToMessage(jpeg, 2, 1);
  image_t broken = EncodedToMessage(jpeg, 1, 0);
  broken.data.resize(broken.data.size() / 2);
  broken.size = static_cast<std::int32_t>(broken.data.size());
  Send(broken);
  Send(good);
  ASSERT_THAT(found(), SizeIs(2));
  EXPECT_EQ(found()[0].miss, "unreadable image");
  EXPECT_THAT(found()[0].detail, HasSubstr("the JPEG is cut off"));
  EXPECT_EQ(found()[1].miss, "");
  EXPECT_EQ(node_.counters(), (test::Counters{{"boards", 1}, {"unreadable image", 1}}));
}

TEST_F(CameraBoardDetectorNodeTest, AnswersAnImageOfAnotherSizeWithBoth) {
  Send(ToMessage(cv::Mat(480, 752, CV_8UC1, cv::Scalar(110)), 1, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].miss, "image of 752 x 480 px, the camera's are 640 x 400");
}

TEST_F(CameraBoardDetectorNodeTest, DoesNotDecodeWhatCallsItselfHuge) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", ImageOfBoard(rig_), jpeg);
  image_t huge = EncodedToMessage(jpeg, 1, 0);
  huge.width = huge.height = 65535;  // 13 GB of pixels
  Send(huge);
  // The message says the right size, the JPEG's own header another: after FF C0.
  image_t false_header = EncodedToMessage(jpeg, 2, 1);
  const std::vector<std::uint8_t> sof{0xFF, 0xC0};
  const auto at =
      std::search(false_header.data.begin(), false_header.data.end(), sof.begin(), sof.end());
  ASSERT_NE(at, false_header.data.end());
  std::fill(at + 5, at + 9, std::uint8_t{0xFF});  // height, width
  Send(false_header);
  image_t empty = EncodedToMessage(jpeg, 3, 2);
  empty.data.clear();
  empty.size = 0;
  Send(empty);
  ASSERT_THAT(found(), SizeIs(3));
  EXPECT_THAT(found()[0].miss, HasSubstr("image of 65535 x 65535 px"));
  EXPECT_EQ(found()[1].miss, "unreadable image");
  EXPECT_THAT(found()[1].detail, HasSubstr("65535 x 65535"));
  EXPECT_EQ(found()[2].miss, "unreadable image");
}

image_t ImageOfBoardAt(const Rig& rig, double x_m) {
  Eigen::Isometry3d T_camera_board = BoardAhead();
  T_camera_board.translation().x() = x_m;
  return ToMessage(test::RenderBoard(rig.camera, rig.board, T_camera_board), 77, 0);
}

TEST_F(CameraBoardDetectorNodeTest, SaysWhichLensItsImagesWouldFitWhileTheyFitNone) {
  Rig half = rig_;  // as an image of half the size would have it
  half.camera.fx_px /= 2;
  half.camera.fy_px /= 2;
  half.camera.cx_px = (half.camera.cx_px + 0.5) / 2 - 0.5;
  half.camera.cy_px = (half.camera.cy_px + 0.5) / 2 - 0.5;
  Bus bus{"memq://"};
  CameraBoardDetectorNode node{half, &bus};
  const auto show = [&](const image_t& image) {
    test::Send(&bus, half.channels.camera_image, image);
  };
  const image_t ahead = ImageOfBoardAt(rig_, 0.0);
  for (int i = 0; i < 10; ++i) show(ahead);  // at rest: one view
  EXPECT_EQ(node.State(), "running");
  for (const double x_m : {-0.3, -0.15, 0.15, 0.3}) show(ImageOfBoardAt(rig_, x_m));
  EXPECT_THAT(node.State(),
              ::testing::StartsWith(
                  "trouble: The board's images do not fit the rig file's camera: the intrinsics "
                  "are those of images of another size; give camera.fx_px: "));
  EXPECT_THAT(node.State(), HasSubstr("(5 of 5 views of the board fit then)"));
  const image_t half_ahead = ImageOfBoardAt(half, 0.0);
  for (int i = 0; i < 14; ++i) {
    EXPECT_NE(node.State(), "running") << i;
    show(half_ahead);
  }
  EXPECT_EQ(node.State(), "running") << "as many fit now";
}

TEST_F(CameraBoardDetectorNodeTest, CarriesAndCountsWarnings) {
  cv::Mat blurred;
  cv::GaussianBlur(ImageOfBoard(rig_), blurred, {}, 2.5);
  Send(ToMessage(blurred, 1, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].miss, "");
  ASSERT_THAT(found()[0].warnings, SizeIs(1));
  EXPECT_EQ(found()[0].warnings[0].reason, "blurred");
  EXPECT_THAT(found()[0].warnings[0].detail, HasSubstr("edge width "));
  EXPECT_EQ(node_.counters(), (test::Counters{{"boards", 1}, {"boards: blurred", 1}}));
}

}  // namespace
}  // namespace voqcal
