#include "core/camera_detection/aprilgrid_target.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/camera_detection/april_tags.hpp"
#include "core/camera_detection/marker_corners.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

int NumTagsX(const BoardSpec& board) { return board.num_corners_x / 2; }
int NumTagsY(const BoardSpec& board) { return board.num_corners_y / 2; }

std::vector<std::string> Problems(const BoardSpec& board) {
  ProblemList problems;
  problems.RequirePositive("tagSize", board.square_m);
  problems.Require(NumTagsX(board) >= 2, "tagCols must be at least 2", NumTagsX(board));
  problems.Require(NumTagsY(board) >= 2, "tagRows must be at least 2", NumTagsY(board));
  problems.Require(board.gap_squares > 0.0 && board.gap_squares <= 1.0,
                   "tagSpacing must be above 0 and at most 1",
                   board.gap_squares);
  if (!problems.empty()) return problems.lines();
  const int num_tags = NumTagsX(board) * NumTagsY(board);
  problems.Require(num_tags <= NumAprilTags(),
                   "the family 36h11 must have a tag for each place: tagCols * tagRows",
                   num_tags);
  return problems.empty() ? board.Problems() : problems.lines();
}

bool HasHalfTurn(const BoardSpec&) { return false; }

// A tag's border, or the small square beside a gap.
double Rim(const BoardSpec& board) {
  return std::min(static_cast<double>(kTagBorderCells) / kTagCellsAcross, board.gap_squares);
}

double Reach(const BoardSpec& board) { return 0.8 * Rim(board); }

Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> FindCorners(const cv::Mat& grey,
                                                                    const BoardSpec& board) {
  const AprilTags tags = FindAprilTags(grey, NumTagsX(board) * NumTagsY(board), board.gap_squares);
  if (tags.by_id.empty()) {
    return CameraBoardMiss{CameraBoardFault::kNoBoard,
                           "none of " + std::to_string(tags.num_rejected) +
                               " dark squares is a tag of Kalibr's family 36h11 on this board"};
  }
  std::vector<Eigen::Vector2d> corners_px(
      static_cast<std::size_t>(board.num_corners_x) * board.num_corners_y,
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (const auto& [id, tag_px] : tags.by_id) {
    const int column = 2 * (id % NumTagsX(board));
    const int row = 2 * (id / NumTagsX(board));
    for (int n = 0; n < 4; ++n) {
      const auto corner = RefinedCorner(grey,
                                        tag_px[n],
                                        tag_px[(n + 1) % 4] - tag_px[n],
                                        tag_px[(n + 3) % 4] - tag_px[n],
                                        Rim(board));
      if (!corner) continue;
      const int i = column + (n == 1 || n == 2 ? 1 : 0);
      const int j = row + (n >= 2 ? 1 : 0);
      corners_px[j * board.num_corners_x + i] = *corner;
    }
  }
  return EnoughCorners(corners_px, tags.by_id.size(), board);
}

// The first gap, then for each tag the lines of its cells up to the gap beyond it.
std::vector<double> LinesM(double offset_m, int num_tags, const BoardSpec& board) {
  const double gap_m = board.gap_squares * board.square_m;
  const double begin_m = offset_m - board.SquaresTo(2 * num_tags - 1) * board.square_m / 2;
  std::vector<double> lines_m{begin_m - gap_m};
  for (int tag = 0; tag < num_tags; ++tag) {
    for (int cell = 0; cell <= kTagCellsAcross; ++cell) {
      lines_m.push_back(begin_m + tag * (board.square_m + gap_m) +
                        cell * board.square_m / kTagCellsAcross);
    }
  }
  lines_m.push_back(lines_m.back() + gap_m);
  return lines_m;
}

PrintedPattern Print(const BoardSpec& board) {
  std::vector<TagCode> codes;
  for (int id = 0; id < NumTagsX(board) * NumTagsY(board); ++id) {
    codes.push_back(CodeOfAprilTag(id));
  }
  constexpr int kPeriod = kTagCellsAcross + 1;  // of cells; the first is the gap before a tag
  const auto is_dark = [&](int i, int j) {
    const bool is_gap_x = i % kPeriod == 0;
    const bool is_gap_y = j % kPeriod == 0;
    if (is_gap_x || is_gap_y) return is_gap_x && is_gap_y;
    const TagCode& code = codes[(j / kPeriod) * NumTagsX(board) + i / kPeriod];
    const int column = i % kPeriod - 1 - kTagBorderCells;
    const int row = kTagBitsAcross - j % kPeriod + kTagBorderCells;  // from the top
    const bool is_border = std::min(column, row) < 0 || std::max(column, row) >= kTagBitsAcross;
    return is_border || !code[row * kTagBitsAcross + column];
  };
  return MakePrintedPattern(LinesM(board.pattern_offset_x_m, NumTagsX(board), board),
                            LinesM(board.pattern_offset_y_m, NumTagsY(board), board),
                            is_dark);
}

}  // namespace

const CalibrationTarget& AprilGrid() {
  static const CalibrationTarget kAprilGrid{
      "aprilgrid",
      {{"tagCols", &BoardSpec::num_corners_x, "tags along the width", true, 2},
       {"tagRows", &BoardSpec::num_corners_y, "tags along the height", true, 2},
       {"tagSize", &BoardSpec::square_m, "side of a tag, metres"},
       {"tagSpacing", &BoardSpec::gap_squares, "gap between tags, of a tag's side"}},
      Problems,
      HasHalfTurn,
      Reach,
      FindCorners,
      Print};
  return kAprilGrid;
}

}  // namespace voqcal
