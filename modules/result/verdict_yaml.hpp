#pragma once

#include <string>

#include "core/assessment/verdict.hpp"
#include "result/result_file.hpp"

namespace voqcal {

Verdict VerdictOf(const CalibrationResult& result);

/// Section "verdict" of the result: the grade, and each check with its own grade and reason.
std::string VerdictYaml(const Verdict& verdict);

}  // namespace voqcal
