#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "core/camera_detection/corner_grid.hpp"

namespace voqcal {

/// By how much the squares around a chessboard's corner differ: mean grey level of the two towards
/// +-(step_x + step_y), minus that of the two towards +-(step_x - step_y), a quarter of these steps
/// away. 0 unless each of one shade is brighter than each of the other, or beyond the image.
///
/// @param step_x_px, step_y_px  from the corner to the next one of its row and of its column.
double QuarterContrast(const cv::Mat& grey,
                       const cv::Point2f& corner_px,
                       const cv::Point2f& step_x_px,
                       const cv::Point2f& step_y_px);

/// Where a grid's missing corners must be, as far as their neighbours say.
std::vector<cv::Point2f> PlacesOfMissing(const CornerGrid& grid);

/// Fills the gaps of a grid in which few corners are missing with what lies where they must be: an
/// edge of a shadow or a scratch may hide the X of a corner, but its four squares still differ.
/// @return the grid with the corners that were confirmed.
CornerGrid WithMissingCorners(const cv::Mat& grey, const CornerGrid& grid);

}  // namespace voqcal
