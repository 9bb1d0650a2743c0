#include "core/assessment/score_bins.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/camera/image_parts.hpp"

namespace voqcal {
namespace {

// Sorts poses into bins; a pose whose bin is negative is in none.
template <typename BinOf>
std::vector<ScoreBin> Sorted(const std::vector<const BoardSample*>& samples,
                             const SceneScore& score,
                             const std::vector<std::string>& names,
                             const BinOf& bin_of) {
  std::vector<std::vector<PoseScore>> poses(names.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int bin = bin_of(*samples[i]);
    if (bin >= 0) poses[static_cast<std::size_t>(bin)].push_back(score.poses[i]);
  }
  std::vector<ScoreBin> bins;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!poses[i].empty()) bins.push_back({names[i], SummariseScores(std::move(poses[i]))});
  }
  return bins;
}

}  // namespace

std::vector<ScoreBin> BinByImageCell(const std::vector<const BoardSample*>& samples,
                                     const SceneScore& score,
                                     const CameraModel& camera) {
  const auto& parts = ImagePartNames();
  const std::vector<std::string> names(parts.begin(), parts.end());
  return Sorted(samples, score, names, [&camera](const BoardSample& sample) {
    const Eigen::Vector3d& centre_camera_m = sample.camera.pose.centre_m;
    if (!camera.IsInFront(centre_camera_m)) return -1;
    return static_cast<int>(ImagePartAt(camera.Project(centre_camera_m), camera));
  });
}

std::vector<ScoreBin> BinByRange(const std::vector<const BoardSample*>& samples,
                                 const SceneScore& score) {
  constexpr std::array<double, 5> kUpToM = {2, 3, 4, 6, 10};
  const std::vector<std::string> names = {
      "up to 2 m", "2 to 3 m", "3 to 4 m", "4 to 6 m", "6 to 10 m", "beyond 10 m"};
  return Sorted(samples, score, names, [&kUpToM](const BoardSample& sample) {
    const double range_m = sample.camera.pose.centre_m.norm();
    return static_cast<int>(std::upper_bound(kUpToM.begin(), kUpToM.end(), range_m) -
                            kUpToM.begin());
  });
}

}  // namespace voqcal
