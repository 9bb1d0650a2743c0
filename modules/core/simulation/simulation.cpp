#include "core/simulation/simulation.hpp"

#include <cmath>
#include <stdexcept>

#include "core/camera_detection/calibration_target.hpp"
#include "core/problems.hpp"
#include "core/simulation/board_script.hpp"
#include "core/simulation/camera_simulator.hpp"
#include "core/simulation/clutter.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/stop_checks.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

void RequireNone(const char* what, const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text = what;
  for (const std::string& problem : problems)
    text += (&problem == &problems[0] ? ": " : "; ") + problem;
  throw std::invalid_argument(text);
}

const SimulationOptions& Checked(const SimulationOptions& options,
                                 const BoardSpec& board,
                                 const CameraModel& camera) {
  RequireNone("simulation", options.Problems());
  RequireNone("board", BoardProblems(board));
  RequireNone("camera", camera.Problems());
  return options;
}

std::int64_t Microseconds(double time_s) { return std::llround(time_s * 1e6); }

}  // namespace

std::vector<std::string> SimulationOptions::Problems() const {
  ProblemList problems;
  const auto require_sigma = [&problems](const char* rule, double value) {
    problems.Require(value >= 0 && std::isfinite(value), rule, value);
  };
  const Eigen::Matrix3d R = T_camera_lidar.linear();
  const double skew = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm();
  problems.Require(skew < 1e-6 && R.determinant() > 0,
                   "T_camera_lidar must be a rotation and a translation: |R'R - I|",
                   skew);
  problems.Require(T_camera_lidar.translation().norm() < 1.0,
                   "T_camera_lidar must keep the camera within 1 m of the lidar: |t|",
                   T_camera_lidar.translation().norm());
  problems.Require(num_poses >= 1, "num_poses must be at least 1", num_poses);
  problems.Require(hold_s > 0 && std::isfinite(hold_s), "hold_s must be positive", hold_s);
  problems.Require(move_s > 0 && std::isfinite(move_s), "move_s must be positive", move_s);
  problems.RequirePositive("min_distance_m", min_distance_m);
  problems.Require(max_distance_m >= min_distance_m && std::isfinite(max_distance_m),
                   "max_distance_m must be at least min_distance_m",
                   max_distance_m);
  problems.Require(
      second_board_scale == 0 || (second_board_scale >= 0.2 && second_board_scale <= 2.0),
      "second_board_scale must be 0 or within 0.2 and 2",
      second_board_scale);
  problems.Add(scan.Problems());
  require_sigma("range_noise_m must not be negative", range_noise_m);
  require_sigma("ring_bias_m must not be negative", ring_bias_m);
  problems.Require(std::isfinite(common_bias_m), "common_bias_m must be finite", common_bias_m);
  problems.Require(std::isfinite(dark_bias_m), "dark_bias_m must be finite", dark_bias_m);
  require_sigma("intensity_noise must not be negative", intensity_noise);
  problems.Require(beam_divergence_rad >= 0 && beam_divergence_rad <= 0.05,
                   "beam_divergence_deg must be within 0 and 2.86",
                   beam_divergence_rad / kRadPerDeg);
  problems.Require(pointing_noise_rad >= 0 && pointing_noise_rad <= 0.01,
                   "pointing_noise_deg must be within 0 and 0.57",
                   pointing_noise_rad / kRadPerDeg);
  problems.Require(dropout >= 0 && dropout < 1, "dropout must be within 0 and 1", dropout);
  require_sigma("image_noise must not be negative", image_noise);
  problems.Require(image_blur_px >= 0 && image_blur_px <= 10,
                   "image_blur_px must be within 0 and 10",
                   image_blur_px);
  return problems.lines();
}

struct Simulation::Impl {
  Impl(const SimulationOptions& options, const BoardSpec& board, const CameraModel& camera)
      : room(ClutterOf(Checked(options, board, camera), board)),
        checks(options, board, camera, room),
        script(options, board, camera, room),
        lidar(options, board, room),
        camera_view(options, board, camera, room) {}

  Room room;
  StopChecks checks;
  BoardScript script;
  LidarSimulator lidar;
  CameraSimulator camera_view;
};

Simulation::Simulation(const SimulationOptions& options,
                       const BoardSpec& board,
                       const CameraModel& camera)
    : impl_(std::make_unique<Impl>(options, board, camera)) {}

Simulation::~Simulation() = default;

double Simulation::DurationS() const { return impl_->script.DurationS(); }

Eigen::Isometry3d Simulation::T_lidar_board(double time_s) const {
  return impl_->script.T_lidar_board(time_s);
}

bool Simulation::IsStill(double time_s) const { return impl_->script.IsStill(time_s); }

PointCloud Simulation::Sweep(double time_s) const { return Sweep(time_s, T_lidar_board(time_s)); }

cv::Mat Simulation::Image(double time_s) const { return Image(time_s, T_lidar_board(time_s)); }

PointCloud Simulation::Sweep(double time_s, const Eigen::Isometry3d& T_lidar_board) const {
  return impl_->lidar.Sweep(T_lidar_board, Microseconds(time_s));
}

cv::Mat Simulation::Image(double time_s, const Eigen::Isometry3d& T_lidar_board) const {
  return impl_->camera_view.Render(T_lidar_board, Microseconds(time_s));
}

bool Simulation::CanRestAt(const Eigen::Isometry3d& T_lidar_board) const {
  return impl_->checks.IsGood(T_lidar_board);
}

}  // namespace voqcal
