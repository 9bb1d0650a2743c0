#include "core/sensor_network/sensor_network.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>

#include "core/format.hpp"
#include "core/problems.hpp"
#include "core/sensor_network/network_fit.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::optional<std::size_t> Find(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string NameOf(const SensorPair& pair) { return pair.from + " - " + pair.to; }

std::string Listed(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : separator) + words[i];
  return text;
}

std::vector<std::string> InputProblems(const std::vector<std::string>& sensors,
                                       const std::string& reference,
                                       const std::vector<SensorPair>& pairs) {
  ProblemList problems;
  std::set<std::string> known;
  for (const std::string& sensor : sensors) {
    problems.Require(known.insert(sensor).second, "each sensor is named once", sensor);
  }
  problems.Require(known.count(reference) > 0, "the reference must be a sensor", reference);
  std::set<std::pair<std::string, std::string>> seen;
  for (const SensorPair& pair : pairs) {
    const std::string name = NameOf(pair);
    problems.Require(known.count(pair.from) > 0 && known.count(pair.to) > 0,
                     "a pair must be of two of the sensors",
                     name);
    problems.Require(pair.from != pair.to, "a pair must be of two different sensors", name);
    problems.Require(
        seen.insert(std::minmax(pair.from, pair.to)).second, "each pair is given once", name);
    problems.Require(
        IsDefinite(pair), "a pair must be finite, its covariance positive definite", name);
  }
  return problems.lines();
}

NumberedPairs Numbered(const std::vector<std::string>& sensors,
                       const std::string& reference,
                       const std::vector<SensorPair>& pairs) {
  NumberedPairs numbered;
  numbered.num_sensors = sensors.size();
  numbered.reference = *Find(sensors, reference);
  numbered.pairs = pairs;
  for (const SensorPair& pair : pairs) {
    numbered.links.push_back({*Find(sensors, pair.from), *Find(sensors, pair.to)});
  }
  return numbered;
}

PairGraph GraphOf(const NumberedPairs& numbered) {
  return GraphOf(numbered.num_sensors, numbered.reference, numbered.links);
}

std::string PiecesProblem(const std::vector<std::string>& sensors, const PairGraph& graph) {
  if (graph.num_pieces == 1) return {};
  std::vector<std::string> pieces;
  for (int piece = 0; piece < graph.num_pieces; ++piece) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      if (graph.piece[i] == piece) names.push_back(sensors[i]);
    }
    pieces.push_back(Listed(names, ", "));
  }
  return "no pair joins these parts of the rig: " + Listed(pieces, " | ") +
         "; hold the board where a lidar and a camera of different parts both see it, until every "
         "part is joined";
}

// Each pair in a loop against all the others.
std::vector<PairClosure> Closures(const NumberedPairs& numbered) {
  const PairGraph graph = GraphOf(numbered);
  std::vector<PairClosure> closures;
  for (std::size_t l = 0; l < numbered.pairs.size(); ++l) {
    if (!graph.IsInLoop(l)) continue;
    const NumberedPairs others = numbered.Without(l);
    const SensorPair by_others =
        FitNetwork(others, GraphOf(others)).Between(numbered.links[l].from, numbered.links[l].to);
    PairClosure closure;
    closure.pair = l;
    closure.difference = DifferenceLeft(by_others.T_to_from, numbered.pairs[l].T_to_from);
    const Matrix6d C = by_others.covariance + numbered.pairs[l].covariance;
    closure.chi_square = closure.difference.dot(C.llt().solve(closure.difference));
    closures.push_back(closure);
  }
  return closures;
}

std::vector<std::size_t> Contradicting(const std::vector<PairClosure>& closures) {
  std::vector<std::size_t> pairs;
  for (const PairClosure& closure : closures) {
    if (closure.Contradicts()) pairs.push_back(closure.pair);
  }
  return pairs;
}

