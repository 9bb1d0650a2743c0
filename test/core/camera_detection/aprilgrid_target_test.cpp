#include "core/camera_detection/aprilgrid_target.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "support/matchers.hpp"
#include "support/real_data.hpp"
#include "support/spoilt_image.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

constexpr double kTagM = 0.1;
constexpr double kGapM = 0.03;
constexpr int kNumTagsX = 4;
constexpr int kNumTagsY = 6;

// The family's first codes, as AprilTag publishes them: 36 bits, row by row from the upper left,
// the highest bit first; 1 is white.
constexpr std::array<std::uint64_t, 24> kCodes = {
    0xd5d628584, 0xd97f18b49, 0xdd280910e, 0xe479e9c98, 0xebcbca822, 0xf31dab3ac,
    0x056a5d085, 0x10652e1d4, 0x22b1dfead, 0x265ad0472, 0x34fe91b86, 0x3ff962cd5,
    0x43a25329a, 0x474b4385f, 0x4e9d243e9, 0x5246149ae, 0x5997f5538, 0x683bb6c4c,
    0x6be4a7211, 0x7e3158eea, 0x81da494af, 0x858339a74, 0x8cd51a5fe, 0x9f21cc2d7};

// Kalibr's board by its published layout, drawn without our code and OpenCV's: how bright it is
// where, in metres from the lower left corner of tag 0.
double KalibrBrightness(double x_m, double y_m) {
  constexpr double kDark = 30;
  constexpr double kBright = 220;
  constexpr double kPitchM = kTagM + kGapM;
  if (x_m < -kGapM || y_m < -kGapM) return kBright;
  if (x_m > kNumTagsX * kPitchM || y_m > kNumTagsY * kPitchM) return kBright;
  const auto column = static_cast<int>(std::floor(x_m / kPitchM));
  const auto row = static_cast<int>(std::floor(y_m / kPitchM));
  const double x_in_tag_m = x_m - column * kPitchM;
  const double y_in_tag_m = y_m - row * kPitchM;
  const bool is_beside_x = x_in_tag_m > kTagM;
  const bool is_beside_y = y_in_tag_m > kTagM;
  if (is_beside_x || is_beside_y) return is_beside_x && is_beside_y ? kDark : kBright;
  const auto i = static_cast<int>(x_in_tag_m / (kTagM / 10)) - 2;
  const auto j = 7 - static_cast<int>(y_in_tag_m / (kTagM / 10));  // from the top
  if (i < 0 || j < 0 || i > 5 || j > 5) return kDark;
  const std::uint64_t code = kCodes[static_cast<std::size_t>(row * kNumTagsX + column)];
  return (code >> (35 - (6 * j + i)) & 1U) != 0 ? kBright : kDark;
}

BoardSpec Grid() {
  BoardSpec board;
  board.width_m = 0.61;
  board.height_m = 0.85;
  board.pattern = "aprilgrid";
  board.square_m = kTagM;
  board.num_corners_x = 2 * kNumTagsX;
  board.num_corners_y = 2 * kNumTagsY;
  board.gap_squares = kGapM / kTagM;
  board.pattern_offset_x_m = 0.002;
  return board;
}

std::optional<double> BrightnessAt(const Eigen::Vector2d& at_board_m) {
  const BoardSpec board = Grid();
  if (std::abs(at_board_m.x()) > board.width_m / 2) return {};
  if (std::abs(at_board_m.y()) > board.height_m / 2) return {};
  const double begin_x_m = 0.002 - (kNumTagsX * kTagM + (kNumTagsX - 1) * kGapM) / 2;
  const double begin_y_m = -(kNumTagsY * kTagM + (kNumTagsY - 1) * kGapM) / 2;
  return KalibrBrightness(at_board_m.x() - begin_x_m, at_board_m.y() - begin_y_m);
}

constexpr double kAheadM = 1.2;

Eigen::Isometry3d BoardAhead(double distance_m, double tilt_rad, double roll_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.2, tilt_rad, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, roll_rad});
  T.translation() << 0.011, -0.007, distance_m;
  return T;
}

CameraModel CameraWithoutDistortion() {
  CameraModel camera;
  camera.lens = LensModel::kPlumbBob;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = 650;
  camera.fy_px = 655;
  camera.cx_px = 318;
  camera.cy_px = 242;
  return camera;
}

const CameraModel kCamera = CameraWithoutDistortion();

// The plate, 2 pixels to a millimetre: every line of the pattern lies between pixels.
constexpr double kFacePixelM = 0.0005;

cv::Mat DrawFace() {
  const BoardSpec board = Grid();
  cv::Mat face(
      cvRound(board.height_m / kFacePixelM), cvRound(board.width_m / kFacePixelM), CV_8UC1);
  for (int y = 0; y < face.rows; ++y) {
    for (int x = 0; x < face.cols; ++x) {
      const Eigen::Vector2d at_board_m((x + 0.5) * kFacePixelM - board.width_m / 2,
                                       (y + 0.5) * kFacePixelM - board.height_m / 2);
      face.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(*BrightnessAt(at_board_m));
    }
  }
  return face;
}

