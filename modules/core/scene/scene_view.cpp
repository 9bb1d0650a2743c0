#include "core/scene/scene_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "core/format.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

bool IsAtBoard(const Eigen::Vector3d& point_board_m, const BoardSpec& board, double margin_m) {
  return std::abs(point_board_m.x()) < board.width_m / 2 + margin_m &&
         std::abs(point_board_m.y()) < board.height_m / 2 + margin_m &&
         std::abs(point_board_m.z()) < margin_m;
}

std::vector<DepthEdge> WithoutBoard(const std::vector<DepthEdge>& edges,
                                    const BoardPose& pose_lidar,
                                    const BoardSpec& board,
                                    double margin_m) {
  const Eigen::Isometry3d T_board_lidar = TransformFromPose(pose_lidar).inverse();
  std::vector<DepthEdge> others;
  for (const DepthEdge& edge : edges) {
    if (!IsAtBoard(T_board_lidar * edge.position_lidar_m.cast<double>(), board, margin_m)) {
      others.push_back(edge);
    }
  }
  return others;
}

cv::Mat ReducedGray(const cv::Mat& image, int max_width_px) {
  cv::Mat gray = image;
  if (image.channels() == 3) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  while (gray.cols > max_width_px) {
    cv::Mat half;
    cv::resize(gray, half, cv::Size(gray.cols / 2, gray.rows / 2), 0, 0, cv::INTER_AREA);
    gray = half;
  }
  return gray;
}

cv::Mat GradientMagnitude(const cv::Mat& gray, double blur_px) {
  cv::Mat smooth;
  cv::GaussianBlur(gray, smooth, cv::Size(), blur_px);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(smooth, dx, CV_16S, 1, 0);
  cv::Sobel(smooth, dy, CV_16S, 0, 1);
  cv::Mat magnitude(gray.size(), CV_16U);
  for (int y = 0; y < gray.rows; ++y) {
    for (int x = 0; x < gray.cols; ++x) {
      const int gx = dx.at<short>(y, x);
      const int gy = dy.at<short>(y, x);
      // To the nearest: the root of a whole number is never half-way.
      magnitude.at<ushort>(y, x) =
          static_cast<ushort>(std::sqrt(static_cast<double>(gx * gx + gy * gy)) + 0.5);
    }
  }
  return magnitude;
}

// The board with its margin as a convex outline in the reduced image, filled with 0 in a mask of 1.
cv::Mat BackgroundMask(const cv::Size& size,
                       double reduction,
                       const BoardPose& pose_camera,
                       const BoardSpec& board,
                       const CameraModel& camera,
                       double margin_m) {
  cv::Mat mask(size, CV_8U, cv::Scalar(1));
  const Eigen::Isometry3d T_camera_board = TransformFromPose(pose_camera);
  const double x_m = board.width_m / 2 + margin_m;
  const double y_m = board.height_m / 2 + margin_m;
  std::vector<cv::Point> outline;
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-x_m, -y_m, 0),
                                        Eigen::Vector3d(x_m, -y_m, 0),
                                        Eigen::Vector3d(x_m, y_m, 0),
                                        Eigen::Vector3d(-x_m, y_m, 0)}) {
    const Eigen::Vector3d corner_camera_m = T_camera_board * corner;
    if (!camera.IsInFront(corner_camera_m)) continue;
    const Eigen::Vector2d pixel = camera.Project(corner_camera_m) / reduction;
    outline.emplace_back(static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
  }
  if (outline.size() >= 3) cv::fillConvexPoly(mask, outline, cv::Scalar(0));
  return mask;
}

cv::Mat RankOf(const cv::Mat& magnitude, const cv::Mat& mask) {
  std::array<int, 65536> counts{};
  int num_counted = 0;
  for (int y = 0; y < magnitude.rows; ++y) {
    for (int x = 0; x < magnitude.cols; ++x) {
      if (mask.at<uchar>(y, x) == 0) continue;
      ++counts[magnitude.at<ushort>(y, x)];
      ++num_counted;
    }
  }
  std::array<uchar, 65536> rank_of{};
  int num_weaker = 0;
  for (std::size_t value = 0; value < counts.size(); ++value) {
    rank_of[value] =
        static_cast<uchar>(1 + std::int64_t{254} * num_weaker / std::max(1, num_counted));
    num_weaker += counts[value];
  }
  cv::Mat rank(magnitude.size(), CV_8U);
  for (int y = 0; y < rank.rows; ++y) {
    for (int x = 0; x < rank.cols; ++x) {
      rank.at<uchar>(y, x) =
          mask.at<uchar>(y, x) == 0 ? uchar{0} : rank_of[magnitude.at<ushort>(y, x)];
    }
  }
  return rank;
}

// The mask in the reduced image, of its size and reduction.
using MakeMask = std::function<cv::Mat(const cv::Size& size, double reduction)>;

SceneView ViewOf(const std::vector<DepthEdge>& edges,
                 const cv::Mat& image,
                 const CameraModel& camera,
                 const SceneViewOptions& options,
                 const MakeMask& make_mask) {
  RequireUsable("SceneViewOptions", options.Problems());
  if (image.cols != camera.width_px || image.rows != camera.height_px || image.depth() != CV_8U) {
    throw std::invalid_argument(Format("image of %d x %d px, the camera's are %d x %d",
                                       image.cols,
                                       image.rows,
                                       camera.width_px,
                                       camera.height_px));
  }
  SceneView view;
  view.edges = edges;
  const cv::Mat gray = ReducedGray(image, options.max_image_width_px);
  view.reduction = static_cast<double>(image.cols) / gray.cols;
  view.edge_rank = RankOf(GradientMagnitude(gray, options.image_blur_px),
                          make_mask(gray.size(), view.reduction));
  return view;
}

}  // namespace

std::vector<std::string> SceneViewOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("min_jump_m", edges.min_jump_m);
  problems.RequirePositive("max_step_rad", edges.max_step_rad);
  problems.Require(board_margin_m >= 0, "board_margin_m must not be negative", board_margin_m);
  problems.Require(edges.min_range_m >= 0, "min_range_m must not be negative", edges.min_range_m);
  problems.Require(
      max_image_width_px >= 16, "max_image_width_px must be at least 16", max_image_width_px);
  problems.RequirePositive("image_blur_px", image_blur_px);
  return problems.lines();
}

SceneView MakeSceneView(const PointCloud& cloud_lidar_m,
                        const cv::Mat& image,
                        const BoardSample& sample,
                        const BoardSpec& board,
                        const CameraModel& camera,
                        const SceneViewOptions& options) {
  const auto edges = WithoutBoard(FindDepthEdges(cloud_lidar_m, options.edges),
                                  sample.lidar.pose,
                                  board,
                                  options.board_margin_m);
  return ViewOf(edges, image, camera, options, [&](const cv::Size& size, double reduction) {
    return BackgroundMask(
        size, reduction, sample.camera.pose, board, camera, options.board_margin_m);
  });
}

SceneView MakeSceneView(const PointCloud& cloud_lidar_m,
                        const cv::Mat& image,
                        const CameraModel& camera,
                        const SceneViewOptions& options) {
  const auto edges = FindDepthEdges(cloud_lidar_m, options.edges);
  return ViewOf(edges, image, camera, options, [](const cv::Size& size, double) {
    return cv::Mat(size, CV_8U, cv::Scalar(1));
  });
}

}  // namespace voqcal
