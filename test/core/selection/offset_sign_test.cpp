#include "core/selection/offset_sign.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Samples of a board whose true offset is (x, y), as the camera sees them by a rig file that says
// other signs: the camera's centre is then off along the board's axes.
std::vector<BoardSample> Samples(const BoardSpec& truth, const BoardSpec& said) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 8;
  scene.lidar_centre_noise_m = 0.003;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    const Eigen::Vector3d shift_board_m(truth.pattern_offset_x_m - said.pattern_offset_x_m,
                                        truth.pattern_offset_y_m - said.pattern_offset_y_m,
                                        0.0);
    T_camera_board.translation() += T_camera_board.linear() * shift_board_m;
    sample.camera.pose = PoseFromTransform(T_camera_board, said);
  }
  return samples;
}

BoardSpec BoardWith(int num_corners_x, int num_corners_y, double offset_x_m, double offset_y_m) {
  BoardSpec board = test::TestBoard();
  board.num_corners_x = num_corners_x;
  board.num_corners_y = num_corners_y;
  board.pattern_offset_x_m = offset_x_m;
  board.pattern_offset_y_m = offset_y_m;
  return board;
}

TEST(WrongOffsetSign, NamesTheKeyWhateverTheCornerCounts) {
  const std::pair<int, int> counts[] = {{5, 7}, {6, 8}, {5, 6}, {6, 5}};
  for (const auto& [x, y] : counts) {
    const BoardSpec truth = BoardWith(x, y, -0.195, 0.0);
    const BoardSpec said = BoardWith(x, y, 0.195, 0.0);
    EXPECT_THAT(WrongOffsetSign(Samples(truth, said), said),
                HasSubstr("board.pattern_offset_x_m 0.195 should be -0.195"));
    EXPECT_THAT(WrongOffsetSign(Samples(truth, truth), truth), IsEmpty());
  }
}

TEST(WrongOffsetSign, NamesBothKeys) {
  const BoardSpec truth = BoardWith(5, 7, -0.1, 0.06);
  const BoardSpec said = BoardWith(5, 7, 0.1, -0.06);
  const std::string text = WrongOffsetSign(Samples(truth, said), said);
  EXPECT_THAT(text, HasSubstr("pattern_offset_x_m 0.1 should be -0.1"));
  EXPECT_THAT(text, HasSubstr("pattern_offset_y_m -0.06 should be 0.06"));
}

TEST(WrongOffsetSign, BlamesNoSignWhereNoneHelps) {
  const BoardSpec centred = BoardWith(5, 7, 0.0, 0.0);
  EXPECT_THAT(WrongOffsetSign(Samples(BoardWith(5, 7, 0.1, 0.0), centred), centred), IsEmpty());
  const BoardSpec said = BoardWith(5, 7, 0.1, 0.0);
  EXPECT_THAT(WrongOffsetSign(Samples(BoardWith(5, 7, 0.0, 0.1), said), said), IsEmpty());
  EXPECT_THAT(WrongOffsetSign({}, said), IsEmpty());
}

}  // namespace
}  // namespace voqcal
