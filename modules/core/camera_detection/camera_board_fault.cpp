#include "core/camera_detection/camera_board_fault.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <opencv2/core.hpp>

#include "core/camera_detection/missing_corners.hpp"

namespace voqcal {
namespace {

// Where the lines next to a part's four sides would lie, and the missing corners within.
struct Neighbourhood {
  std::array<std::vector<cv::Point2f>, 4> sides;  // left, right, top, bottom
  std::vector<cv::Point2f> holes;
  float step_px = HUGE_VALF;  // the shortest between two corners
};

bool IsPoint(const cv::Point2f& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Neighbourhood Around(const CornerGrid& part) {
  Neighbourhood around;
  const int width = part.size.width;
  const int height = part.size.height;
  const auto at = [&](int i, int j) { return part.corners[j * width + i]; };
  const auto continue_line = [&](int side, const cv::Point2f& last, const cv::Point2f& before) {
    if (!IsPoint(last) || !IsPoint(before)) return;
    const cv::Point2f step = last - before;
    around.sides[side].push_back(last + step);
    around.step_px = std::min(around.step_px, std::hypot(step.x, step.y));
  };
  for (int j = 0; j < height && width >= 2; ++j) {
    continue_line(0, at(0, j), at(1, j));
    continue_line(1, at(width - 1, j), at(width - 2, j));
  }
  for (int i = 0; i < width && height >= 2; ++i) {
    continue_line(2, at(i, 0), at(i, 1));
    continue_line(3, at(i, height - 1), at(i, height - 2));
  }
  around.holes = PlacesOfMissing(part);
  return around;
}

// Whether the pattern, upright or lying, has more lines towards a side than the part.
bool MayLackLines(const cv::Size& part, int side, const BoardSpec& board) {
  const int num_x = board.num_corners_x;
  const int num_y = board.num_corners_y;
  const int num_lines = side < 2 ? part.width : part.height;
  const bool may_lie = part.width <= num_y && part.height <= num_x;
  return num_lines < (side < 2 ? num_x : num_y) ||
         (may_lie && num_lines < (side < 2 ? num_y : num_x));
}

// A side is beyond the border if most of the corners to be expected there are.
bool IsBeyondBorder(const std::vector<cv::Point2f>& line, const cv::Size& size) {
  constexpr float kRimPx = 5;  // corners nearer to the border are not searched for
  const auto num_outside = std::count_if(line.begin(), line.end(), [&](const cv::Point2f& p) {
    return p.x < kRimPx || p.y < kRimPx || p.x > static_cast<float>(size.width) - 1 - kRimPx ||
           p.y > static_cast<float>(size.height) - 1 - kRimPx;
  });
  return 2 * static_cast<std::size_t>(num_outside) > line.size();
}

// Share of white pixels where corners are missing, within half a square of them.
double WhiteShare(const cv::Mat& grey, const Neighbourhood& around) {
  constexpr int kWhite = 250;
  const int half_px = std::max(1, static_cast<int>(around.step_px / 2));
  double largest = 0;
  const auto consider = [&](const std::vector<cv::Point2f>& points) {
    int num_white = 0;
    int num_all = 0;
    for (const cv::Point2f& p : points) {
      const cv::Rect window =
          cv::Rect(
              cvRound(p.x) - half_px, cvRound(p.y) - half_px, 2 * half_px + 1, 2 * half_px + 1) &
          cv::Rect({0, 0}, grey.size());
      if (window.empty()) continue;
      num_white += cv::countNonZero(grey(window) >= kWhite);
      num_all += window.area();
    }
    if (num_all > 0) largest = std::max(largest, static_cast<double>(num_white) / num_all);
  };
  consider(around.holes);
  for (const auto& side : around.sides) consider(side);
  return largest;
}

}  // namespace

std::string ToString(CameraBoardFault fault) {
  switch (fault) {
    case CameraBoardFault::kNoBoard:
      return "no board";
    case CameraBoardFault::kPartlyHidden:
      return "partly hidden";
    case CameraBoardFault::kNoPose:
      return "no pose";
    case CameraBoardFault::kPoorFit:
      return "poor fit";
    case CameraBoardFault::kBlurred:
      return "blurred";
    case CameraBoardFault::kGlare:
      return "glare";
    case CameraBoardFault::kCutOff:
      return "cut off";
    case CameraBoardFault::kTooSmall:
      return "too small";
    case CameraBoardFault::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

CameraBoardMiss ExplainPart(const cv::Mat& grey, const BoardSpec& board, const CornerGrid& part) {
  constexpr double kMinShare = 0.25;      // of the corners; fewer may be anything
  constexpr double kMinWhiteShare = 0.6;  // of a chessboard alone, half, and only if overexposed
  const int num_corners = board.num_corners_x * board.num_corners_y;
  std::ostringstream seen;
  seen << part.num_found << " of " << num_corners << " corners";
  if (part.num_found < kMinShare * num_corners) {
    return {CameraBoardFault::kNoBoard, "at most " + seen.str() + " in a grid"};
  }
  const Neighbourhood around = Around(part);
  for (int side = 0; side < 4; ++side) {
    if (MayLackLines(part.size, side, board) && IsBeyondBorder(around.sides[side], grey.size())) {
      return {CameraBoardFault::kCutOff, seen.str() + ", the next ones beyond the image's border"};
    }
  }
  const double white_share = WhiteShare(grey, around);
  if (white_share >= kMinWhiteShare) {
    seen << ", the next ones in an area " << std::lround(100 * white_share) << " % white";
    return {CameraBoardFault::kGlare, seen.str()};
  }
  return {CameraBoardFault::kPartlyHidden, seen.str()};
}

std::string Measured(const char* what, double value, const char* unit_and_rule, double limit) {
  std::ostringstream text;
  text.precision(3);
  text << what << ' ' << value << unit_and_rule << ' ' << limit;
  return text.str();
}

}  // namespace voqcal
