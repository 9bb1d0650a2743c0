#pragma once

#include <bitset>
#include <map>

#include <opencv2/core/mat.hpp>

#include "core/camera_detection/dark_squares.hpp"

namespace voqcal {

constexpr int kTagBitsAcross = 6;   ///< Of the family 36h11.
constexpr int kTagBorderCells = 2;  ///< Kalibr's; AprilTag's own have 1.
constexpr int kTagCellsAcross = kTagBitsAcross + 2 * kTagBorderCells;

/// Row by row from the upper left; 1 is white.
using TagCode = std::bitset<kTagBitsAcross * kTagBitsAcross>;

/// How many tags the family has.
int NumAprilTags();

/// As AprilTag and Kalibr print it.
TagCode CodeOfAprilTag(int id);

/// Tags of Kalibr's kind in one image.
struct AprilTags {
  std::map<int, Square> by_id;  ///< From the lower left against the clock; to about 0.3 px.
  int num_rejected = 0;         ///< Dark squares that are none.
};

/// Tags 0 to `num_tags` - 1 whose corners are touched by other dark squares, as all of an AprilGrid
/// are.
///
/// @param gap_tags  how wide the white around a tag is at least, as share of its size.
AprilTags FindAprilTags(const cv::Mat& grey, int num_tags, double gap_tags);

}  // namespace voqcal
