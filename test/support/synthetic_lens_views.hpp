#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/rigid.hpp"
#include "core/lens_calibration/lens_view.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// Views of TestBoard(), near enough to fill a good part of the image, all over it.
struct LensViewsOptions {
  int num_views = 30;
  double max_tilt_rad = 0.8;  ///< Against the image plane; 0: all parallel to it.
  double noise_px = 0.2;      ///< 1 sigma of each coordinate.
  std::uint32_t seed = 1;
};

inline std::vector<LensView> MakeLensViews(const CameraModel& camera,
                                           const LensViewsOptions& options) {
  Random random(options.seed);
  const std::vector<Eigen::Vector3d> corners_board_m = TestBoard().InnerCornersBoardM();
  const double near_m = camera.fx_px / camera.width_px;  // the board is then an image's half
  std::vector<LensView> views;
  while (static_cast<int>(views.size()) < options.num_views) {
    const Eigen::Vector2d at_px(random.Uniform(0, camera.width_px),
                                random.Uniform(0, camera.height_px));
    const double tilt_rad = options.max_tilt_rad * std::sqrt(random.Uniform(0, 1));
    const double towards_rad = random.Uniform(-M_PI, M_PI);
    const double roll_rad = random.Uniform(-0.6, 0.6);
    const double distance_m = near_m * random.Uniform(1.2, 2.5);
    const auto ray = camera.Unproject(at_px);
    if (!ray) continue;
    // Its face towards the camera, y up: half a turn about x from the camera's axes.
    const Eigen::Vector3d tilt =
        tilt_rad * Eigen::Vector3d(std::cos(towards_rad), std::sin(towards_rad), 0);
    Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
    T_camera_board.linear() = ExpSO3(tilt) * ExpSO3({0, 0, roll_rad}) * ExpSO3({M_PI, 0, 0});
    T_camera_board.translation() = distance_m * *ray;
    LensView view;
    view.utime = static_cast<std::int64_t>(views.size() + 1) * 2'000'000;
    // Its face, not too much from the side.
    bool is_inside = T_camera_board.linear().col(2).dot(*ray) < -0.3;
    for (const Eigen::Vector3d& corner_m : corners_board_m) {
      const Eigen::Vector3d point_m = T_camera_board * corner_m;
      if (!is_inside || !camera.IsInFront(point_m)) {
        is_inside = false;
        break;
      }
      const Eigen::Vector2d truth_px = camera.Project(point_m);
      is_inside = camera.Contains(truth_px);
      view.corners_px.emplace_back(truth_px.x() + options.noise_px * random.Normal(),
                                   truth_px.y() + options.noise_px * random.Normal());
    }
    if (is_inside) views.push_back(view);
  }
  return views;
}

}  // namespace voqcal::test
