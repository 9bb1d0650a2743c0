#include "files/nearest_word.hpp"

#include <algorithm>
#include <vector>

namespace voqcal {
namespace {

/// The optimal string alignment distance: Levenshtein's, with swapped neighbours as one slip.
std::size_t NumSlips(const std::string& from, const std::string& to) {
  // slips[i][j]: from the first i letters of `from` to the first j of `to`.
  std::vector<std::vector<std::size_t>> slips(from.size() + 1,
                                              std::vector<std::size_t>(to.size() + 1));
  for (std::size_t i = 0; i <= from.size(); ++i) {
    for (std::size_t j = 0; j <= to.size(); ++j) {
      if (i == 0 || j == 0) {
        slips[i][j] = i + j;
        continue;
      }
      const std::size_t changed = from[i - 1] == to[j - 1] ? 0 : 1;
      slips[i][j] =
          std::min({slips[i - 1][j] + 1, slips[i][j - 1] + 1, slips[i - 1][j - 1] + changed});
      const bool is_swapped =
          i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (is_swapped) slips[i][j] = std::min(slips[i][j], slips[i - 2][j - 2] + 1);
    }
  }
  return slips.back().back();
}

}  // namespace

std::string NearestWord(const std::string& word, const std::set<std::string>& words) {
  std::string nearest;
  std::size_t num_slips = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& each : words) {
    const std::size_t num_now = NumSlips(word, each);
    if (num_now >= num_slips) continue;
    num_slips = num_now;
    nearest = each;
  }
  return nearest;
}

}  // namespace voqcal
