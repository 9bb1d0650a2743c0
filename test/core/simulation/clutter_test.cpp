#include "core/simulation/clutter.hpp"

#include <gtest/gtest.h>

#include "core/simulation/lidar_simulator.hpp"
#include "core/simulation/room.hpp"
#include "simulated_rig.hpp"

namespace voqcal {
namespace {

Props ClutterOf(const ClutterOptions& options, std::uint32_t seed) {
  return DrawClutter(options, test::CleanRig().board, Room().Interior(), seed);
}

TEST(DrawClutter, HasWhatIsAskedAndMore) {
  ClutterOptions options;
  options.second_board_scale = 1.3;
  const Props clutter = ClutterOf(options, 7);
  // Four limbs, trunk and head; three legs and a column; a second board's stand of five; feet of
  // tables.
  EXPECT_GE(clutter.tubes.size(), 3U * 6 + 2 * 4 + 5);
  EXPECT_EQ(clutter.boxes.size(), 4U);
  ASSERT_EQ(clutter.panels.size(), 3U);
  EXPECT_DOUBLE_EQ(clutter.panels.back().width_m, 1.3 * 0.61);
  EXPECT_DOUBLE_EQ(clutter.panels.back().height_m, 1.3 * 0.85);
}

TEST(DrawClutter, IsDrawnBySeedAndKeepsClearOfTheLidar) {
  ClutterOptions options;
  options.second_board_scale = 0.7;
  options.num_furniture = 0;  // wider than the clearance
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const Props clutter = ClutterOf(options, seed);
    const Props again = ClutterOf(options, seed);
    ASSERT_EQ(clutter.tubes.size(), again.tubes.size());
    EXPECT_EQ(clutter.tubes[0].begin_m, again.tubes[0].begin_m);
    // A person's arm reaches 0.4 m from where they stand, a door's leaf and a board 0.45 m.
    EXPECT_GT(Room(Room().Interior(), clutter).DistanceToFurnitureM(Eigen::Vector3d::Zero()),
              options.min_distance_m - 0.5);
  }
  EXPECT_NE(ClutterOf(options, 1).tubes[0].begin_m, ClutterOf(options, 2).tubes[0].begin_m);
}

TEST(PanelCast, MeetsTheRectangleOnly) {
  Panel panel;
  panel.width_m = 0.4;
  panel.height_m = 0.8;
  panel.T_lidar_panel.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
  const Eigen::Vector3d origin_m(0.1, 0.2, -1.0);
  EXPECT_DOUBLE_EQ(*panel.Cast(origin_m, Eigen::Vector3d::UnitZ()), 3.0);
  EXPECT_FALSE(panel.Cast(origin_m, -Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(panel.Cast(origin_m, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(panel.Cast({0.21, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(panel.Cast({0.0, 0.41, 0.0}, Eigen::Vector3d::UnitZ()));
  EXPECT_DOUBLE_EQ(*panel.Cast({0.19, -0.39, 5.0}, -Eigen::Vector3d::UnitZ()), 3.0);
}

TEST(RoomCast, MeetsPropsBeforeTheWallBehindThem) {
  Props props;
  props.tubes.push_back({{2.0, 0.0, -1.0}, {2.0, 0.0, 1.0}, 0.1, Material::kCloth});
  Panel panel;
  panel.width_m = panel.height_m = 1.0;
  panel.T_lidar_panel.linear() =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  panel.T_lidar_panel.translation() = Eigen::Vector3d(-3.0, 0.0, 0.0);
  props.panels.push_back(panel);
  const Room room(props);
  const RoomHit tube = room.Cast(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(tube.range_m, 1.9, 1e-12);
  EXPECT_EQ(tube.material, Material::kCloth);
  EXPECT_NEAR((tube.normal_lidar + Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-12);
  const RoomHit board = room.Cast(Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitX());
  EXPECT_NEAR(board.range_m, 3.0, 1e-12);
  EXPECT_EQ(board.material, Material::kWhiteboard);
  EXPECT_NEAR((board.normal_lidar - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NE(board.surface, tube.surface);
}

// The same distances by sampling the surfaces.
TEST(RoomDistanceToFurniture, IsThatToTheNearestProp) {
  const Props clutter = ClutterOf({}, 11);
  const Room room(Room().Interior(), clutter);
  for (const Eigen::Vector3d& point_m :
       {Eigen::Vector3d(1.0, 0.5, 0.0), Eigen::Vector3d(-2.0, -1.0, 0.5)}) {
    double nearest_m = 1e9;
    for (const Panel& panel : clutter.panels) {
      for (int i = 0; i <= 400; ++i) {
        for (int j = 0; j <= 400; ++j) {
          const Eigen::Vector3d place_m(
              panel.width_m * (i / 400.0 - 0.5), panel.height_m * (j / 400.0 - 0.5), 0.0);
          nearest_m = std::min(nearest_m, (panel.T_lidar_panel * place_m - point_m).norm());
        }
      }
    }
    for (const Tube& tube : clutter.tubes) {
      for (int i = 0; i <= 4000; ++i) {
        const Eigen::Vector3d on_axis_m = tube.begin_m + i / 4000.0 * (tube.end_m - tube.begin_m);
        nearest_m = std::min(nearest_m, (on_axis_m - point_m).norm() - tube.radius_m);
      }
    }
    for (const Box& box : clutter.boxes) {
      const Eigen::Vector3d nearest = point_m.cwiseMax(box.min_lidar_m).cwiseMin(box.max_lidar_m);
      nearest_m = std::min(nearest_m, (nearest - point_m).norm());
    }
    // Samples of panels are 5 mm apart, at 1 m: 2.5^2 mm^2 / 2 m = 3 um too far.
    EXPECT_NEAR(room.DistanceToFurnitureM(point_m), nearest_m, 1e-4);
  }
}

}  // namespace
}  // namespace voqcal
