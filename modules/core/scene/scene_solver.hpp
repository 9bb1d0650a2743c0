#pragma once

#include <vector>

#include "core/scene/scene_problem.hpp"

namespace voqcal {

/// Moves `unknowns` to the minimum of the prior's cost and `scale` times the weighted surprises of
/// the sectors' edges, at one level.
void MinimiseAt(const SceneProblem& scene,
                const std::vector<EdgeField>& fields,
                Sectors sectors,
                double scale,
                int max_iterations,
                SceneVector* unknowns);

}  // namespace voqcal
