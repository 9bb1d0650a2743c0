#include "core/camera_detection/april_tags.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/camera_detection/charuco_opencv.hpp"
#include "core/camera_detection/marker_dictionary.hpp"
#include "core/camera_detection/x_corners.hpp"

namespace voqcal {
namespace {

constexpr const char* kFamily = "apriltag_36h11";

TagCode TurnedByQuarter(const TagCode& code) {
  TagCode turned;
  for (int row = 0; row < kTagBitsAcross; ++row) {
    for (int column = 0; column < kTagBitsAcross; ++column) {
      turned[column * kTagBitsAcross + kTagBitsAcross - 1 - row] =
          code[row * kTagBitsAcross + column];
    }
  }
  return turned;
}

// The mean over points of a tag in an image, both given in cells from its first corner.
std::optional<double> MeanLevel(const cv::Mat& grey,
                                const cv::Mat& pixel_from_cell,
                                const std::vector<cv::Point2f>& at_cells) {
  std::vector<cv::Point2f> at_px;
  cv::perspectiveTransform(at_cells, at_px, pixel_from_cell);
  double sum = 0;
  for (const cv::Point2f& point_px : at_px) {
    const cv::Point nearest_px(cvRound(point_px.x), cvRound(point_px.y));
    if (!cv::Rect({0, 0}, grey.size()).contains(nearest_px)) return {};
    sum += grey.at<unsigned char>(nearest_px);
  }
  return sum / static_cast<double>(at_px.size());
}

// The middles of cells along a line beside each of a tag's four sides.
std::vector<cv::Point2f> BesideSides(float outwards_cells) {
  std::vector<cv::Point2f> points;
  for (int cell = 1; cell < kTagCellsAcross - 1; ++cell) {
    const float at = static_cast<float>(cell) + 0.5F;
    for (const float beside : {-outwards_cells, kTagCellsAcross + outwards_cells}) {
      points.emplace_back(at, beside);
      points.emplace_back(beside, at);
    }
  }
  return points;
}

// Four points of a cell.
std::vector<cv::Point2f> WithinCell(int column, int row) {
  std::vector<cv::Point2f> points;
  for (const float x : {0.35F, 0.65F}) {
    for (const float y : {0.35F, 0.65F}) {
      points.emplace_back(static_cast<float>(column) + x, static_cast<float>(row) + y);
    }
  }
  return points;
}

// The bits within a square, with its first corner as the upper left.
std::optional<TagCode> ReadCode(const cv::Mat& grey, const Square& square, double gap_tags) {
  constexpr double kMinContrast = 8;  // grey levels, as of X-corners
  const auto side = static_cast<float>(kTagCellsAcross);
  const cv::Mat pixel_from_cell = cv::getPerspectiveTransform(
      std::vector<cv::Point2f>{{0, 0}, {side, 0}, {side, side}, {0, side}},
      std::vector<cv::Point2f>(square.begin(), square.end()));
  const auto border = MeanLevel(grey, pixel_from_cell, BesideSides(-kTagBorderCells / 2.0F));
  const auto gap =
      MeanLevel(grey, pixel_from_cell, BesideSides(static_cast<float>(gap_tags) * side / 2));
  if (!border || !gap || *gap - *border < kMinContrast) return {};
  TagCode code;
  for (int row = 0; row < kTagBitsAcross; ++row) {
    for (int column = 0; column < kTagBitsAcross; ++column) {
      const auto level = MeanLevel(
          grey, pixel_from_cell, WithinCell(column + kTagBorderCells, row + kTagBorderCells));
      code[row * kTagBitsAcross + column] = level > (*border + *gap) / 2;
    }
  }
  return code;
}

// A tag's id, and which of a square's corners is its upper left.
struct Identity {
  int id;
  int upper_left;
};

// Any two codes, however turned, differ by 11 bits.
std::optional<Identity> Identify(TagCode seen, const std::vector<TagCode>& codes) {
  constexpr std::size_t kMaxWrongBits = 3;  // 5 could be mended; clutter has more chances
  for (int turn = 0; turn < 4; ++turn) {
    for (std::size_t id = 0; id < codes.size(); ++id) {
      if ((codes[id] ^ seen).count() <= kMaxWrongBits) {
        // Each turn with the clock brings the corner before to the upper left.
        return Identity{static_cast<int>(id), (4 - turn) % 4};
      }
    }
    seen = TurnedByQuarter(seen);
  }
  return {};
}

// From the lower left against the clock.
Square CornersOf(const Square& square, int upper_left) {
  Square corners;
  for (int n = 0; n < 4; ++n) corners[n] = square[(upper_left + 3 - n) % 4];
  return corners;
}

AprilTags FindOn(const cv::Mat& grey, const std::vector<TagCode>& codes, double gap_tags) {
  constexpr std::size_t kMaxCorners = 2000;  // codes have X-corners of their own
  AprilTags tags;
  for (const Square& square : DarkSquares(FindXCorners(grey, kMaxCorners))) {
    const auto code = ReadCode(grey, square, gap_tags);
    const auto identity = code ? Identify(*code, codes) : std::nullopt;
    if (identity) {
      tags.by_id.emplace(identity->id, CornersOf(square, identity->upper_left));
    } else {
      ++tags.num_rejected;
    }
  }
  return tags;
}

}  // namespace

int NumAprilTags() { return MarkerDictionaries()[NumberOfDictionary(kFamily)].num_markers; }

TagCode CodeOfAprilTag(int id) {
  const cv::Mat cells = DrawMarker(NumberOfDictionary(kFamily), id, kTagBitsAcross + 2);
  TagCode code;
  for (int row = 0; row < kTagBitsAcross; ++row) {
    for (int column = 0; column < kTagBitsAcross; ++column) {
      // OpenCV's are AprilTag's turned by half.
      code[row * kTagBitsAcross + column] =
          cells.at<unsigned char>(kTagBitsAcross - row, kTagBitsAcross - column) > 127;
    }
  }
  return code;
}

AprilTags FindAprilTags(const cv::Mat& grey, int num_tags, double gap_tags) {
  constexpr int kMinSidePx = 200;
  std::vector<TagCode> codes;
  for (int id = 0; id < num_tags; ++id) codes.push_back(CodeOfAprilTag(id));
  AprilTags tags;
  cv::Mat level = grey;
  // Blur is small in smaller images.
  for (float scale = 1;; scale *= 2) {
    const AprilTags found = FindOn(level, codes, gap_tags);
    tags.num_rejected = std::max(tags.num_rejected, found.num_rejected);
    for (auto [id, square] : found.by_id) {
      for (cv::Point2f& corner_px : square) {
        corner_px = scale * (corner_px + cv::Point2f(0.5F, 0.5F)) - cv::Point2f(0.5F, 0.5F);
      }
      tags.by_id.emplace(id, square);
    }
    const bool is_whole = tags.by_id.size() == codes.size();
    if (is_whole || std::max(level.cols, level.rows) / 2 < kMinSidePx) return tags;
    cv::resize(level, level, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  }
}

}  // namespace voqcal
