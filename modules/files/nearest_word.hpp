#pragma once

#include <set>
#include <string>

namespace voqcal {

/// The one of `words` that `word` was probably meant to be: that with the fewest slips (letters
/// missing, added, changed or swapped with their neighbour); empty if even that takes more than
/// one slip and more than a third of the letters. The first of equals.
std::string NearestWord(const std::string& word, const std::set<std::string>& words);

}  // namespace voqcal