// A lens without distortion sees a plane through a homography; by 8 x 8 rays a pixel.
cv::Mat Render(const Eigen::Isometry3d& T_camera_board) {
  constexpr int kRays = 8;
  constexpr double kRayOffset = (kRays - 1) / 2.0;
  static const cv::Mat kFace = DrawFace();
  const BoardSpec board = Grid();
  Eigen::Matrix3d board_from_face;
  board_from_face << kFacePixelM, 0, (kFacePixelM - board.width_m) / 2,  //
      0, kFacePixelM, (kFacePixelM - board.height_m) / 2,                //
      0, 0, 1;
  Eigen::Matrix3d camera_from_board;
  camera_from_board << T_camera_board.linear().leftCols<2>(), T_camera_board.translation();
  Eigen::Matrix3d pixel_from_camera;
  pixel_from_camera << kCamera.fx_px, 0, kCamera.cx_px, 0, kCamera.fy_px, kCamera.cy_px, 0, 0, 1;
  Eigen::Matrix3d ray_from_pixel;
  ray_from_pixel << kRays, 0, kRayOffset, 0, kRays, kRayOffset, 0, 0, 1;
  const Eigen::Matrix3d ray_from_face =
      ray_from_pixel * pixel_from_camera * camera_from_board * board_from_face;
  cv::Mat homography;
  cv::eigen2cv(ray_from_face, homography);
  cv::Mat rays;
  const cv::Size size_px(kCamera.width_px, kCamera.height_px);
  cv::warpPerspective(
      kFace, rays, homography, size_px * kRays, cv::INTER_NEAREST, cv::BORDER_CONSTANT, 110);
  cv::Mat image;
  cv::resize(rays, image, size_px, 0, 0, cv::INTER_AREA);
  return image;
}

struct Seen {
  int num_corners = 0;
  double rms_px = 0;
};

Seen Compare(const CameraBoard& found,
             const CameraModel& camera,
             const Eigen::Isometry3d& T_camera_board) {
  Seen seen;
  const std::vector<Eigen::Vector3d> points_board_m = Grid().InnerCornersBoardM();
  for (std::size_t k = 0; k < points_board_m.size(); ++k) {
    if (!found.corners_px[k].allFinite()) continue;
    const Eigen::Vector2d truth_px = camera.Project(T_camera_board * points_board_m[k]);
    seen.rms_px += (found.corners_px[k] - truth_px).squaredNorm();
    ++seen.num_corners;
  }
  seen.rms_px = std::sqrt(seen.rms_px / seen.num_corners);
  return seen;
}

constexpr double kTolerancePx = 0.05;  // RMS

// Tags of 54 to 25 px across, 17 askew: no smaller ones are promised. Sharp and blurred, with
// noise.
TEST(AprilGrid, FindsCornersToATwentiethOfAPixel) {
  constexpr double kNoise = 2;
  std::uint32_t seed = 1;
  for (const double distance_m : {1.2, 2.0, 2.6}) {
    for (const double tilt_rad : {-0.25, 0.8}) {
      for (const double blur_px : {0.0, 0.8}) {
        const Eigen::Isometry3d T_camera_board = BoardAhead(distance_m, tilt_rad, 0.3 * seed);
        const cv::Mat sharp = Render(T_camera_board);
        const cv::Mat image = test::WithNoise(test::Blurred(sharp, blur_px), kNoise, seed++);
        const auto found = DetectCameraBoard(image, kCamera, Grid(), {});
        ASSERT_TRUE(found) << seed << ": " << found.error().detail;
        const Seen seen = Compare(*found, kCamera, T_camera_board);
        EXPECT_LT(seen.rms_px, kTolerancePx) << seed;
        EXPECT_GE(seen.num_corners, 80) << seed;  // of 96; near ones may lie beyond the image
      }
    }
  }
}

TEST(AprilGrid, FindsTheRightCornersEitherWayUp) {
  for (const double roll_rad : {0.1, 1.6, M_PI + 0.1, -1.6}) {
    const Eigen::Isometry3d T_camera_board = BoardAhead(1.5, -0.25, roll_rad);
    const auto found = DetectCameraBoard(Render(T_camera_board), kCamera, Grid(), {});
    ASSERT_TRUE(found) << roll_rad << ": " << found.error().detail;
    EXPECT_THAT(TransformFromPose(found->pose), test::IsNear(T_camera_board, 1e-3, 1e-3));
  }
}

TEST(AprilGrid, FindsCornersThroughAFisheye) {
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  const Eigen::Isometry3d T_camera_board = BoardAhead(kAheadM, -0.25, 1.3);
  constexpr int kRaysAcross = 6;
  const cv::Mat image = test::RenderFace(camera, Grid(), T_camera_board, kRaysAcross, BrightnessAt);
  const auto found = DetectCameraBoard(image, camera, Grid(), {});
  ASSERT_TRUE(found) << found.error().detail;
  const Seen seen = Compare(*found, camera, T_camera_board);
  EXPECT_LT(seen.rms_px, kTolerancePx);
  EXPECT_GE(seen.num_corners, 90);
}

