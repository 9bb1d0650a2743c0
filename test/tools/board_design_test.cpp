#include "design_board/board_design.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

Rig SmallRig() {
  Rig rig;
  rig.board.width_m = 0.61;
  rig.board.height_m = 0.85;
  rig.board.square_m = 0.095;
  rig.board.num_corners_x = 5;
  rig.board.num_corners_y = 7;
  rig.camera.width_px = 1280;
  rig.camera.height_px = 960;
  rig.camera.fx_px = rig.camera.fy_px = 800;
  rig.camera.cx_px = 639.5;
  rig.camera.cy_px = 479.5;
  return rig;
}

TEST(Scaled, IsInWholeMillimetres) {
  const BoardSpec half = Scaled(SmallRig().board, 0.5);
  EXPECT_DOUBLE_EQ(half.width_m, 0.305);
  EXPECT_DOUBLE_EQ(half.square_m, 0.048);
  EXPECT_EQ(half.num_corners_x, 5);
}

TEST(PredictDesigns, MorePlacesAreBetterAndFartherIsWorse) {
  const Rig rig = SmallRig();
  std::string why_fewer;
  const std::vector<BoardDesign> designs = PredictDesigns(rig, rig.board, {2, 4}, &why_fewer);
  EXPECT_EQ(why_fewer, "");
  ASSERT_EQ(designs.size(), 2U);
  EXPECT_EQ(designs[1].num_poses, 4);
  for (std::size_t i = 0; i < kDesignRangesM.size(); ++i) {
    EXPECT_LT(designs[1].worst_errors_mm[i], designs[0].worst_errors_mm[i]);
  }
  EXPECT_LT(designs[1].worst_errors_mm[0], designs[1].worst_errors_mm[2]);
}

TEST(PredictDesigns, SaysWhyThereIsNoPlace) {
  Rig rig = SmallRig();
  rig.pose_guide.limits.min_rows = 17;  // more than a VLP-16 has
  std::string why_fewer;
  EXPECT_TRUE(PredictDesigns(rig, rig.board, {2}, &why_fewer).empty());
  EXPECT_NE(why_fewer, "");
}

TEST(Recommended, IsTheFirstThatKeepsTheTolerance) {
  BoardDesign small{SmallRig().board, 8, {6, 20, 50}};
  BoardDesign large{SmallRig().board, 15, {4, 20, 50}};
  EXPECT_EQ(Recommended({small, large}, 5)->num_poses, 15);
  EXPECT_FALSE(Recommended({small, large}, 3));
}

}  // namespace
}  // namespace voqcal
