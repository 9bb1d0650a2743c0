#include "support/guided_session.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/board/planar_pose.hpp"
#include "core/estimation/pose_variety.hpp"
#include "core/geometry/rigid.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;

Room EmptyHall() {
  return Room(Box{{-9.0, -9.0, -1.5}, {9.0, 9.0, 3.0}, Material::kWall}, Props{});
}

class Session {
 public:
  Session(const GuidedSessionOptions& options,
          const GuidedRig& rig,
          const GuidanceOptions& guidance)
      : options_(options),
        rig_(rig),
        guidance_(guidance),
        T_truth_(options.simulation.T_camera_lidar),
        scene_(rig.camera, T_truth_, guidance.tolerance),
        lidar_(options.simulation, rig.board, EmptyHall()),
        reach_(guidance.limits),
        random_(options.seed) {
    // People do not know what is best: as slanted as simulated sessions' boards are.
    reach_.max_incidence_rad = 55.0 * kRadPerDeg;
  }

  GuidedStep Add() {
    samples_.push_back(NextSample());
    return Refine();
  }

 private:
  std::vector<const BoardSample*> Samples() const { return Pointers(samples_); }

  // The first that both detectors find: a person moves on until they do.
  BoardSample NextSample() {
    constexpr int kNumTrials = 1000;
    std::optional<NextPose> asked;
    if (options_.is_guided) {
      asked = ProposeNextPose({Samples(), belief_, covariance_}, rig_, guidance_);
    }
    for (int trial = 0; trial < kNumTrials; ++trial) {
      const auto T_camera_board = asked ? Followed(asked->T_camera_board) : Anywhere();
      if (!T_camera_board ||
          !IsInView(
              *T_camera_board, T_truth_, rig_.board, rig_.camera, guidance_.sensors, reach_)) {
        continue;
      }
      const auto sample = See(*T_camera_board);
      if (sample) return *sample;
    }
    throw std::runtime_error("no pose of the board is seen by both sensors");
  }

  std::optional<Eigen::Isometry3d> Followed(const Eigen::Isometry3d& asked) {
    Vector6d error;
    error << options_.turn_error_rad / std::sqrt(3.0) * random_.NormalVector(),
        options_.place_error_m / std::sqrt(3.0) * random_.NormalVector();
    return PerturbLeft(asked, error);
  }

  // As the simulated sessions' boards are: anywhere in the image, at any distance, tilted to 40
  // degrees each way.
  std::optional<Eigen::Isometry3d> Anywhere() {
    Placement placement;
    placement.centre_px = {random_.Uniform(0, rig_.camera.width_px - 1),
                           random_.Uniform(0, rig_.camera.height_px - 1)};
    placement.distance_m =
        random_.Uniform(guidance_.limits.min_distance_m, guidance_.limits.max_distance_m);
    placement.yaw_rad = random_.Uniform(-40.0, 40.0) * kRadPerDeg;
    placement.pitch_rad = random_.Uniform(-40.0, 40.0) * kRadPerDeg;
    const double roll_rad =
        random_.Uniform(-options_.max_random_roll_rad, options_.max_random_roll_rad);
    auto pose = PoseOf(placement, rig_.camera, T_truth_.linear().col(2));
    if (pose) pose->rotate(Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()));
    return pose;
  }

  std::optional<BoardSample> See(const Eigen::Isometry3d& T_camera_board) {
    constexpr double kWrongM = 0.1;  // what the consistency of pairs finds
    const Eigen::Isometry3d T_lidar_board = T_truth_.inverse() * T_camera_board;
    const std::int64_t frame_us = 100000 * ++num_frames_;
    const auto found = DetectLidarBoard(
        lidar_.Sweep(T_lidar_board, frame_us), rig_.board, options_.lidar_board_detector);
    if (!found) return std::nullopt;
    if ((found->front().pose.centre_m - T_lidar_board.translation()).norm() > kWrongM) {
      return std::nullopt;
    }
    BoardSample sample;
    sample.id = static_cast<std::int64_t>(samples_.size()) + 1;
    sample.lidar = found->front();
    const std::vector<Eigen::Vector3d> corners_board_m = rig_.board.InnerCornersBoardM();
    for (const Eigen::Vector3d& corner_board_m : corners_board_m) {
      const Eigen::Vector3d corner_camera_m = T_camera_board * corner_board_m;
      sample.camera.corners_px.push_back(rig_.camera.Project(corner_camera_m) +
                                         options_.corner_noise_px *
                                             random_.NormalVector().head<2>());
    }
    const auto fit = FitPlanarPose(rig_.camera, corners_board_m, sample.camera.corners_px);
    if (!fit) return std::nullopt;
    sample.camera.pose = PoseFromTransform(fit->T_camera_board, rig_.board);
    sample.camera.pose.covariance = fit->covariance;
    sample.camera.reprojection_rms_px = fit->reprojection_rms_px;
    return sample;
  }

  GuidedStep Refine() {
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    belief_.reset();
    covariance_.reset();
    if (!VarietyProblem(Samples()).empty()) return {kUnknown, kUnknown};
    Vector6d start_error;  // about what the VOQ average leaves
    start_error << 0.005, 0.003, -0.004, 0.005, -0.004, 0.006;
    const LikelihoodExtrinsic refined = RefineByLikelihood(
        Samples(), rig_.camera, PerturbLeft(T_truth_, start_error), rig_.likelihood);
    if (!refined.IsUsable()) return {kUnknown, kUnknown};
    belief_ = {refined.T_camera_lidar, refined.bias, refined.noise};
    covariance_ = refined.uncertainty.covariance;
    const Vector6d error = DifferenceLeft(T_truth_, refined.T_camera_lidar);
    return {scene_.Worst(*covariance_).error, scene_.Worst(error * error.transpose()).error};
  }

  const GuidedSessionOptions& options_;
  const GuidedRig& rig_;
  const GuidanceOptions& guidance_;
  Eigen::Isometry3d T_truth_;
  ErrorScene scene_;
  LidarSimulator lidar_;
  PlacementLimits reach_;
  Random random_;
  std::int64_t num_frames_ = 0;
  std::vector<BoardSample> samples_;
  std::optional<ExtrinsicBelief> belief_;
  std::optional<Matrix6d> covariance_;
};

}  // namespace

std::vector<GuidedStep> SimulateGuidedSession(const GuidedSessionOptions& options,
                                              const GuidedRig& rig,
                                              const GuidanceOptions& guidance) {
  Session session(options, rig, guidance);
  std::vector<GuidedStep> steps;
  for (int i = 0; i < options.num_poses; ++i) steps.push_back(session.Add());
  return steps;
}

int PosesNeeded(const std::vector<double>& errors, double tolerance) {
  auto last = static_cast<int>(errors.size());
  while (last > 0 && errors[static_cast<std::size_t>(last) - 1] <= tolerance) --last;
  return last + 1;
}

}  // namespace voqcal::test
