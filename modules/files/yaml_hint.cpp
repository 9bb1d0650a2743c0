#include "files/yaml_hint.hpp"

#include <cctype>
#include <optional>
#include <sstream>
#include <string>

namespace voqcal {
namespace {

bool IsIndentedByTab(const std::string& line) {
  const std::size_t tab = line.find('\t');
  return tab != std::string::npos && line.find_first_not_of(' ') == tab;
}

/// "width_m:0.6": a word, a colon, and more at once.
bool LacksSpace(const std::string& line) {
  std::size_t at = line.find_first_not_of(' ');
  const std::size_t begin = at;
  while (at < line.size() &&
         (std::isalnum(static_cast<unsigned char>(line[at])) || line[at] == '_')) {
    ++at;
  }
  return at != begin && at + 1 < line.size() && line[at] == ':' &&
         std::isspace(static_cast<unsigned char>(line[at + 1])) == 0;
}

}  // namespace

std::optional<YamlHint> FindYamlHint(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (IsIndentedByTab(line)) return YamlHint{number, "is indented by a tab: give spaces"};
    if (LacksSpace(line)) return YamlHint{number, "lacks a space after its colon"};
  }
  return {};
}

}  // namespace voqcal
