#include "core/guidance/weakest_pair.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace voqcal {
namespace {

// By how much more another must be unknown for the operator to be sent there.
constexpr double kMuchMore = 2.0;

/// 0 for the kind that needs samples most.
int KindOf(const PairNeed& pair) {
  if (!pair.grade) return 0;
  const int of_grade = *pair.grade == Grade::kBad ? 0 : *pair.grade == Grade::kLook ? 1 : 2;
  return (pair.is_enough ? 4 : 1) + of_grade;
}

double ErrorOf(const PairNeed& pair) {
  return std::isnan(pair.worst_error) ? std::numeric_limits<double>::infinity() : pair.worst_error;
}

bool NeedsMore(const PairNeed& a, const PairNeed& b) {
  if (KindOf(a) != KindOf(b)) return KindOf(a) < KindOf(b);
  if (!a.grade) return a.num_samples > b.num_samples;
  return ErrorOf(a) > ErrorOf(b);
}

/// Those that have a result.
std::set<std::string> KnownSensors(const std::vector<PairNeed>& pairs) {
  std::set<std::string> known;
  for (const PairNeed& pair : pairs) {
    if (pair.grade) known.insert({pair.from, pair.to});
  }
  return known;
}

bool MayStay(const PairNeed& before, const PairNeed& weakest) {
  if (before.num_samples == 0 || KindOf(before) != KindOf(weakest)) return false;
  return !before.grade || ErrorOf(weakest) <= kMuchMore * ErrorOf(before);
}

}  // namespace

std::optional<std::size_t> WeakestPair(const std::vector<PairNeed>& pairs,
                                       const std::optional<std::size_t>& before) {
  const std::set<std::string> known = KnownSensors(pairs);
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool is_joined = known.count(pairs[i].from) != 0 && known.count(pairs[i].to) != 0;
    if (pairs[i].num_samples == 0 && is_joined) continue;
    if (!weakest || NeedsMore(pairs[i], pairs[*weakest])) weakest = i;
  }
  if (before && weakest && MayStay(pairs.at(*before), pairs[*weakest])) return before;
  return weakest;
}

}  // namespace voqcal
