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

/// Markers of a dictionary in one image.
struct Markers {
  std::vector<std::vector<cv::Point2f>> corners_px;  ///< Four each, from its top left clockwise.
  std::vector<int> ids;
  int num_rejected = 0;  ///< Dark squares that are no marker.
};

/// Inner corners beside at least one marker, where OpenCV puts them.
struct CharucoCorners {
  std::vector<cv::Point2f> corners_px;
  std::vector<int> ids;  ///< Row by row, from the top left of the print.
};

/// @param dictionary  OpenCV's number of it.
Markers DetectMarkers(const cv::Mat& grey, int dictionary);

/// A marker as OpenCV prints it, upright, its border one cell wide, without margin: 8-bit, 1
/// channel, a pixel to a cell.
cv::Mat DrawMarker(int dictionary, int id, int num_cells_with_border);

/// @param markers  As DetectMarkers found them in `grey`; at least one.
CharucoCorners CornersBesideMarkers(const cv::Mat& grey,
                                    const Markers& markers,
                                    const CharucoLayout& layout);

/// The pattern as it is printed, without margin: 8-bit, 1 channel.
cv::Mat DrawCharucoLayout(const CharucoLayout& layout, cv::Size size_px);

}  // namespace voqcal
