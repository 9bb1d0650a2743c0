#include "report/middle_scene.hpp"

#include <cmath>
#include <utility>

#include "core/median.hpp"

namespace voqcal {
namespace {

double DistanceM(const BoardSample& sample) { return sample.lidar.pose.centre_m.norm(); }

double MiddleDistanceM(const std::vector<BoardSample>& samples) {
  std::vector<double> distances_m;
  for (const BoardSample& sample : samples) distances_m.push_back(DistanceM(sample));
  return Median(distances_m);
}

}  // namespace

MiddleScene::MiddleScene(const std::vector<BoardSample>& samples)
    : middle_m_(MiddleDistanceM(samples)) {}

void MiddleScene::Offer(const BoardSample& sample,
                        const cv::Mat& image,
                        const PointCloud& sweep_lidar_m) {
  const auto rank = [this](const BoardSample& of) {
    return std::make_pair(std::abs(DistanceM(of) - middle_m_), of.id);
  };
  const std::lock_guard<std::mutex> lock(offering_);
  if (!chosen_ || rank(sample) < rank(*chosen_->sample)) {
    chosen_ = Scene{&sample, image, sweep_lidar_m};
  }
}

}  // namespace voqcal
