#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/rigid.hpp"
#include "support/spoilt_image.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// One image of a board, and where it truly is.
struct CameraScene {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  cv::Mat image;
};

/// What spoils the images: "clear" is noise of 2 grey levels only.
inline const std::vector<std::string> kCameraSceneKinds = {
    "clear", "blurred", "noisy", "low contrast", "uneven light", "shadow", "all of it"};

/// A board somewhere in the view, whole: at 1 to 8 m for a focal length of 1177 px (nearer for a
/// shorter one), slanted by up to 60 degrees, held any way up.
inline Eigen::Isometry3d RandomBoardInView(const CameraModel& camera,
                                           const BoardSpec& board,
                                           Random* random) {
  const double scale = camera.fx_px / 1177;
  for (;;) {
    const double distance_m = scale * random->Uniform(1, 8);
    const double slant_rad = random->Uniform(0, M_PI / 3);
    const double towards_rad = random->Uniform(-M_PI, M_PI);
    const Eigen::Vector2d centre_px(random->Uniform(0, camera.width_px),
                                    random->Uniform(0, camera.height_px));
    const double roll_rad = random->Uniform(-M_PI, M_PI);
    const auto ray = camera.Unproject(centre_px);
    if (!ray) continue;
    Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
    // Facing the camera along the ray, then slanted.
    const Eigen::Quaterniond facing =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -*ray);
    const Eigen::Vector3d axis(std::cos(towards_rad), std::sin(towards_rad), 0);
    T_camera_board.linear() =
        facing.toRotationMatrix() * ExpSO3(slant_rad * axis) * ExpSO3({0, 0, roll_rad});
    T_camera_board.translation() = distance_m * *ray;
    bool is_inside = true;
    for (const Eigen::Vector3d& corner_m : board.OutlineBoardM()) {
      const Eigen::Vector3d point_m = T_camera_board * corner_m;
      is_inside =
          is_inside && camera.IsInFront(point_m) && camera.Contains(camera.Project(point_m));
    }
    if (is_inside) return T_camera_board;
  }
}

/// The scene of one kind and number; the same at every call.
inline CameraScene MakeCameraScene(const std::string& kind,
                                   const CameraModel& camera,
                                   const BoardSpec& board,
                                   std::uint32_t seed) {
  Random random(seed);
  CameraScene scene;
  scene.T_camera_board = RandomBoardInView(camera, board, &random);
  cv::Mat image = RenderBoard(camera, board, scene.T_camera_board);
  const Eigen::Vector2d centre_px = camera.Project(scene.T_camera_board.translation().eval());
  const auto spoils = [&kind](const char* what) { return kind == what || kind == "all of it"; };
  const double amount = kind == "all of it" ? 0.4 : 1.0;
  double noise = 2;
  if (spoils("low contrast")) image = Paled(image, random.Uniform(0.08, 0.4) / amount, 0);
  if (spoils("uneven light")) image = UnevenlyLit(image, random.Uniform(0.15, 0.5));
  if (spoils("shadow")) {
    const double angle_rad = random.Uniform(-M_PI, M_PI);
    image = WithShadow(image,
                       centre_px,
                       {std::cos(angle_rad), std::sin(angle_rad)},
                       random.Uniform(0.2, 0.5),
                       random.Uniform(1, 30));
  }
  if (spoils("blurred")) image = Blurred(image, amount * random.Uniform(1, 3));
  if (spoils("noisy")) noise = amount * random.Uniform(5, 20);
  scene.image = WithNoise(image, noise, seed);
  return scene;
}

/// Whether each true corner has a found one nearby, whatever their order.
inline bool AreTheCorners(const std::vector<Eigen::Vector2d>& found_px,
                          const CameraModel& camera,
                          const BoardSpec& board,
                          const Eigen::Isometry3d& T_camera_board) {
  const auto points_board_m = board.InnerCornersBoardM();
  const Eigen::Vector2d first_px = camera.Project(T_camera_board * points_board_m[0]);
  const Eigen::Vector2d second_px = camera.Project(T_camera_board * points_board_m[1]);
  const double max_px = std::max(1.0, 0.25 * (second_px - first_px).norm());
  for (const Eigen::Vector3d& point_m : points_board_m) {
    const Eigen::Vector2d truth_px = camera.Project(T_camera_board * point_m);
    const bool is_near = std::any_of(found_px.begin(), found_px.end(), [&](const auto& found) {
      return (found - truth_px).norm() < max_px;
    });
    if (!is_near) return false;
  }
  return true;
}

}  // namespace voqcal::test
