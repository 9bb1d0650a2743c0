#pragma once

#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <string>

namespace voqcal {

/// What printf would print, as a string of any length.
[[gnu::format(printf, 1, 2)]] inline std::string Format(const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  std::va_list again;
  va_copy(again, values);
  const int length = std::vsnprintf(nullptr, 0, format, values);
  va_end(values);
  std::string text(length < 0 ? 0 : static_cast<std::size_t>(length), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

/// Each number of a text as N: "row 17 has 5 bytes" and "row 18 has 7 bytes" are of one kind.
inline std::string WithoutNumbers(const std::string& text) {
  std::string kind;
  for (const unsigned char c : text) {
    if (std::isdigit(c) == 0) {
      kind += static_cast<char>(c);
    } else if (kind.empty() || kind.back() != 'N') {
      kind += 'N';
    }
  }
  return kind;
}

}  // namespace voqcal
