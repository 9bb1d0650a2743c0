#include "design_board/board_design.hpp"

#include <algorithm>
#include <cmath>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/worst_error.hpp"
#include "core/guidance/expected_sample.hpp"
#include "core/guidance/extrinsic_information.hpp"
#include "core/guidance/next_pose.hpp"

namespace voqcal {
namespace {

/// Where the rig file has the camera: its guess, or its simulation's truth; else the lidar (x
/// forward, z up) looks where the camera does.
Eigen::Isometry3d ExtrinsicOf(const Rig& rig) {
  if (rig.T_camera_lidar_guess) return *rig.T_camera_lidar_guess;
  if (rig.lidar_driver.source == LidarDriverOptions::Source::kSimulator) {
    return rig.simulation.T_camera_lidar;
  }
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T_camera_lidar;
}

double WorstErrorMm(const Rig& rig, const Matrix6d& covariance, double range_m) {
  ErrorTolerance at;
  at.min_range_m = at.max_range_m = range_m;
  return ErrorScene(rig.camera, ExtrinsicOf(rig), at).Worst(covariance).error;
}

/// A session that holds the board where the guidance asks, and sees what is expected.
class ExpectedSession {
 public:
  ExpectedSession(const Rig& rig, const BoardSpec& board)
      : rig_(rig),
        guided_{board, rig.camera, rig.extrinsic_refiner.likelihood},
        belief_{ExtrinsicOf(rig), {}, {}} {}

  /// @return why there is no further place; empty if there was one.
  std::string AddPose() {
    const NextPose next = ProposeNextPose({Samples(), belief_, {}}, guided_, rig_.pose_guide);
    if (!next.problem.empty()) return next.problem;
    samples_.push_back(ExpectedSample(next.T_camera_board,
                                      belief_.T_camera_lidar,
                                      guided_.board,
                                      rig_.camera,
                                      rig_.pose_guide.sensors));
    return "";
  }

  BoardDesign Design() const {
    const ExtrinsicInformation information(
        Samples(), belief_, guided_.likelihood, rig_.pose_guide.sensors.num_rows);
    const Matrix6d covariance = information.Covariance();
    BoardDesign design{guided_.board, static_cast<int>(samples_.size()), {}};
    for (std::size_t i = 0; i < kDesignRangesM.size(); ++i) {
      design.worst_errors_mm[i] = WorstErrorMm(rig_, covariance, kDesignRangesM[i]);
    }
    return design;
  }

 private:
  std::vector<const BoardSample*> Samples() const {
    std::vector<const BoardSample*> samples;
    for (const BoardSample& sample : samples_) samples.push_back(&sample);
    return samples;
  }

  const Rig& rig_;
  GuidedRig guided_;
  ExtrinsicBelief belief_;
  std::list<BoardSample> samples_;
};

}  // namespace

BoardSpec Scaled(const BoardSpec& board, double scale) {
  BoardSpec scaled = board;
  for (double BoardSpec::*length : {&BoardSpec::width_m,
                                    &BoardSpec::height_m,
                                    &BoardSpec::square_m,
                                    &BoardSpec::pattern_offset_x_m,
                                    &BoardSpec::pattern_offset_y_m,
                                    &BoardSpec::marker_m}) {
    scaled.*length = 1e-3 * std::round(1e3 * scale * (scaled.*length));
  }
  return scaled;
}

std::vector<BoardDesign> PredictDesigns(const Rig& rig,
                                        const BoardSpec& board,
                                        const std::vector<int>& nums_poses,
                                        std::string* why_fewer) {
  ExpectedSession session(rig, board);
  std::vector<BoardDesign> designs;
  int num_poses = 0;
  for (const int wanted : nums_poses) {
    for (; num_poses < wanted; ++num_poses) {
      *why_fewer = session.AddPose();
      if (!why_fewer->empty()) return designs;
    }
    designs.push_back(session.Design());
  }
  return designs;
}

std::optional<BoardDesign> Recommended(const std::vector<BoardDesign>& designs,
                                       double tolerance_mm) {
  const auto first = std::find_if(designs.begin(), designs.end(), [&](const BoardDesign& design) {
    return design.worst_errors_mm.front() <= tolerance_mm;
  });
  if (first == designs.end()) return {};
  return *first;
}

}  // namespace voqcal
