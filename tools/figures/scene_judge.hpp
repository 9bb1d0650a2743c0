#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// One scene as a judge sees it who shares nothing with the estimator (core/scene): depth edges by
/// another rule, at the last hit itself; strengths of image edges, not ranks, at full resolution.
struct JudgedScene {
  std::vector<Eigen::Vector3d> edges_lidar_m;  ///< The background's: not near the board.
  cv::Mat strength;  ///< CV_32F, 0 to 1: the gradient over the strong ones of this image, cut off.
};

JudgedScene MakeJudgedScene(const PointCloud& cloud_lidar_m,
                            const cv::Mat& image,
                            const BoardSample& sample,
                            const BoardSpec& board);

/// Mean strength of the image edges under the depth edges of all scenes; higher is better.
double JudgeScenes(const std::vector<JudgedScene>& scenes,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar);

/// The best that any rotation reaches, the translation kept: where it is and its score.
struct BestRotation {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  ///< On the left (camera) side.
  double score = 0;
};
BestRotation FindBestRotation(const std::vector<JudgedScene>& scenes,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
