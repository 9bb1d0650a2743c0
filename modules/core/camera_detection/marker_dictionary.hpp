#pragma once

#include <string>
#include <vector>

namespace voqcal {

/// One of ArUco's predefined dictionaries.
struct MarkerDictionary {
  const char* name;  ///< "4x4_50", ... "apriltag_36h11".
  int num_markers;
  int num_cells;  ///< Along a marker's side, its border excluded.
};

/// In OpenCV's order: the place in the list is OpenCV's number of it.
const std::vector<MarkerDictionary>& MarkerDictionaries();

/// OpenCV's number; -1 for an unknown name.
int NumberOfDictionary(const std::string& name);

}  // namespace voqcal
