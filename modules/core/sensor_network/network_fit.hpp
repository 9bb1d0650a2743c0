#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/sensor_network/pair_graph.hpp"
#include "core/sensor_network/sensor_pair.hpp"

namespace voqcal {

/// Sensors by number, and the pairs between them.
struct NumberedPairs {
  std::size_t num_sensors = 0;
  std::size_t reference = 0;
  std::vector<PairLink> links;    ///< Which sensors a pair is of.
  std::vector<SensorPair> pairs;  ///< As many.

  NumberedPairs Without(std::size_t pair) const;
};

/// Where all sensors stand, by the pairs that join them to the reference.
struct NetworkFit {
  std::vector<Eigen::Isometry3d> T_reference_sensor;
  /// Six rows a sensor, of [rotation_rad; translation_m], perturbed on the left (reference side);
  /// those of the reference are zero.
  Eigen::MatrixXd covariance;

  /// T_to_from of two sensors.
  SensorPair Between(std::size_t from, std::size_t to) const;
};

/// The sensors' poses with the least sum of squared differences from the pairs, each weighed by its
/// covariance:
///     r = DifferenceLeft(T_reference_to^-1 T_reference_from, T_to_from of the pair)
///
/// Pairs of one session share boards and the sensors' own faults: a loop closes whether these are
/// small or not, and tells nothing new of them. So the information of the pairs of a part of the
/// graph that loops hold together counts by the share of them that a tree needs (n - 1 of m). By
/// Foster's theorem (the sum over a graph's links of conductance times effective resistance is
/// n - 1; Foster 1949, "The average impedance of an electrical network") a joined pair is then as
/// uncertain as it was alone, in the mean over the part's pairs: a pair that is weaker than others
/// gains by them, and all together gain nothing.
///
/// @param graph  of `numbered`, in one piece.
NetworkFit FitNetwork(const NumberedPairs& numbered, const PairGraph& graph);

}  // namespace voqcal
