#include "core/camera_detection/corner_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/camera_detection/corner_links.hpp"

namespace voqcal {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const cv::Point2f kNoPoint(kNan, kNan);

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
               const CornerLinks& links,
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
      if (q == kNoCorner || (*is_used)[q]) continue;
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
  int nearest = kNoCorner;
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
        if (found == kNoCorner) continue;
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

// The cells of a grid that is no larger than the pattern, in the pattern's order, upright or lying;
// NaN where there is none.
std::optional<CornerGrid> InOrder(const Cells& cells,
                                  const std::vector<XCorner>& corners,
                                  const cv::Size& pattern) {
  const Extent extent = ExtentOf(cells);
  const bool is_upright = extent.Columns() <= pattern.width && extent.Rows() <= pattern.height;
  if (!is_upright && !(extent.Columns() <= pattern.height && extent.Rows() <= pattern.width)) {
    return {};
  }
  CornerGrid grid;
  grid.size = is_upright ? cv::Size(extent.Columns(), extent.Rows())
                         : cv::Size(extent.Rows(), extent.Columns());
  grid.corners.assign(static_cast<std::size_t>(grid.size.area()), kNoPoint);
  grid.num_found = static_cast<int>(cells.size());
  for (const auto& [cell, corner] : cells) {
    const int column = cell.column - extent.first.column;
    const int row = cell.row - extent.first.row;
    const int i = is_upright ? column : row;
    const int j = is_upright ? row : column;
    grid.corners[j * grid.size.width + i] = corners[corner].position_px;
  }
  return grid;
}

// Steps along a row or column change slowly, by perspective and lens: in squares of 1 / 10 of the
// distance by up to 1 / 5. A chance corner in place of a missed one breaks this.
bool IsSmooth(const CornerGrid& grid) {
  constexpr float kMaxChangeSteps = 0.25F;
  constexpr float kPositionErrorPx = 1.0F;  // four corners of 0.2 px make this one in a thousand
  const auto is_smooth_at = [&](int k, int stride) {
    const cv::Point2f step = grid.corners[k] - grid.corners[k - stride];
    const cv::Point2f change = grid.corners[k + stride] - grid.corners[k] - step;
    const float max_change_px = kMaxChangeSteps * std::hypot(step.x, step.y) + kPositionErrorPx;
    return !(std::hypot(change.x, change.y) >= max_change_px);  // NaN: nothing to judge
  };
  for (int j = 0; j < grid.size.height; ++j) {
    for (int i = 0; i < grid.size.width; ++i) {
      const int k = j * grid.size.width + i;
      if (i > 0 && i + 1 < grid.size.width && !is_smooth_at(k, 1)) return false;
      if (j > 0 && j + 1 < grid.size.height && !is_smooth_at(k, grid.size.width)) return false;
    }
  }
  return true;
}

}  // namespace

CornerGrid FindCornerGrid(const std::vector<XCorner>& corners, const cv::Size& pattern) {
  const CornerLinks links = LinkCorners(corners);
  std::vector<bool> is_used(corners.size(), false);
  CornerGrid largest;
  for (std::size_t first = 0; first < corners.size(); ++first) {
    if (is_used[first]) continue;
    Cells cells = JoinedTo(static_cast<int>(first), corners, links, &is_used);
    constexpr std::size_t kMinSeed = 4;  // smaller pieces may be chance
    if (cells.size() < kMinSeed) continue;
    Complete(corners, std::max(pattern.width, pattern.height), &cells);
    DropSparseLines(&cells);
    const auto grid = InOrder(cells, corners, pattern);
    if (!grid || grid->num_found <= largest.num_found || !IsSmooth(*grid)) continue;
    largest = *grid;
    if (largest.num_found == pattern.area()) break;
  }
  return largest;
}

}  // namespace voqcal
