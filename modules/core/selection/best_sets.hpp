#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace voqcal {

/// Three poses (indices, ascending) and what a criterion says of them: lower is better.
struct ScoredTriple {
  std::array<int, 3> poses{};
  double score = std::numeric_limits<double>::infinity();
};

/// Lowest score first, ties by index: the order of every selection.
inline bool IsBetter(const ScoredTriple& a, const ScoredTriple& b) {
  return std::tie(a.score, a.poses) < std::tie(b.score, b.poses);
}

/// The best triples offered so far.
class BestSets {
 public:
  explicit BestSets(int num_sets) : num_sets_(static_cast<std::size_t>(num_sets)) {}

  /// Above this no score can enter any more; infinite until there are enough sets.
  double Limit() const {
    return heap_.size() < num_sets_ ? std::numeric_limits<double>::infinity() : heap_.front().score;
  }

  void Offer(const ScoredTriple& triple) {
    if (heap_.size() == num_sets_) {
      if (!IsBetter(triple, heap_.front())) return;
      std::pop_heap(heap_.begin(), heap_.end(), IsBetter);
      heap_.pop_back();
    }
    heap_.push_back(triple);
    std::push_heap(heap_.begin(), heap_.end(), IsBetter);
  }

  /// Best first.
  std::vector<ScoredTriple> Sorted() && {
    std::sort_heap(heap_.begin(), heap_.end(), IsBetter);
    return std::move(heap_);
  }

 private:
  std::size_t num_sets_;
  std::vector<ScoredTriple> heap_;  // its front is the worst
};

}  // namespace voqcal
