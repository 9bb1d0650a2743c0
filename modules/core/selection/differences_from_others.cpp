#include "core/selection/differences_from_others.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "core/estimation/set_extrinsic.hpp"
#include "core/estimation/variance_components.hpp"
#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kLeastOthers = 7;  // fewer cannot tell how large errors are

std::vector<const BoardSample*> Without(std::vector<const BoardSample*> samples, std::size_t i) {
  samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(i));
  return samples;
}

double SquaredSigmas(const MixedDifference& d) { return d.r.dot(d.C.llt().solve(d.r)); }

std::optional<SampleDifference> DifferenceFromOthers(const std::vector<const BoardSample*>& samples,
                                                     std::size_t i,
                                                     const CameraModel& camera) {
  const std::vector<const BoardSample*> others = Without(samples, i);
  if (others.empty()) return {};
  const MixedFit mixed = FitWithErrors(others, camera, AnalyticExtrinsic(others));
  if (!mixed.is_usable) return {};
  MixedDifference d = DifferenceOf(*samples[i], camera, mixed);
  d.C += d.J * mixed.covariance * d.J.transpose();
  return SampleDifference{samples[i]->id,
                          NumMeasuredSides(samples[i]->lidar),
                          d.r,
                          d.C.diagonal().cwiseSqrt(),
                          std::sqrt(SquaredSigmas(d))};
}

// The one that lies farthest from the others if errors are as large as in all, itself included: in
// one step from the fit of all, since the errors themselves hardly depend on one of many.
std::size_t Farthest(const std::vector<const BoardSample*>& samples,
                     const CameraModel& camera,
                     const MixedFit& mixed) {
  std::vector<MixedDifference> differences;
  MixedMatrix information = MixedPriorInformation(mixed.shared_prior);
  MixedVector pull = MixedVector::Zero();  // the priors' own cancels at the fit
  for (const BoardSample* sample : samples) {
    const MixedDifference& d = differences.emplace_back(DifferenceOf(*sample, camera, mixed));
    const Eigen::LLT<Matrix6d> cholesky(d.C);
    information += d.J.transpose() * cholesky.solve(d.J);
    pull -= d.J.transpose() * cholesky.solve(d.r);
  }
  std::size_t farthest = 0;
  double largest = -1.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    MixedDifference d = differences[i];
    const Eigen::LLT<Matrix6d> cholesky(d.C);
    const MixedMatrix without = information - d.J.transpose() * cholesky.solve(d.J);
    const MixedMatrix covariance = without.llt().solve(MixedMatrix::Identity());
    d.r += d.J * (covariance * (pull + d.J.transpose() * cholesky.solve(d.r)));
    d.C += d.J * covariance * d.J.transpose();
    const double squared = SquaredSigmas(d);
    if (!(squared > largest)) continue;
    largest = squared;
    farthest = i;
  }
  return farthest;
}

}  // namespace

std::vector<SampleDifference> DifferencesFromOthers(const std::vector<const BoardSample*>& samples,
                                                    const CameraModel& camera) {
  std::vector<SampleDifference> differences;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto difference = DifferenceFromOthers(samples, i, camera);
    if (difference) differences.push_back(*difference);
  }
  return differences;
}

std::vector<SampleDifference> FindOutlying(std::vector<const BoardSample*> samples,
                                           const CameraModel& camera) {
  std::vector<SampleDifference> outlying;
  while (samples.size() > kLeastOthers) {
    const MixedFit mixed = FitWithErrors(samples, camera, AnalyticExtrinsic(samples));
    if (!mixed.is_usable) break;
    const std::size_t farthest = Farthest(samples, camera, mixed);
    const auto difference = DifferenceFromOthers(samples, farthest, camera);
    if (!difference || !difference->IsWrong()) break;
    outlying.push_back(*difference);
    samples = Without(std::move(samples), farthest);
  }
  return outlying;
}

std::string ReasonFor(const SampleDifference& difference) {
  return Format("is off by %.1f mm and %.2f deg from where all the others put it: %.1f sigma",
                kMmPerM * difference.r.tail<3>().norm(),
                kDegPerRad * difference.r.head<3>().norm(),
                difference.sigmas);
}

}  // namespace voqcal
