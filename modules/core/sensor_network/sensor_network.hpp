#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"
#include "core/sensor_network/sensor_pair.hpp"

namespace voqcal {

/// What all other pairs together say of one that is in a loop.
struct PairClosure {
  std::size_t pair = 0;  ///< Of JoinPairs' list.
  /// From T_to_from by the others to that of the pair: [rotation_rad; translation_m], side `to`.
  Vector6d difference = Vector6d::Zero();
  double chi_square = 0.0;  ///< Of that, over both covariances; 6 degrees of freedom.

  bool Contradicts() const;  ///< By more than one in a thousand would by chance.
};

/// A rig of sensors as one tree.
struct SensorNetwork {
  std::string problem;    ///< Why there is none: which sensors to join; empty if there is one.
  std::string reference;  ///< The sensor in whose frame the others stand.
  std::vector<std::string> sensors;
  /// By sensor: p_reference = T_reference_sensor * p_sensor, metres.
  std::vector<Eigen::Isometry3d> T_reference_sensor;
  /// Six rows a sensor, of [rotation_rad; translation_m], perturbed on the left (reference side);
  /// those of the reference are zero.
  Eigen::MatrixXd covariance;
  std::vector<PairClosure> closures;  ///< Of the pairs that are in a loop.
  /// Pairs that contradict the others: the one that was left out, or several of which the loops
  /// cannot tell which is wrong; those are kept, as uncertain as they contradict.
  std::vector<std::size_t> doubtful;
  bool is_left_out = false;  ///< The one in `doubtful` is.
  std::string warning;  ///< That in a sentence, with degrees and mm; empty if none is doubtful.
  std::vector<SensorPair> given;  ///< The pairs in no loop: nothing else tells of them.

  bool IsUsable() const { return problem.empty(); }

  /// T_to_from of any two sensors, with its covariance. Of two that are joined by a pair in no loop
  /// it is that pair, to the digit.
  /// @throws std::invalid_argument for a name that is not a sensor's; std::logic_error if the
  ///     network is not usable.
  SensorPair Between(const std::string& from, const std::string& to) const;
};

/// Joins the calibrations of a rig's pairs (FitNetwork), names those that contradict the others,
/// and leaves out the one that is wrong if the loops tell which.
/// @throws std::invalid_argument for unknown and repeated names, a pair given twice, a covariance
///     that is not positive definite.
SensorNetwork JoinPairs(const std::vector<std::string>& sensors,
                        const std::string& reference,
                        const std::vector<SensorPair>& pairs);

}  // namespace voqcal
