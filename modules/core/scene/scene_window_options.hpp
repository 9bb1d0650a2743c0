#pragma once

#include <string>
#include <vector>

namespace voqcal {

/// Which sweeps and images of a drive make scenes.
struct SceneWindowOptions {
  double max_apart_s = 0.06;  ///< Between a sweep and its image.
  double every_s = 0.9;       ///< At least so long between two scenes.
  double window_s = 30.0;     ///< The scenes of so long are judged together.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

}  // namespace voqcal
