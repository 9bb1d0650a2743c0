#pragma once

#include <string>

#include "core/assessment/scores.hpp"
#include "result/result_file.hpp"

namespace voqcal {

/// A result as a few lines for a terminal, its verdict first.
std::string Summary(const CalibrationResult& result);

/// "centre 3.41 +- 1.60 mm (largest 7.02), 2.1 +- 0.9 px; corners ...; normals ...".
std::string Summary(const SceneScore& score);

}  // namespace voqcal
