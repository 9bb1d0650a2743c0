#include "core/selection/voq.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <Eigen/Geometry>

namespace voqcal {
namespace {

constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kLeastKappa = 3.0;  // of any 3x3 matrix: ||N||_F ||N^-1||_F >= trace(I)

// A determinant of three unit vectors below this is rounding: kappa would exceed about 1e6.
constexpr double kSingularDeterminant = 1e-12;

struct RankedSample {
  int sample = 0;
  double dimension_error_mm = 0.0;
};

// The order of the answer: lowest VOQ first, ties by index.
bool IsBetter(const VoqSet& a, const VoqSet& b) {
  return std::tie(a.voq, a.samples) < std::tie(b.voq, b.samples);
}

// The samples with a measured size, best first. The lower bound of the search relies on this order.
std::vector<RankedSample> RankByDimensionError(const std::vector<BoardSample>& samples,
                                               const BoardSpec& board) {
  std::vector<RankedSample> ranked;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error_mm = BoardDimensionErrorMm(samples[i].lidar.edge_lengths_m, board);
    if (std::isfinite(error_mm)) ranked.push_back({static_cast<int>(i), error_mm});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedSample& a, const RankedSample& b) {
    return a.dimension_error_mm < b.dimension_error_mm;
  });
  return ranked;
}

VoqSet MakeSet(const std::vector<BoardSample>& samples, std::array<RankedSample, 3> members) {
  // Ascending, so that every sum below is taken in one order however the search came here.
  std::sort(members.begin(), members.end(), [](const RankedSample& a, const RankedSample& b) {
    return a.sample < b.sample;
  });
  const BoardSample& s0 = samples[static_cast<std::size_t>(members[0].sample)];
  const BoardSample& s1 = samples[static_cast<std::size_t>(members[1].sample)];
  const BoardSample& s2 = samples[static_cast<std::size_t>(members[2].sample)];
  VoqSet set;
  set.samples = {members[0].sample, members[1].sample, members[2].sample};
  set.kappa_lidar =
      NormalConditionNumber(s0.lidar.pose.normal, s1.lidar.pose.normal, s2.lidar.pose.normal);
  set.kappa_camera =
      NormalConditionNumber(s0.camera.pose.normal, s1.camera.pose.normal, s2.camera.pose.normal);
  set.board_error_mm = (members[0].dimension_error_mm + members[1].dimension_error_mm +
                        members[2].dimension_error_mm) /
                       3.0;
  set.voq = std::max(set.kappa_lidar, set.kappa_camera) + set.board_error_mm;
  return set;
}

// The best sets so far, as a heap whose front is the worst of them.
class BestSets {
 public:
  explicit BestSets(int num_sets) : num_sets_(static_cast<std::size_t>(num_sets)) {}

  // False if no set with this e_be can be among the best any more.
  bool CanBeat(double board_error_mm) const {
    constexpr double kRoundingMargin = 1e-6;
    return sets_.size() < num_sets_ ||
           kLeastKappa + board_error_mm <= sets_.front().voq + kRoundingMargin;
  }

  void Offer(const VoqSet& set) {
    if (sets_.size() == num_sets_) {
      if (!IsBetter(set, sets_.front())) return;
      std::pop_heap(sets_.begin(), sets_.end(), IsBetter);
      sets_.pop_back();
    }
    sets_.push_back(set);
    std::push_heap(sets_.begin(), sets_.end(), IsBetter);
  }

  std::vector<VoqSet> Sorted() && {
    std::sort_heap(sets_.begin(), sets_.end(), IsBetter);
    return std::move(sets_);
  }

 private:
  std::size_t num_sets_;
  std::vector<VoqSet> sets_;
};

}  // namespace

std::vector<std::string> VoqOptions::Problems() const {
  std::vector<std::string> problems;
  if (num_sets < 1) {
    problems.push_back("num_sets must be at least 1, is " + std::to_string(num_sets));
  }
  return problems;
}

double BoardDimensionErrorMm(const std::array<double, 4>& edge_lengths_m, const BoardSpec& board) {
  const std::array<double, 4> true_lengths_m = board.EdgeLengthsM();
  double sum_m = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum_m += std::abs(edge_lengths_m[i] - true_lengths_m[i]);
  return kMillimetresPerMetre * sum_m;
}

double NormalConditionNumber(const Eigen::Vector3d& n0,
                             const Eigen::Vector3d& n1,
                             const Eigen::Vector3d& n2) {
  // The columns of N^-1 are the cross products of N's rows over the determinant.
  const Eigen::Vector3d n12 = n1.cross(n2);
  const Eigen::Vector3d n20 = n2.cross(n0);
  const Eigen::Vector3d n01 = n0.cross(n1);
  const double determinant = std::abs(n0.dot(n12));
  if (!(determinant > kSingularDeterminant)) return std::numeric_limits<double>::infinity();
  const double squared_norm = n0.squaredNorm() + n1.squaredNorm() + n2.squaredNorm();
  const double squared_adjugate_norm = n12.squaredNorm() + n20.squaredNorm() + n01.squaredNorm();
  return std::sqrt(squared_norm * squared_adjugate_norm) / determinant;
}

std::vector<VoqSet> SelectByVoq(const std::vector<BoardSample>& samples,
                                const BoardSpec& board,
                                const VoqOptions& options) {
  const std::vector<std::string> problems = options.Problems();
  if (!problems.empty()) throw std::invalid_argument("VoqOptions: " + problems.front());

  // Branch and bound over all combinations: kappa is never below 3 and e_dim ascends, so once
  // 3 + e_be exceeds the worst set kept, so do all later sets of the same loop.
  const std::vector<RankedSample> ranked = RankByDimensionError(samples, board);
  const auto error_mm = [&ranked](std::size_t i) { return ranked[i].dimension_error_mm; };
  BestSets best(options.num_sets);
  for (std::size_t i = 0; i + 2 < ranked.size(); ++i) {
    if (!best.CanBeat((error_mm(i) + error_mm(i + 1) + error_mm(i + 2)) / 3.0)) break;
    for (std::size_t j = i + 1; j + 1 < ranked.size(); ++j) {
      if (!best.CanBeat((error_mm(i) + error_mm(j) + error_mm(j + 1)) / 3.0)) break;
      for (std::size_t k = j + 1; k < ranked.size(); ++k) {
        if (!best.CanBeat((error_mm(i) + error_mm(j) + error_mm(k)) / 3.0)) break;
        const VoqSet set = MakeSet(samples, {ranked[i], ranked[j], ranked[k]});
        if (std::isfinite(set.voq)) best.Offer(set);
      }
    }
  }
  return std::move(best).Sorted();
}

}  // namespace voqcal
