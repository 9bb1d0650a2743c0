#include "support/guided_session.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/camera_detection/planar_pose.hpp"
#include "core/geometry/rigid.hpp"
#include "core/selection/pose_variety.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "core/units.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {
namespace {

Room EmptyHall() {
  return Room(Box{{-9.0, -9.0, -1.5}, {9.0, 9.0, 3.0}, Material::kWall}, Props{});
}

// People do not know what is best: as slanted as simulated sessions' boards are.
PlacementLimits Reach(const GuidanceOptions& guidance) {
  PlacementLimits reach = guidance.limits;
  reach.max_incidence_rad = 55.0 * kRadPerDeg;
  return reach;
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
        scene_(rig.camera, T_truth_, guidance.enough.tolerance),
        lidar_(options.simulation, rig.board, EmptyHall()),
        reach_(Reach(guidance)),
        random_(options.seed) {}

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
      if (!T_camera_board) continue;
      const auto sample = See(*T_camera_board);
      if (sample) return *sample;
    }
    throw std::runtime_error("no pose of the board is seen by both sensors");
  }

  std::optional<Eigen::Isometry3d> Followed(const Eigen::Isometry3d& asked) {
    Vector6d error;
    error << options_.turn_error_rad / std::sqrt(3.0) * random_.NormalVector(),
        options_.place_error_m / std::sqrt(3.0) * random_.NormalVector();
    const Eigen::Isometry3d T_camera_board = PerturbLeft(asked, error);
    if (!IsInView(T_camera_board, T_truth_, rig_.board, rig_.camera, guidance_.sensors, reach_)) {
      return std::nullopt;
    }
    return T_camera_board;
  }

  std::optional<Eigen::Isometry3d> Anywhere() {
    return RandomHold(options_.max_random_roll_rad, T_truth_, rig_, guidance_, &random_);
  }

  std::optional<BoardSample> See(const Eigen::Isometry3d& T_camera_board) {
    constexpr double kWrongM = 0.1;  // what the consistency of pairs finds
    const Eigen::Isometry3d T_lidar_board = T_truth_.inverse() * T_camera_board;
    const std::int64_t frame_us = std::int64_t{100000} * ++num_holds_;
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
    if (!VarietyProblem(Samples()).empty()) return {num_holds_, kUnknown, kUnknown};
    Vector6d start_error;  // about what the VOQ average leaves
    start_error << 0.005, 0.003, -0.004, 0.005, -0.004, 0.006;
    const LikelihoodExtrinsic refined =
        RefineByLikelihood(Samples(), PerturbLeft(T_truth_, start_error), rig_.likelihood);
    if (!refined.IsUsable()) return {num_holds_, kUnknown, kUnknown};
    belief_ = {refined.T_camera_lidar, refined.bias, refined.noise};
    covariance_ = refined.uncertainty.covariance;
    const Vector6d error = DifferenceLeft(T_truth_, refined.T_camera_lidar);
    return {num_holds_,
            scene_.Worst(*covariance_).error,
            scene_.Worst(error * error.transpose()).error};
  }

  const GuidedSessionOptions& options_;
  const GuidedRig& rig_;
  const GuidanceOptions& guidance_;
  Eigen::Isometry3d T_truth_;
  ErrorScene scene_;
  LidarSimulator lidar_;
  PlacementLimits reach_;
  Random random_;
  int num_holds_ = 0;
  std::vector<BoardSample> samples_;
  std::optional<ExtrinsicBelief> belief_;
  std::optional<Matrix6d> covariance_;
};

}  // namespace

std::optional<Eigen::Isometry3d> RandomHold(double max_roll_rad,
                                            const Eigen::Isometry3d& T_camera_lidar,
                                            const GuidedRig& rig,
                                            const GuidanceOptions& guidance,
                                            Random* random) {
  constexpr double kMaxTiltRad = 40.0 * kRadPerDeg;
  const PlacementLimits& limits = guidance.limits;
  Placement placement;
  placement.centre_px = {random->Uniform(0, rig.camera.width_px - 1),
                         random->Uniform(0, rig.camera.height_px - 1)};
  placement.distance_m = random->Uniform(limits.min_distance_m, limits.max_distance_m);
  placement.yaw_rad = random->Uniform(-kMaxTiltRad, kMaxTiltRad);
  placement.pitch_rad = random->Uniform(-kMaxTiltRad, kMaxTiltRad);
  placement.turn_rad += random->Uniform(-max_roll_rad, max_roll_rad);
  const auto pose = PoseOf(placement, rig.camera, T_camera_lidar.linear().col(2));
  const bool is_seen =
      pose &&
      IsInView(*pose, T_camera_lidar, rig.board, rig.camera, guidance.sensors, Reach(guidance));
  return is_seen ? pose : std::nullopt;
}

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
