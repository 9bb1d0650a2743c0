#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/board_prop.hpp"
#include "core/simulation/pixel_rays.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// Renders what the camera sees. The room is painted once, in the constructor; each frame paints
/// stand and board over it, only where they are.
class CameraSimulator {
 public:
  CameraSimulator(const SimulationOptions& options,
                  const BoardSpec& board,
                  const CameraModel& camera,
                  const Room& room);

  /// 8-bit BGR.
  cv::Mat Render(const Eigen::Isometry3d& T_lidar_board, std::int64_t frame_us) const;

 private:
  void PaintTube(const Tube& tube_camera, const cv::Rect& area, cv::Mat* sharp) const;
  void PaintBoard(const Eigen::Isometry3d& T_lidar_board,
                  const cv::Rect& area,
                  cv::Mat* sharp) const;
  void AddNoise(std::int64_t frame_us, cv::Mat* image) const;

  SimulationOptions options_;
  BoardSpec board_;
  CameraModel camera_;
  BoardFace face_;
  double floor_z_m_;
  PixelRays rays_;
  cv::Mat room_range_m_;             ///< CV_32F: how far the room is at each pixel.
  cv::Mat room_sharp_;               ///< CV_32FC3, grey levels: before the lens' blur.
  cv::Mat room_image_;               ///< CV_8UC3: after it.
  std::vector<std::int16_t> noise_;  ///< Grey levels; each image row reads a stretch of its own.
};

}  // namespace voqcal
