#pragma once

#include <optional>
#include <string>

namespace voqcal {

/// What YAML's parser does not say of a text that it refuses.
struct YamlHint {
  int line = 0;
  std::string text;  ///< "is indented by a tab: ..."
};

/// The first line that is indented by a tab, or whose colon lacks a space.
std::optional<YamlHint> FindYamlHint(const std::string& text);

}  // namespace voqcal
