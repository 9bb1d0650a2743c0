#pragma once

#include <string>
#include <string_view>

namespace voqcal {

/// The shortest text that reads back as the same number, whatever the locale; ".nan", ".inf" and
/// "-.inf" as YAML writes them, and no negative zero.
std::string NumberText(double value);

/// Reads a number that fills `text` from its first to its last character, whatever the locale; also
/// YAML's ".nan" and ".inf".
/// @return false if it is none, or too large for its type; `number` is then as it was.
bool ParseNumber(std::string_view text, double* number);
bool ParseNumber(std::string_view text, int* number);
bool ParseNumber(std::string_view text, unsigned int* number);

}  // namespace voqcal
