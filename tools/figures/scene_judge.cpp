#include "figures/scene_judge.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// The scan line of a return; by elevation, 0.2 degrees apart, where the cloud has no rings.
int LineOf(const PointCloud& cloud, const LidarPoint& point) {
  if (cloud.has_ring) return point.ring;
  const Eigen::Vector3f& p = point.position_m;
  return static_cast<int>(std::lround(std::atan2(p.z(), p.head<2>().norm()) / 0.0035F));
}

// Last hits before neighbours that are a tenth farther, at least half a metre.
std::vector<Eigen::Vector3d> LastHits(const PointCloud& cloud) {
  constexpr float kRatio = 1.1F;
  constexpr float kLeastJump_m = 0.5F;
  constexpr double kGapRad = 0.015;
  std::map<int, std::map<double, Eigen::Vector3f>> lines;
  for (const LidarPoint& point : cloud.points) {
    const Eigen::Vector3f& p = point.position_m;
    if (!p.allFinite() || p.norm() < 0.5F) continue;
    lines[LineOf(cloud, point)].emplace(std::atan2(p.y(), p.x()), p);
  }
  const auto is_before = [](const Eigen::Vector3f& near, const Eigen::Vector3f& far) {
    return far.norm() > kRatio * near.norm() && far.norm() > near.norm() + kLeastJump_m;
  };
  std::vector<Eigen::Vector3d> hits;
  for (const auto& [_, line] : lines) {
    for (auto right = line.begin(), left = right; right != line.end(); left = right++) {
      if (right == left || right->first - left->first > kGapRad) continue;
      if (is_before(left->second, right->second)) hits.push_back(left->second.cast<double>());
      if (is_before(right->second, left->second)) hits.push_back(right->second.cast<double>());
    }
  }
  return hits;
}

bool IsNearBoard(const Eigen::Vector3d& point_board_m, const BoardSpec& board) {
  constexpr double kMargin_m = 0.25;
  return std::abs(point_board_m.x()) < board.width_m / 2 + kMargin_m &&
         std::abs(point_board_m.y()) < board.height_m / 2 + kMargin_m &&
         std::abs(point_board_m.z()) < 2 * kMargin_m;
}

// The gradient over its 95th percentile, at most 1.
cv::Mat StrengthOf(const cv::Mat& image) {
  cv::Mat gray = image;
  if (image.channels() == 3) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  gray.convertTo(gray, CV_32F);
  cv::GaussianBlur(gray, gray, cv::Size(), 1.0 + image.cols / 1500.0);
  cv::Mat dx;
  cv::Mat dy;
  cv::Scharr(gray, dx, CV_32F, 1, 0);
  cv::Scharr(gray, dy, CV_32F, 0, 1);
  cv::Mat magnitude;
  cv::magnitude(dx, dy, magnitude);
  std::vector<float> sorted(magnitude.begin<float>(), magnitude.end<float>());
  const auto strong = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 95 / 100);
  std::nth_element(sorted.begin(), strong, sorted.end());
  cv::Mat strength = magnitude / std::max(*strong, 1e-6F);
  return cv::min(strength, 1.0);
}

}  // namespace

JudgedScene MakeJudgedScene(const PointCloud& cloud_lidar_m,
                            const cv::Mat& image,
                            const BoardSample& sample,
                            const BoardSpec& board) {
  JudgedScene scene;
  const Eigen::Isometry3d T_board_lidar = TransformFromPose(sample.lidar.pose).inverse();
  for (const Eigen::Vector3d& hit : LastHits(cloud_lidar_m)) {
    if (!IsNearBoard(T_board_lidar * hit, board)) scene.edges_lidar_m.push_back(hit);
  }
  scene.strength = StrengthOf(image);
  return scene;
}

double JudgeScenes(const std::vector<JudgedScene>& scenes,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar) {
  double sum = 0;
  int num = 0;
  for (const JudgedScene& scene : scenes) {
    for (const Eigen::Vector3d& edge : scene.edges_lidar_m) {
      const Eigen::Vector3d edge_camera_m = T_camera_lidar * edge;
      if (!camera.IsInFront(edge_camera_m)) continue;
      const Eigen::Vector2d pixel_px = camera.Project(edge_camera_m);
      if (!camera.Contains(pixel_px)) continue;
      const int x = std::clamp(static_cast<int>(std::lround(pixel_px.x())), 0, camera.width_px - 1);
      const int y =
          std::clamp(static_cast<int>(std::lround(pixel_px.y())), 0, camera.height_px - 1);
      sum += scene.strength.at<float>(y, x);
      ++num;
    }
  }
  return num == 0 ? 0 : sum / num;
}

BestRotation FindBestRotation(const std::vector<JudgedScene>& scenes,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar) {
  constexpr double kFirstStepRad = 0.005;
  constexpr double kLastStepRad = 0.0002;
  const auto score_at = [&](const Eigen::Vector3d& turn_rad) {
    Vector6d delta = Vector6d::Zero();
    delta.head<3>() = turn_rad;
    return JudgeScenes(scenes, camera, PerturbLeft(T_camera_lidar, delta));
  };
  BestRotation best{Eigen::Vector3d::Zero(), score_at(Eigen::Vector3d::Zero())};
  for (double step_rad = kFirstStepRad; step_rad > kLastStepRad; step_rad /= 2) {
    for (bool is_climbing = true; is_climbing;) {
      is_climbing = false;
      const Eigen::Vector3d from_rad = best.turn_rad;
      for (int i = 0; i < 6; ++i) {
        const Eigen::Vector3d turn_rad =
            from_rad + (i % 2 == 0 ? step_rad : -step_rad) * Eigen::Vector3d::Unit(i / 2);
        const double score = score_at(turn_rad);
        if (score <= best.score) continue;
        best = {turn_rad, score};
        is_climbing = true;
      }
    }
  }
  return best;
}

}  // namespace voqcal
