#include "core/estimation/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// How far two poses are from agreeing, in units of what is allowed: 1 is the limit.
struct PairError {
  double distance_m = 0.0;
  double angle_rad = 0.0;
  double relative = 0.0;  // the worse of the two over its limit

  bool Agrees() const { return relative <= 1.0; }  // false for NaN
};

class PairTable {
 public:
  PairTable(const std::vector<BoardSample>& samples, const ConsistencyOptions& options)
      : size_(samples.size()), errors_(size_ * size_) {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = i + 1; j < size_; ++j) {
        const PairError error = Compare(samples[i], samples[j], options);
        errors_[i * size_ + j] = errors_[j * size_ + i] = error;
      }
    }
  }

  std::size_t size() const { return size_; }
  const PairError& At(std::size_t i, std::size_t j) const { return errors_[i * size_ + j]; }

 private:
  static PairError Compare(const BoardSample& a,
                           const BoardSample& b,
                           const ConsistencyOptions& options) {
    const BoardPose& la = a.lidar.pose;
    const BoardPose& lb = b.lidar.pose;
    const BoardPose& ca = a.camera.pose;
    const BoardPose& cb = b.camera.pose;
    PairError error;
    error.distance_m =
        std::abs((la.centre_m - lb.centre_m).norm() - (ca.centre_m - cb.centre_m).norm());
    error.angle_rad =
        std::abs(AngleBetween(la.normal, lb.normal) - AngleBetween(ca.normal, cb.normal));
    const double by_distance = error.distance_m / options.max_distance_m;
    const double by_angle = error.angle_rad / options.max_angle_rad;
    // Not std::max, which would hide a NaN.
    error.relative = by_distance > by_angle ? by_distance : by_angle;
    if (std::isnan(by_distance)) error.relative = by_distance;
    return error;
  }

  std::size_t size_;
  std::vector<PairError> errors_;
};

using Members = std::vector<std::size_t>;

// Grows a subset from `seed`: of those that agree with all members so far, always the one that
// agrees with most of the rest; ties by index.
Members GrowFrom(std::size_t seed, const PairTable& pairs) {
  Members members{seed};
  Members candidates;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i != seed && pairs.At(seed, i).Agrees()) candidates.push_back(i);
  }
  while (!candidates.empty()) {
    std::size_t best = candidates.front();
    std::ptrdiff_t most = -1;
    for (const std::size_t i : candidates) {
      const std::ptrdiff_t agreeing =
          std::count_if(candidates.begin(), candidates.end(), [&](std::size_t j) {
            return j != i && pairs.At(i, j).Agrees();
          });
      if (agreeing > most) std::tie(best, most) = std::make_pair(i, agreeing);
    }
    members.push_back(best);
    candidates.erase(
        std::remove_if(candidates.begin(),
                       candidates.end(),
                       [&](std::size_t i) { return i == best || !pairs.At(best, i).Agrees(); }),
        candidates.end());
  }
  std::sort(members.begin(), members.end());
  return members;
}

double SumOfErrors(const Members& members, const PairTable& pairs) {
  double sum = 0.0;
  for (const std::size_t i : members) {
    for (const std::size_t j : members) sum += i == j ? 0.0 : pairs.At(i, j).relative;
  }
  return sum;
}

// The largest of the subsets grown from every seed; of equally large ones the one that agrees best.
// An exact largest clique may take exponential time; right samples agree with nearly all right
// ones, and wrong ones with few, so that growth from any right sample finds it.
Members LargestAgreeing(const PairTable& pairs) {
  Members largest;
  double largest_error = 0.0;
  for (std::size_t seed = 0; seed < pairs.size(); ++seed) {
    Members grown = GrowFrom(seed, pairs);
    const double error = SumOfErrors(grown, pairs);
    if (grown.size() < largest.size()) continue;
    if (grown.size() == largest.size() && !(error < largest_error)) continue;
    largest = std::move(grown);
    largest_error = error;
  }
  return largest;
}

// "disagrees with 28 of 29 consistent samples: ..." with the pair that is farthest off.
std::string ReasonFor(std::size_t sample,
                      const Members& consistent,
                      const PairTable& pairs,
                      const std::vector<BoardSample>& samples,
                      const ConsistencyOptions& options) {
  std::size_t num_disagreeing = 0;
  std::size_t worst = consistent.front();
  for (const std::size_t i : consistent) {
    if (!pairs.At(sample, i).Agrees()) ++num_disagreeing;
    const double error = pairs.At(sample, i).relative;
    if (std::isnan(error) || error > pairs.At(sample, worst).relative) worst = i;
  }
  const PairError& error = pairs.At(sample, worst);
  constexpr double kDegreesPerRadian = 180.0 / M_PI;
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << "disagrees with " << num_disagreeing << " of " << consistent.size()
       << " consistent samples; worst with sample " << samples[worst].id
       << ": centre distances differ by " << 1000.0 * error.distance_m << " mm (limit "
       << 1000.0 * options.max_distance_m << "), normal angles by "
       << kDegreesPerRadian * error.angle_rad << " deg (limit "
       << kDegreesPerRadian * options.max_angle_rad << ")";
  return text.str();
}

}  // namespace

std::vector<std::string> ConsistencyOptions::Problems() const {
  std::vector<std::string> problems;
  const auto require_positive = [&problems](const char* name, double value) {
    if (value > 0.0) return;
    std::ostringstream text;
    text << name << " must be positive, is " << value;
    problems.push_back(text.str());
  };
  require_positive("max_distance_m", max_distance_m);
  require_positive("max_angle_rad", max_angle_rad);
  return problems;
}

Consistency FindConsistent(const std::vector<BoardSample>& samples,
                           const ConsistencyOptions& options) {
  const std::vector<std::string> problems = options.Problems();
  if (!problems.empty()) throw std::invalid_argument("ConsistencyOptions: " + problems.front());

  Consistency result;
  constexpr std::size_t kLeastToJudge = 3;  // of two that disagree, neither is known to be wrong
  if (samples.size() < kLeastToJudge) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      result.consistent.push_back(static_cast<int>(i));
    return result;
  }
  const PairTable pairs(samples, options);
  const Members consistent = LargestAgreeing(pairs);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::binary_search(consistent.begin(), consistent.end(), i)) {
      result.consistent.push_back(static_cast<int>(i));
    } else {
      result.inconsistent.push_back(
          {static_cast<int>(i), ReasonFor(i, consistent, pairs, samples, options)});
    }
  }
  return result;
}

}  // namespace voqcal
