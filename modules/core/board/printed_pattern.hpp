#pragma once

#include <vector>

namespace voqcal {

/// What is printed on a board, in rectangular cells of one shade each: cell (i, j) lies between the
/// lines i and i + 1 of x and j and j + 1 of y. All around is the board's white margin.
struct PrintedPattern {
  std::vector<double> x_lines_m;  ///< In the board frame, ascending.
  std::vector<double> y_lines_m;
  std::vector<bool> is_dark;  ///< Of cells, x fastest.

  int NumCellsX() const { return static_cast<int>(x_lines_m.size()) - 1; }
  int NumCellsY() const { return static_cast<int>(y_lines_m.size()) - 1; }
};

/// @param is_dark  called with i and j of each cell.
template <typename IsDark>
PrintedPattern MakePrintedPattern(const std::vector<double>& x_lines_m,
                                  const std::vector<double>& y_lines_m,
                                  const IsDark& is_dark) {
  PrintedPattern printed{x_lines_m, y_lines_m, {}};
  for (int j = 0; j < printed.NumCellsY(); ++j) {
    for (int i = 0; i < printed.NumCellsX(); ++i) printed.is_dark.push_back(is_dark(i, j));
  }
  return printed;
}

}  // namespace voqcal
