#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Intrinsics from images of the board itself, by OpenCV's calibration: for who has no others. They
/// are as good as the board's places are various.
class CameraFromBoards {
 public:
  /// @param board  whose Problems() are empty.
  explicit CameraFromBoards(BoardSpec board) : board_(std::move(board)) {}

  /// @param grey  8-bit, 1 channel. One without the whole pattern, or of another size than the
  ///     first, counts only.
  void Take(const cv::Mat& grey);

  struct Estimate {
    CameraModel camera;
    std::string words;  ///< "estimated from 30 boards: 0.24 px RMS, fx 1176.9 +- 1.2 px".
  };

  /// The lens model that fits better. Nothing unless kMinBoards boards were seen and a calibration
  /// of them converges to a camera.
  std::optional<Estimate> Solve() const;

  /// The size of the images; zero without one.
  cv::Size size() const { return size_; }
  std::size_t num_images() const { return num_images_; }
  std::size_t num_boards() const { return corners_px_.size(); }

  static constexpr std::size_t kMinBoards = 5;

 private:
  BoardSpec board_;
  cv::Size size_;
  std::size_t num_images_ = 0;
  std::vector<std::vector<cv::Point3f>> corners_board_m_;  // by board
  std::vector<std::vector<cv::Point2f>> corners_px_;
};

}  // namespace voqcal
