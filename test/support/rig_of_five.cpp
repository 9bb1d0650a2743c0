#include "support/rig_of_five.hpp"

#include <array>

#include "core/geometry/rigid.hpp"
#include "core/units.hpp"

namespace voqcal::test {
namespace {

CameraModel CameraOf(LensModel lens, double focal_px, const std::array<double, 8>& distortion) {
  CameraModel camera;
  camera.lens = lens;
  camera.width_px = 1280;
  camera.height_px = 800;
  camera.fx_px = focal_px;
  camera.fy_px = focal_px + 1.5;
  camera.cx_px = 641.5;
  camera.cy_px = 396.0;
  camera.distortion = distortion;
  return camera;
}

// A camera there that looks into this direction, by the given roll askew.
Eigen::Isometry3d Looking(double azimuth_deg, double roll_deg, const Eigen::Vector3d& at_rig_m) {
  Eigen::Matrix3d R_camera_level;  // camera axes from rig axes: right, down, forward
  R_camera_level << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::AngleAxisd azimuth(-azimuth_deg * kRadPerDeg, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd roll(roll_deg * kRadPerDeg, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T_camera_rig = Eigen::Isometry3d::Identity();
  T_camera_rig.linear() = roll * R_camera_level * azimuth.toRotationMatrix();
  T_camera_rig.translation() = -(T_camera_rig.linear() * at_rig_m);
  return T_camera_rig;
}

}  // namespace

RigSimulationOptions RigOfFive() {
  RigSimulationOptions rig;
  rig.world.num_poses = 60;
  rig.lidars.resize(2);
  rig.lidars[0].name = "roof";
  rig.lidars[1].name = "bumper";
  rig.lidars[1].scan.pattern = ScanPattern::kRaster;
  rig.lidars[1].T_rig_lidar.linear() = ExpSO3({2 * kRadPerDeg, -3 * kRadPerDeg, 15 * kRadPerDeg});
  rig.lidars[1].T_rig_lidar.translation() = Eigen::Vector3d(0.3, -0.1, -0.25);
  rig.cameras = {
      {"front",
       Looking(-5, 1.5, {0.1, -0.05, -0.1}),
       CameraOf(LensModel::kEquidistant, 750, {-0.032, 0.008, -0.005, 0.001})},
      {"left",
       Looking(35, -2, {0.05, 0.2, -0.08}),
       CameraOf(LensModel::kPlumbBob, 800, {-0.25, 0.08, 0.0005, -0.0003, -0.01})},
      {"rear",
       Looking(172, 1, {-0.2, 0, -0.1}),
       CameraOf(LensModel::kRational, 780, {0.4, 0.05, 0.0004, -0.0002, 0.002, 0.75, 0.1, 0.01})},
  };
  return rig;
}

}  // namespace voqcal::test
