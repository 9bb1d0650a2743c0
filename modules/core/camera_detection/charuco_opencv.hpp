#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace voqcal {

/// A ChArUco board as OpenCV knows it, whichever OpenCV it is: 4.6 has markers in the contributed
/// module aruco, 4.7 and later in objdetect, with other classes.
struct CharucoLayout {
  int num_squares_x = 0;
  int num_squares_y = 0;
  float square_m = 0;
  float marker_m = 0;
  int dictionary = 0;  ///< OpenCV's number of it.
};

/// Markers of the board's dictionary in one image.
struct CharucoMarkers {
  std::vector<std::vector<cv::Point2f>> corners_px;  ///< Four each.
  std::vector<int> ids;
  int num_rejected = 0;  ///< Dark squares that are no marker.
};

/// Inner corners beside at least one marker, where OpenCV puts them.
struct CharucoCorners {
  std::vector<cv::Point2f> corners_px;
  std::vector<int> ids;  ///< Row by row, from the top left of the print.
};

CharucoMarkers DetectCharucoMarkers(const cv::Mat& grey, const CharucoLayout& layout);

/// @param markers  As DetectCharucoMarkers found them in `grey`; at least one.
CharucoCorners CornersBesideMarkers(const cv::Mat& grey,
                                    const CharucoMarkers& markers,
                                    const CharucoLayout& layout);

/// The pattern as it is printed, without margin: 8-bit, 1 channel.
cv::Mat DrawCharucoLayout(const CharucoLayout& layout, cv::Size size_px);

}  // namespace voqcal
