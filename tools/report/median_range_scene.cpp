#include "report/median_range_scene.hpp"

#include <cmath>
#include <utility>

#include "core/median.hpp"

namespace voqcal {
namespace {

double RangeM(const BoardSample& sample) { return sample.lidar.pose.centre_m.norm(); }

double MedianRangeM(const std::vector<BoardSample>& samples) {
  std::vector<double> ranges_m;
  for (const BoardSample& sample : samples) ranges_m.push_back(RangeM(sample));
  return Median(ranges_m);
}

}  // namespace

MedianRangeScene::MedianRangeScene(const std::vector<BoardSample>& samples)
    : median_range_m_(MedianRangeM(samples)) {}

void MedianRangeScene::Offer(const BoardSample& sample,
                             const cv::Mat& image,
                             const PointCloud& sweep_lidar_m) {
  const auto rank = [this](const BoardSample& of) {
    return std::make_pair(std::abs(RangeM(of) - median_range_m_), of.id);
  };
  const std::lock_guard<std::mutex> lock(offering_);
  if (!chosen_ || rank(sample) < rank(*chosen_->sample)) {
    chosen_ = Scene{&sample, image, sweep_lidar_m};
  }
}

}  // namespace voqcal
