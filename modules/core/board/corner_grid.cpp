#include "core/board/corner_grid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace voqcal {
namespace {

constexpr int kNone = -1;

// The four ways to leave a corner: along axes[0], axes[1], and against them.
constexpr int kNumWays = 4;
cv::Point2f Direction(const XCorner& corner, int way) {
  const cv::Point2f& axis = corner.axes[way % 2];
  return way < 2 ? axis : -axis;
}

// Neighbours swap dark and bright, so the edge that joins them is axes[0] of one and axes[1] of the
// other.
bool MayJoin(const XCorner& from, const XCorner& to, int way, const cv::Point2f& step) {
  constexpr float kMaxTangent = 0.36F;    // 20 degrees: twice what a ring of 16 pixels may be off
  constexpr float kMaxSine = 0.5F;        // 30 degrees between edges across: perspective turns them
  constexpr float kMaxContrastRatio = 3;  // light changes slowly over a board
  const cv::Point2f& other = to.axes[1 - way % 2];
  return std::abs(step.cross(other)) < kMaxTangent * std::abs(step.dot(other)) &&
         std::abs(from.axes[1 - way % 2].cross(to.axes[way % 2])) < kMaxSine &&
         to.contrast < kMaxContrastRatio * from.contrast &&
         from.contrast < kMaxContrastRatio * to.contrast;
}

using Links = std::vector<std::array<int, kNumWays>>;  // the nearest corner each way, or kNone

Links NearestCorners(const std::vector<XCorner>& corners) {
  constexpr float kMaxTangent = 0.36F;
  constexpr float kMinStepPx = 3.0F;
  const int num = static_cast<int>(corners.size());
  Links links(corners.size());
  for (int p = 0; p < num; ++p) {
    std::array<float, kNumWays> nearest;
    nearest.fill(HUGE_VALF);
    links[p].fill(kNone);
    for (int q = 0; q < num; ++q) {
      const cv::Point2f step = corners[q].position_px - corners[p].position_px;
      const float distance2 = step.dot(step);
      if (distance2 < kMinStepPx * kMinStepPx) continue;
      const std::array<float, 2> along{step.dot(corners[p].axes[0]), step.dot(corners[p].axes[1])};
      for (int axis = 0; axis < 2; ++axis) {
        const int way = along[axis] > 0 ? axis : axis + 2;
        if (distance2 >= nearest[way]) continue;
        if (std::abs(step.cross(corners[p].axes[axis])) >= kMaxTangent * std::abs(along[axis])) {
          continue;
        }
        if (!MayJoin(corners[p], corners[q], way, step)) continue;
        nearest[way] = distance2;
        links[p][way] = q;
      }
    }
  }
  return links;
}

// Drops links that are much longer than the link the other way: from a board's rim, such a link
// leads to some corner of the room.
Links WithoutLeaps(const std::vector<XCorner>& corners, const Links& links) {
  constexpr float kMaxStepRatio = 1.6F;  // of neighbouring squares, however tilted the board
  const auto length_px = [&](std::size_t p, int q) {
    const cv::Point2f step = corners[p].position_px - corners[q].position_px;
    return std::hypot(step.x, step.y);
  };
  Links kept = links;
  for (std::size_t p = 0; p < links.size(); ++p) {
    for (int way = 0; way < kNumWays; ++way) {
      const int q = links[p][way];
      const int other = links[p][(way + 2) % kNumWays];
      if (q == kNone || other == kNone) continue;
      if (length_px(p, q) > kMaxStepRatio * length_px(p, other)) kept[p][way] = kNone;
    }
  }
  return kept;
}

// Keeps the links that lead back.
Links Mutual(const Links& links) {
  Links mutual = links;
  for (std::size_t p = 0; p < links.size(); ++p) {
    for (int& q : mutual[p]) {
      if (q == kNone) continue;
      const auto& back = links[q];
      if (std::find(back.begin(), back.end(), static_cast<int>(p)) == back.end()) q = kNone;
    }
  }
  return mutual;
}

// Which corner lies where in a grid; column and row count from any corner.
struct Cell {
  int column;
  int row;
  bool operator<(const Cell& other) const {
    return std::pair(row, column) < std::pair(other.row, other.column);
  }
};
using Cells = std::map<Cell, int>;

std::array<Cell, 4> NeighboursOf(const Cell& cell) {
  return {Cell{cell.column + 1, cell.row},
          Cell{cell.column, cell.row + 1},
          Cell{cell.column - 1, cell.row},
          Cell{cell.column, cell.row - 1}};
}

// A corner in a grid and the ways to its next column and next row.
struct Placed {
  int corner;
  Cell cell;
  int way_to_column;
  int way_to_row;
};

// The way nearest to a direction.
int WayAlong(const XCorner& corner, const cv::Point2f& direction) {
  const float along_0 = direction.dot(corner.axes[0]);
  const float along_1 = direction.dot(corner.axes[1]);
  const bool is_first = std::abs(along_0) > std::abs(along_1);
  return (is_first ? 0 : 1) + ((is_first ? along_0 : along_1) > 0 ? 0 : 2);
}

int WayTowards(const XCorner& corner, int axis, const cv::Point2f& direction) {
  return corner.axes[axis].dot(direction) > 0 ? axis : axis + 2;
}

// All corners that links join to `first`. A corner or cell that is reached twice keeps what it got
// first.
Cells JoinedTo(int first,
               const std::vector<XCorner>& corners,
               const Links& links,
               std::vector<bool>* is_used) {
  Cells cells;
  std::vector<Placed> queue{{first, {0, 0}, 0, 1}};
  (*is_used)[first] = true;
  cells[{0, 0}] = first;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const Placed p = queue[next];
    const XCorner& corner = corners[p.corner];
    for (int way = 0; way < kNumWays; ++way) {
      const int q = links[p.corner][way];
      if (q == kNone || (*is_used)[q]) continue;
      Cell cell = p.cell;
      if (way % 2 == p.way_to_column % 2) {
        cell.column += way == p.way_to_column ? 1 : -1;
      } else {
        cell.row += way == p.way_to_row ? 1 : -1;
      }
      if (!cells.emplace(cell, q).second) continue;
      (*is_used)[q] = true;
      // Across a link the axes change places.
      queue.push_back(
          {q,
           cell,
           WayTowards(corners[q], 1 - p.way_to_column % 2, Direction(corner, p.way_to_column)),
           WayTowards(corners[q], 1 - p.way_to_row % 2, Direction(corner, p.way_to_row))});
    }
  }
  return cells;
}

