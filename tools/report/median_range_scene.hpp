#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Of all scenes that are offered, the one whose board's distance from the lidar is nearest to the
/// median of those of `samples`: neither so near that the board hides all else, nor so far that few
/// points are on it.
class MedianRangeScene {
 public:
  struct Scene {
    const BoardSample* sample;
    cv::Mat image;  ///< 8-bit, BGR.
    PointCloud sweep_lidar_m;
  };

  explicit MedianRangeScene(const std::vector<BoardSample>& samples);

  /// May be called by several threads at once, in any order; `sample` is referred to.
  void Offer(const BoardSample& sample, const cv::Mat& image, const PointCloud& sweep_lidar_m);

  /// Nothing if none was offered.
  const std::optional<Scene>& Chosen() const { return chosen_; }

 private:
  double median_range_m_;
  std::mutex offering_;
  std::optional<Scene> chosen_;
};

}  // namespace voqcal
