#include "files/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace voqcal {
namespace {

template <typename Number>
bool Parse(std::string_view text, Number* number) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number parsed{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error != std::errc() || end != text.data() + text.size()) return false;
  *number = parsed;
  return true;
}

}  // namespace

std::string NumberText(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value == 0 ? 0.0 : value);
  return {text.data(), end};
}

bool ParseNumber(std::string_view text, double* number) {
  if (text == ".nan") *number = std::numeric_limits<double>::quiet_NaN();
  if (text == ".inf" || text == "+.inf") *number = std::numeric_limits<double>::infinity();
  if (text == "-.inf") *number = -std::numeric_limits<double>::infinity();
  const bool is_special = text == ".nan" || text == ".inf" || text == "+.inf" || text == "-.inf";
  return is_special || Parse(text, number);
}

bool ParseNumber(std::string_view text, int* number) { return Parse(text, number); }
bool ParseNumber(std::string_view text, unsigned int* number) { return Parse(text, number); }

}  // namespace voqcal