struct Extent {
  Cell first{0, 0};
  Cell last{0, 0};
  int Columns() const { return last.column - first.column + 1; }
  int Rows() const { return last.row - first.row + 1; }
};

Extent ExtentOf(const Cells& cells) {
  Extent extent{cells.begin()->first, cells.begin()->first};
  for (const auto& [cell, corner] : cells) {
    extent.first.column = std::min(extent.first.column, cell.column);
    extent.first.row = std::min(extent.first.row, cell.row);
    extent.last.column = std::max(extent.last.column, cell.column);
    extent.last.row = std::max(extent.last.row, cell.row);
  }
  return extent;
}

// Where a cell's corner must be by the two cells before it on a line; of up to four lines, the
// mean.
std::optional<cv::Point2f> Predicted(const Cells& cells,
                                     const std::vector<XCorner>& corners,
                                     const Cell& cell,
                                     float* step_px) {
  cv::Point2f sum(0, 0);
  int num = 0;
  *step_px = HUGE_VALF;
  for (const Cell& next : NeighboursOf(cell)) {
    const auto near = cells.find(next);
    const auto far = cells.find({2 * next.column - cell.column, 2 * next.row - cell.row});
    if (near == cells.end() || far == cells.end()) continue;
    const cv::Point2f a = corners[near->second].position_px;
    const cv::Point2f step = a - corners[far->second].position_px;
    sum += a + step;
    *step_px = std::min(*step_px, std::hypot(step.x, step.y));
    ++num;
  }
  if (num == 0) return {};
  return sum / num;
}

// The free corner nearest to where the grid puts a cell that also continues the edges of the cell's
// neighbours.
int CornerNear(const std::vector<XCorner>& corners,
               const std::vector<bool>& is_taken,
               const Cells& cells,
               const Cell& cell,
               const cv::Point2f& position_px,
               float radius_px) {
  const auto continues_edges = [&](const XCorner& corner) {
    for (const Cell& near : NeighboursOf(cell)) {
      const auto it = cells.find(near);
      if (it == cells.end()) continue;
      const cv::Point2f step = corner.position_px - corners[it->second].position_px;
      if (!MayJoin(corners[it->second], corner, WayAlong(corners[it->second], step), step)) {
        return false;
      }
    }
    return true;
  };
  int nearest = kNone;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point2f d = corners[i].position_px - position_px;
    const float distance_px = std::hypot(d.x, d.y);
    if (is_taken[i] || distance_px >= radius_px || !continues_edges(corners[i])) continue;
    radius_px = distance_px;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

// Fills holes and the next lines around with corners that lie where the grid continues, though
// their links failed, up to one line more than the pattern has: that line shows a larger board.
void Complete(const std::vector<XCorner>& corners, int max_side, Cells* cells) {
  constexpr float kMaxMissSteps = 0.25F;
  std::vector<bool> is_taken(corners.size(), false);
  for (const auto& [cell, corner] : *cells) is_taken[corner] = true;
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    const Extent extent = ExtentOf(*cells);
    if (extent.Columns() > max_side || extent.Rows() > max_side) return;
    for (int row = extent.first.row - 1; row <= extent.last.row + 1; ++row) {
      for (int column = extent.first.column - 1; column <= extent.last.column + 1; ++column) {
        if (cells->count({column, row}) > 0) continue;
        float step_px = 0;
        const auto position = Predicted(*cells, corners, {column, row}, &step_px);
        if (!position) continue;
        const int found = CornerNear(
            corners, is_taken, *cells, {column, row}, *position, kMaxMissSteps * step_px);
        if (found == kNone) continue;
        cells->emplace(Cell{column, row}, found);
        is_taken[found] = true;
        has_grown = true;
      }
    }
  }
}