// Those of which it would explain everything to be wrong alone.
std::vector<std::size_t> WrongAlone(const NumberedPairs& numbered,
                                    const std::vector<std::size_t>& contradicting) {
  std::vector<std::size_t> alone;
  for (const std::size_t pair : contradicting) {
    if (Contradicting(Closures(numbered.Without(pair))).empty()) alone.push_back(pair);
  }
  return alone;
}

const PairClosure& ClosureOf(std::size_t pair, const std::vector<PairClosure>& closures) {
  return *std::find_if(
      closures.begin(), closures.end(), [pair](const auto& each) { return each.pair == pair; });
}

std::string WarningOf(const SensorNetwork& network, const std::vector<SensorPair>& pairs) {
  if (network.doubtful.empty()) return {};
  std::vector<std::string> each;
  for (const std::size_t pair : network.doubtful) {
    const Vector6d& difference = ClosureOf(pair, network.closures).difference;
    each.push_back(Format("%s (by %.2f deg, %.1f mm)",
                          NameOf(pairs[pair]).c_str(),
                          kDegPerRad * difference.head<3>().norm(),
                          1e3 * difference.tail<3>().norm()));
  }
  const std::string listed = Listed(each, ", ");
  if (network.is_left_out) return listed + " contradicts all the other pairs: it is left out";
  return "at least one of these pairs is wrong, and the loops cannot tell which: " + listed +
         "; what hangs on them is as uncertain as they contradict";
}

}  // namespace

bool PairClosure::Contradicts() const {
  constexpr double kMaxChiSquare = 22.458;  // 99.9 %, 6 degrees of freedom
  return !(chi_square <= kMaxChiSquare);
}

SensorPair SensorNetwork::Between(const std::string& from, const std::string& to) const {
  const auto from_index = Find(sensors, from);
  const auto to_index = Find(sensors, to);
  if (!from_index || !to_index) {
    throw std::invalid_argument((from_index ? to : from) + " is not a sensor of the network");
  }
  if (!IsUsable()) throw std::logic_error("a network that is not joined: " + problem);
  for (const SensorPair& pair : given) {
    if (pair.from == from && pair.to == to) return pair;
    if (pair.from == to && pair.to == from) return Reversed(pair);
  }
  const NetworkFit fit{T_reference_sensor, covariance};
  SensorPair pair = fit.Between(*from_index, *to_index);
  pair.from = from;
  pair.to = to;
  return pair;
}

SensorNetwork JoinPairs(const std::vector<std::string>& sensors,
                        const std::string& reference,
                        const std::vector<SensorPair>& pairs) {
  RequireUsable("pairs of a rig", InputProblems(sensors, reference, pairs));
  NumberedPairs numbered = Numbered(sensors, reference, pairs);
  SensorNetwork network;
  network.reference = reference;
  network.sensors = sensors;
  network.problem = PiecesProblem(sensors, GraphOf(numbered));
  if (!network.IsUsable()) return network;

  network.closures = Closures(numbered);
  const std::vector<std::size_t> contradicting = Contradicting(network.closures);
  const std::vector<std::size_t> alone = WrongAlone(numbered, contradicting);
  network.doubtful = alone.empty() ? contradicting : alone;
  network.is_left_out = alone.size() == 1;
  network.warning = WarningOf(network, pairs);
  for (const std::size_t pair : network.doubtful) {
    const Vector6d& difference = ClosureOf(pair, network.closures).difference;
    numbered.pairs[pair].covariance += difference * difference.transpose();
  }
  if (network.is_left_out) numbered = numbered.Without(network.doubtful.front());

  const PairGraph graph = GraphOf(numbered);
  const NetworkFit fit = FitNetwork(numbered, graph);
  network.T_reference_sensor = fit.T_reference_sensor;
  network.covariance = fit.covariance;
  for (std::size_t l = 0; l < numbered.pairs.size(); ++l) {
    if (!graph.IsInLoop(l)) network.given.push_back(numbered.pairs[l]);
  }
  return network;
}

}  // namespace voqcal
