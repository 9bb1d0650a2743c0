#include "core/scene/scene_window_options.hpp"

#include "core/problems.hpp"

namespace voqcal {

std::vector<std::string> SceneWindowOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("max_apart_s", max_apart_s);
  problems.RequirePositive("every_s", every_s);
  problems.RequirePositive("window_s", window_s);
  return problems.lines();
}

}  // namespace voqcal