// Drops outer lines that less than half of their cells support: chance corners beside the board.
void DropSparseLines(Cells* cells) {
  for (bool has_dropped = true; has_dropped;) {
    has_dropped = false;
    const Extent extent = ExtentOf(*cells);
    const auto drop_if_sparse = [&](auto is_on_line, int length) {
      const auto count = std::count_if(
          cells->begin(), cells->end(), [&](const auto& entry) { return is_on_line(entry.first); });
      if (has_dropped || 2 * count >= length) return;
      for (auto it = cells->begin(); it != cells->end();) {
        it = is_on_line(it->first) ? cells->erase(it) : std::next(it);
      }
      has_dropped = true;
    };
    for (const int column : {extent.first.column, extent.last.column}) {
      drop_if_sparse([&](const Cell& cell) { return cell.column == column; }, extent.Rows());
    }
    for (const int row : {extent.first.row, extent.last.row}) {
      drop_if_sparse([&](const Cell& cell) { return cell.row == row; }, extent.Columns());
    }
  }
}

// The cells in the pattern's order if they fill it, upright or lying.
std::vector<cv::Point2f> InOrder(const Cells& cells,
                                 const std::vector<XCorner>& corners,
                                 const cv::Size& pattern) {
  const Extent extent = ExtentOf(cells);
  if (cells.size() != static_cast<std::size_t>(pattern.area())) return {};
  const bool is_upright = extent.Columns() == pattern.width && extent.Rows() == pattern.height;
  if (!is_upright && !(extent.Columns() == pattern.height && extent.Rows() == pattern.width)) {
    return {};
  }
  std::vector<cv::Point2f> ordered;
  for (int j = 0; j < pattern.height; ++j) {
    for (int i = 0; i < pattern.width; ++i) {
      const Cell cell{extent.first.column + (is_upright ? i : j),
                      extent.first.row + (is_upright ? j : i)};
      ordered.push_back(corners[cells.at(cell)].position_px);
    }
  }
  return ordered;
}

// Steps along a row or column change slowly, by perspective and lens: in squares of 1 / 10 of the
// distance by up to 1 / 5. A chance corner in place of a missed one breaks this.
bool IsSmooth(const std::vector<cv::Point2f>& ordered, const cv::Size& pattern) {
  constexpr float kMaxChangeSteps = 0.25F;
  constexpr float kPositionErrorPx = 1.0F;  // four corners of 0.2 px make this one in a thousand
  const auto is_smooth_at = [&](int k, int stride) {
    const cv::Point2f step = ordered[k] - ordered[k - stride];
    const cv::Point2f change = ordered[k + stride] - ordered[k] - step;
    return std::hypot(change.x, change.y) <
           kMaxChangeSteps * std::hypot(step.x, step.y) + kPositionErrorPx;
  };
  for (int j = 0; j < pattern.height; ++j) {
    for (int i = 0; i < pattern.width; ++i) {
      const int k = j * pattern.width + i;
      if (i > 0 && i + 1 < pattern.width && !is_smooth_at(k, 1)) return false;
      if (j > 0 && j + 1 < pattern.height && !is_smooth_at(k, pattern.width)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<cv::Point2f> FindCornerGrid(const std::vector<XCorner>& corners,
                                        const cv::Size& pattern) {
  const Links links = Mutual(WithoutLeaps(corners, Mutual(NearestCorners(corners))));
  std::vector<bool> is_used(corners.size(), false);
  for (std::size_t first = 0; first < corners.size(); ++first) {
    if (is_used[first]) continue;
    Cells cells = JoinedTo(static_cast<int>(first), corners, links, &is_used);
    constexpr std::size_t kMinSeed = 4;  // smaller pieces may be chance
    if (cells.size() < kMinSeed) continue;
    Complete(corners, std::max(pattern.width, pattern.height), &cells);
    DropSparseLines(&cells);
    std::vector<cv::Point2f> ordered = InOrder(cells, corners, pattern);
    if (!ordered.empty() && IsSmooth(ordered, pattern)) return ordered;
  }
  return {};
}

}  // namespace voqcal
