#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace voqcal {

/// Each once, in the order in which they came.
inline void AddIfNew(const std::string& word, std::vector<std::string>* words) {
  if (std::find(words->begin(), words->end(), word) == words->end()) words->push_back(word);
}

}  // namespace voqcal
