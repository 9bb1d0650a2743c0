#include "core/guidance/weakest_pair.hpp"

#include <cmath>
#include <map>

namespace voqcal {
namespace {

// By how much more another must be unknown for the operator to be sent there.
constexpr double kMuchMore = 2.0;

/// By sensor, which part of the rig it is in: those that results join.
std::map<std::string, std::size_t> PartsOf(const std::vector<PairNeed>& pairs) {
  std::map<std::string, std::size_t> parts;
  for (const PairNeed& pair : pairs) {
    parts.emplace(pair.from, parts.size());
    parts.emplace(pair.to, parts.size());
  }
  for (const PairNeed& pair : pairs) {
    if (!pair.grade) continue;
    const std::size_t gone = parts[pair.to];
    for (auto& [sensor, part] : parts) {
      if (part == gone) part = parts[pair.from];
    }
  }
  return parts;
}

/// How much a pair needs samples: the smallest kind most, of one kind the largest size.
struct Urgency {
  int kind = 0;
  double size = 0.0;  ///< Of kinds with a result the error, else the number of samples.

  bool IsAbove(const Urgency& other) const {
    return kind != other.kind ? kind < other.kind : size > other.size;
  }
};

constexpr int kIsNotJoined = 0;
constexpr int kIsNotJoinedAndHasNoPlace = 1;
constexpr int kIsNotEnough = 2;  // and one more for each better grade
constexpr int kIsEnough = 5;
constexpr int kHasNoPlace = 8;
constexpr int kIsJoinedByOthers = 9;
constexpr int kCannotBeSampled = 10;  // and one more without a result

Urgency UrgencyOf(const PairNeed& pair, const std::map<std::string, std::size_t>& parts) {
  const double error =
      std::isnan(pair.worst_error) ? std::numeric_limits<double>::infinity() : pair.worst_error;
  if (!pair.grade) {
    const bool is_joined = parts.at(pair.from) == parts.at(pair.to);
    const int kind = !pair.can_be_sampled ? kCannotBeSampled + 1
                     : is_joined          ? kIsJoinedByOthers
                     : pair.has_place     ? kIsNotJoined
                                          : kIsNotJoinedAndHasNoPlace;
    return {kind, static_cast<double>(pair.num_samples)};
  }
  if (!pair.can_be_sampled) return {kCannotBeSampled, error};
  const int better = *pair.grade == Grade::kBad ? 0 : *pair.grade == Grade::kLook ? 1 : 2;
  if (pair.is_enough) return {kIsEnough + better, error};
  return {pair.has_place ? kIsNotEnough + better : kHasNoPlace, error};
}

bool MayStay(const PairNeed& pair, const Urgency& before, const Urgency& weakest) {
  if (pair.num_samples == 0 || before.kind != weakest.kind) return false;
  return !pair.grade || weakest.size <= kMuchMore * before.size;
}

}  // namespace

std::optional<std::size_t> WeakestPair(const std::vector<PairNeed>& pairs,
                                       const std::optional<std::size_t>& before) {
  const std::map<std::string, std::size_t> parts = PartsOf(pairs);
  std::vector<Urgency> urgencies;
  std::optional<std::size_t> weakest;
  for (const PairNeed& pair : pairs) {
    urgencies.push_back(UrgencyOf(pair, parts));
    const std::size_t i = urgencies.size() - 1;
    if (!weakest || urgencies[i].IsAbove(urgencies[*weakest])) weakest = i;
  }
  if (before && weakest && MayStay(pairs.at(*before), urgencies[*before], urgencies[*weakest])) {
    return before;
  }
  return weakest;
}

}  // namespace voqcal
