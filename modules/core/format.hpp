#pragma once

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

}  // namespace voqcal
