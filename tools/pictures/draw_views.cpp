// draw_views: what a simulated rig sees, the lidar's points on the camera's image, for the pictures
// of the notes.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/tool_main.hpp"
#include "core/simulation/simulation.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "images/jpeg.hpp"
#include "report/overlays.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

/// How somebody holds the board: where its centre is, and how it is turned from facing the lidar
/// upright.
struct Hold {
  const char* name;
  Eigen::Vector3d centre_lidar_m;
  double turn_deg = 0.0;  ///< About the lidar's z.
  double nod_deg = 0.0;   ///< Its upper edge away from the lidar.
  double roll_deg = 0.0;  ///< About its own normal: 45 is a diamond.
};

const std::vector<Hold> kHolds = {
    {"good_near", {1.9, 0.35, 0.0}, 25.0, 0.0, 45.0},
    {"good_tilted", {2.4, -0.6, 0.15}, -20.0, 30.0, 40.0},
    {"good_far", {3.6, 0.9, -0.1}, 0.0, -25.0, 50.0},
    {"bad_upright", {2.2, 0.0, 0.0}, 0.0, 0.0, 0.0},
    {"bad_cut_off", {1.7, 1.0, 0.2}, 10.0, 0.0, 45.0},
    {"bad_oblique", {2.2, -0.2, 0.0}, 72.0, 0.0, 45.0},
};

// A plain lens of a narrower view than the rig's: what matters is large in a small picture.
CameraModel PictureCamera() {
  CameraModel camera;
  camera.width_px = 720;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 480.0;
  camera.cx_px = 359.5;
  camera.cy_px = 239.5;
  return camera;
}

Eigen::Isometry3d PoseOf(const Hold& hold) {
  const auto turn = [](double angle_deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis).toRotationMatrix();
  };
  Eigen::Matrix3d facing;  // board x to the right as the lidar sees it, y up, z towards it
  facing << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  T_lidar_board.linear() = turn(hold.turn_deg, Eigen::Vector3d::UnitZ()) *
                           turn(hold.nod_deg, Eigen::Vector3d::UnitY()) * facing *
                           turn(hold.roll_deg, Eigen::Vector3d::UnitZ());
  T_lidar_board.translation() = hold.centre_lidar_m;
  return T_lidar_board;
}

void Write(const std::filesystem::path& path, const cv::Mat& image) {
  const std::vector<std::uint8_t> bytes = EncodeJpeg(image, 95);
  WriteFileAtomically(path, std::string(bytes.begin(), bytes.end()));
}

// An error that a wrong calibration may well have: two degrees and five centimetres.
Eigen::Isometry3d Spoilt(const Eigen::Isometry3d& T_camera_lidar) {
  return Eigen::Translation3d(0.05, 0.0, 0.0) *
         Eigen::AngleAxisd(2.0 * kRadPerDeg, Eigen::Vector3d(0.6, 0.8, 0.0)) * T_camera_lidar;
}

void DrawViews(const std::filesystem::path& rig_path, const std::filesystem::path& folder) {
  Rig rig = LoadRig(rig_path);
  rig.camera = PictureCamera();
  rig.simulation.image_noise = 0.0;  // the files are smaller by half
  rig.simulation.num_poses = 1;
  const Simulation world(rig.simulation, rig.board, rig.camera);
  const Eigen::Isometry3d& truth = rig.simulation.T_camera_lidar;
  const BoardSample no_sample;
  std::filesystem::create_directories(folder);
  for (const Hold& hold : kHolds) {
    const cv::Mat image = world.Image(0.0, PoseOf(hold));
    const PointCloud sweep = world.Sweep(0.0, PoseOf(hold));
    const PosePicture picture{no_sample, image, sweep};
    Write(folder / (std::string(hold.name) + ".jpg"), DrawScene(picture, rig.camera, truth));
    if (hold.name != std::string("good_near")) continue;
    Write(folder / "overlay_bad.jpg", DrawScene(picture, rig.camera, Spoilt(truth)));
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Draws simulated views for the pictures of the notes.", "draw_views");
  std::filesystem::path rig;
  std::filesystem::path folder;
  app.add_option("rig", rig, "The rig file, whose simulation is drawn")->required();
  app.add_option("folder", folder, "Where the pictures go")->required();
  return voqcal::RunTool(&app, argc, argv, [&] { voqcal::DrawViews(rig, folder); });
}
