#include "core/sampling/average_sightings.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/sampling/picker_streams.hpp"

namespace voqcal {
namespace {

using test::Board;
using test::Camera;
using test::Lidar;

TEST(MeanBoard, TurnsFramesOfTheOtherHalfTurnBeforeAveraging) {
  LidarBoard lidar = *Lidar(0, 0.5).board;
  lidar.edge_lengths_m = {0.60, 0.80, 0.62, 0.82};
  LidarBoard lidar_turned = lidar;
  lidar_turned.pose = TurnedByHalf(lidar.pose);
  lidar_turned.edge_lengths_m = {0.62, 0.82, 0.60, 0.80};
  CameraBoard camera = *Camera(0, 0.5).board;
  CameraBoard camera_turned = camera;
  camera_turned.pose = TurnedByHalf(camera.pose);
  std::reverse(camera_turned.corners_px.begin(), camera_turned.corners_px.end());
  const LidarBoard lidar_mean = MeanLidarBoard({lidar, lidar_turned}, Board());
  const CameraBoard camera_mean = MeanCameraBoard({camera, camera_turned}, Board());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(lidar_mean.edge_lengths_m[i], lidar.edge_lengths_m[i], 1e-12);
    EXPECT_LT((lidar_mean.pose.corners_m[i] - lidar.pose.corners_m[i]).norm(), 1e-12);
    EXPECT_LT((camera_mean.pose.corners_m[i] - camera.pose.corners_m[i]).norm(), 1e-12);
  }
  EXPECT_LT((camera_mean.corners_px[0] - camera.corners_px[0]).norm(), 1e-12);
  EXPECT_THROW(MeanLidarBoard({}, Board()), std::invalid_argument);
  EXPECT_THROW(MeanCameraBoard({}, Board()), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
