#include "study/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace voqcal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<int> AscendingOrder(const std::vector<double>& values) {
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&values](int a, int b) {
    return values[static_cast<std::size_t>(a)] < values[static_cast<std::size_t>(b)];
  });
  return order;
}

std::vector<double> RanksOf(const std::vector<double>& values) {
  const std::vector<int> order = AscendingOrder(values);
  const auto value_at = [&](std::size_t place) {
    return values[static_cast<std::size_t>(order[place])];
  };
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && value_at(end) == value_at(first)) ++end;
    const double shared = 0.5 * static_cast<double>(first + end - 1);
    for (; first < end; ++first) ranks[static_cast<std::size_t>(order[first])] = shared;
  }
  return ranks;
}

double Correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = Mean(x);
  const double mean_y = Mean(y);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : kNaN;
}

}  // namespace

double SpearmanCorrelation(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw std::invalid_argument("SpearmanCorrelation: unequal lengths");
  return Correlation(RanksOf(x), RanksOf(y));
}

std::vector<std::vector<int>> EqualCountBins(const std::vector<double>& values, int num_bins) {
  const std::vector<int> order = AscendingOrder(values);
  const std::size_t n = order.size();
  const std::size_t count = std::min(n, static_cast<std::size_t>(std::max(num_bins, 1)));
  std::vector<std::vector<int>> bins;
  for (std::size_t bin = 0; bin < count; ++bin) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(bin * n / count);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>((bin + 1) * n / count);
    bins.emplace_back(begin, end);
  }
  return bins;
}

double Mean(const std::vector<double>& values) {
  if (values.empty()) return kNaN;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Largest(const std::vector<double>& values) {
  if (values.empty() || std::isnan(Mean(values))) return kNaN;
  return *std::max_element(values.begin(), values.end());
}

double StandardDeviation(const std::vector<double>& values) {
  if (values.size() < 2) return kNaN;
  const double mean = Mean(values);
  double sum_of_squares = 0;
  for (const double value : values) sum_of_squares += (value - mean) * (value - mean);
  return std::sqrt(sum_of_squares / static_cast<double>(values.size() - 1));
}

}  // namespace voqcal
