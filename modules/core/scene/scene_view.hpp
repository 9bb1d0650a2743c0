#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/scene/depth_edges.hpp"

namespace voqcal {

/// How depth edges and image edges are taken from what the sensors saw.
struct SceneViewOptions {
  DepthEdgeOptions edges;
  double board_margin_m = 0.2;   ///< Around the board nothing is taken for background.
  int max_image_width_px = 960;  ///< Larger images are halved until they fit.
  double image_blur_px = 1.0;    ///< 1 sigma, of the reduced image, before its gradient.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The edges of one scene's background in both sensors; small enough to keep those of a session.
struct SceneView {
  std::vector<DepthEdge> edges;
  /// Of the reduced image, CV_8U: 0 where the board hides the background, else 1 + 254 times the
  /// share of the image's background whose gradient is weaker.
  cv::Mat edge_rank;
  double reduction = 1.0;  ///< Pixels of the image to one of edge_rank.
};

/// @param cloud_lidar_m  any sweep; returns of one ring, or else of one elevation, are neighbours.
/// @param image  8-bit, 1 or 3 channels, of the camera's size.
/// @param sample  where both sensors saw the board in this scene.
/// @throws std::invalid_argument if `image` has another size, or `options` have Problems().
SceneView MakeSceneView(const PointCloud& cloud_lidar_m,
                        const cv::Mat& image,
                        const BoardSample& sample,
                        const BoardSpec& board,
                        const CameraModel& camera,
                        const SceneViewOptions& options);

/// The same of a scene without a board, or with one that need not be left out.
SceneView MakeSceneView(const PointCloud& cloud_lidar_m,
                        const cv::Mat& image,
                        const CameraModel& camera,
                        const SceneViewOptions& options);

}  // namespace voqcal
