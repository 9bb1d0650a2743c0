#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/lidar_detection/lidar_board.hpp"
#include "core/simulation/board_contact.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "core/simulation/scan_pattern.hpp"

namespace voqcal::test {

/// When the detector is told where the board is, as the camera's board and a rough extrinsic do.
enum class ExpectedBoard { kNever, kWhereUnsure, kAlways };

/// Boards in halls full of people, tripods, doors, furniture and a second board of the wrong size.
struct LidarDetectionOptions {
  ScanPattern pattern = ScanPattern::kVlp16;
  int num_sweeps = 100;
  std::uint32_t seed = 1;  ///< Of the first hall; each further one has the next.
  double min_distance_m = 1.5;
  double max_distance_m = 8.0;
  std::optional<double> dropout;  ///< Share of beams that return nothing, if not as simulated.
  /// Sweeps of each resting board, 0.1 s apart; the verdict is on the last. More than one has no
  /// prior.
  int num_frames = 1;
  std::optional<BoardContact> contact;  ///< What touches every board.
  int num_joined = 0;  ///< Sides along which a leaf in the board's plane begins, as well.
  /// The board is expected at the truth, off by as much as the prior says (1 sigma).
  ExpectedBoard expected = ExpectedBoard::kNever;
  double prior_sigma_rad = 0.015;
  double prior_sigma_m = 0.02;
};

enum class SightingVerdict { kRight, kWrong, kMissed };

/// What the detector made of one sweep, beside the truth.
struct LidarSighting {
  static constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

  std::uint32_t seed = 0;  ///< Of the hall.
  int board = 0;           ///< Which of the hall's boards.
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  BoardHits hits;      ///< Of the last sweep.
  int num_frames = 1;  ///< That the verdict is from.
  SightingVerdict verdict = SightingVerdict::kMissed;
  std::string reason;          ///< Of a miss.
  int num_measured_sides = 0;  ///< Of what was taken for the board.
  BoardPose found;             ///< What was taken for the board, if anything was.
  double centre_error_m = kUnmeasured;
  double normal_error_rad = kUnmeasured;
  /// Squared errors by their covariance, over their number of dimensions: 1 in the mean if honest.
  /// Of the centre, those dimensions count that are known to 5 cm.
  double centre_nees = kUnmeasured;
  double normal_nees = kUnmeasured;

  /// Enough of the sweep falls on the board to ask for its detection: 6 rings or 150 points.
  bool IsEnough() const { return hits.num_rings >= 6 || hits.num_points >= 150; }
  double DistanceM() const { return T_lidar_board.translation().norm(); }
  std::string Line() const;  ///< All of it, for a list of failures.
};

/// Boards in any attitude up to 50 degrees from facing the lidar, each wholly within its view,
/// hidden by nothing and 15 cm or more from anything but what is asked to touch it. Wrong: the
/// first candidate's centre is off by more than 10 cm in directions that it claims to know to 5 cm,
/// or its axes by more than 10 degrees (but for half a turn).
std::vector<LidarSighting> SightLidarBoards(const LidarDetectionOptions& options,
                                            const LidarBoardOptions& detector);

}  // namespace voqcal::test