// About half of the corners, where they are.
void ExpectAPart(const cv::Mat& image, const Eigen::Isometry3d& T_camera_board) {
  const auto found = DetectCameraBoard(image, kCamera, Grid(), {});
  ASSERT_TRUE(found) << found.error().detail;
  const Seen seen = Compare(*found, kCamera, T_camera_board);
  EXPECT_LT(seen.rms_px, kTolerancePx);
  EXPECT_GE(seen.num_corners, 30);
  EXPECT_LE(seen.num_corners, 50);
}

TEST(AprilGrid, FindsAPart) {
  const Eigen::Isometry3d T_camera_board = BoardAhead(kAheadM, -0.25, 0.1);
  cv::Mat image = Render(T_camera_board);
  image.colRange(image.cols / 2, image.cols).setTo(110);
  ExpectAPart(image, T_camera_board);
}

TEST(AprilGrid, FindsCornersInBadLight) {
  const Eigen::Isometry3d T_camera_board = BoardAhead(1.5, -0.25, 0.4);
  const cv::Mat image = Render(T_camera_board);
  const Eigen::Vector2d centre_px = kCamera.Project(T_camera_board.translation().eval());
  constexpr double kEdgePx = 10;  // of the shadow
  const std::vector<std::pair<std::string, cv::Mat>> spoilt = {
      {"dark", test::Paled(image, 0.15, -100)},
      {"uneven", test::UnevenlyLit(image, 0.15)},
      {"shadow", test::WithShadow(image, centre_px, {0.8, 0.6}, 0.3, kEdgePx)}};
  for (const auto& [kind, as_seen] : spoilt) {
    const auto found = DetectCameraBoard(test::WithNoise(as_seen, 1, 7), kCamera, Grid(), {});
    ASSERT_TRUE(found) << kind << ": " << found.error().detail;
    const Seen seen = Compare(*found, kCamera, T_camera_board);
    EXPECT_LT(seen.rms_px, kTolerancePx) << kind;
    EXPECT_GE(seen.num_corners, 80) << kind;  // of 96; the shadow's edge crosses some
  }
}

// X-corners all around, also where they bound dark squares of a tag's size.
TEST(AprilGrid, IsNotMisledByAChessboardBesideIt) {
  const Eigen::Isometry3d T_camera_board = BoardAhead(kAheadM, -0.25, 0.1);
  cv::Mat image = Render(T_camera_board);
  constexpr int kSquarePx = 25;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = image.cols / 2; x < image.cols; ++x) {
      image.at<unsigned char>(y, x) = (x / kSquarePx + y / kSquarePx) % 2 == 0 ? 30 : 220;
    }
  }
  ExpectAPart(image, T_camera_board);
}

// Boards there are all chessboards.
TEST(AprilGrid, FindsNoneInRealImagesWithout) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data";
  int num_images = 0;
  for (const auto& recording : std::filesystem::directory_iterator(*data / "field")) {
    const std::filesystem::path folder = recording.path() / "images";
    if (!std::filesystem::is_directory(folder)) continue;
    const auto file = *std::filesystem::directory_iterator(folder);
    const cv::Mat image = cv::imread(file.path().string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(image.empty()) << file;
    ++num_images;
    EXPECT_FALSE(AprilGrid().find_corners(image, Grid())) << file;
  }
  EXPECT_GT(num_images, 0);
}

TEST(AprilGrid, SaysWhyThereIsNone) {
  const cv::Mat blank(kCamera.height_px, kCamera.width_px, CV_8UC1, cv::Scalar(90));
  const auto none = DetectCameraBoard(blank, kCamera, Grid(), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().fault, CameraBoardFault::kNoBoard);
  EXPECT_THAT(none.error().detail, HasSubstr("family 36h11"));
}

TEST(AprilGrid, IsPrintedAsKalibrPrintsIt) {
  const PrintedPattern printed = AprilGrid().print(Grid());
  ASSERT_EQ(printed.NumCellsX(), kNumTagsX * 11 + 1);
  ASSERT_EQ(printed.NumCellsY(), kNumTagsY * 11 + 1);
  for (int j = 0; j < printed.NumCellsY(); ++j) {
    for (int i = 0; i < printed.NumCellsX(); ++i) {
      const Eigen::Vector2d middle_m((printed.x_lines_m[i] + printed.x_lines_m[i + 1]) / 2,
                                     (printed.y_lines_m[j] + printed.y_lines_m[j + 1]) / 2);
      EXPECT_EQ(printed.is_dark[j * printed.NumCellsX() + i], *BrightnessAt(middle_m) < 100)
          << i << ", " << j;
    }
  }
}

TEST(AprilGrid, NamesItsKeysInProblems) {
  BoardSpec board = Grid();
  EXPECT_THAT(BoardProblems(board), ::testing::IsEmpty());
  board.num_corners_x = 2;
  board.gap_squares = 1.5;
  EXPECT_THAT(BoardProblems(board),
              ::testing::ElementsAre("tagCols must be at least 2, is 1",
                                     "tagSpacing must be above 0 and at most 1, is 1.5"));
}

}  // namespace
}  // namespace voqcal
