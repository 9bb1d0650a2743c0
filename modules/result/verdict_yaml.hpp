#pragma once

#include <string>

#include "core/assessment/verdict.hpp"

namespace voqcal {

/// Section "verdict" of the result: the grade, and each check with its own grade and reason.
std::string VerdictYaml(const Verdict& verdict);

}  // namespace voqcal
