// DocumentedYaml: where comments stand, and how they are broken.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "files/option_section.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kColumn = 34;     // of comments beside their key...
constexpr std::size_t kMaxColumn = 44;  // ...which may be so long
constexpr std::size_t kMaxBeside = 2;   // lines

using Lines = std::vector<std::string>;

void AddWrapped(const std::string& paragraph, std::size_t width, Lines* lines) {
  std::istringstream words(paragraph);
  bool is_first = true;
  for (std::string word; words >> word; is_first = false) {
    if (!is_first && lines->back().size() + 1 + word.size() <= width) {
      lines->back() += ' ' + word;
    } else {
      lines->push_back(word);
    }
  }
}

/// What is indented is a drawing.
Lines Wrapped(const std::string& text, std::size_t width) {
  Lines lines;
  std::istringstream paragraphs(text);
  for (std::string paragraph; std::getline(paragraphs, paragraph);) {
    if (paragraph.rfind("  ", 0) == 0) {
      lines.push_back(paragraph);
    } else {
      AddWrapped(paragraph, width, &lines);
    }
  }
  return lines;
}

/// Short comments stand beside their key, others above it.
std::string Commented(const std::string& line,
                      const std::string& indent,
                      const std::string& meaning) {
  const std::size_t column = std::max(kColumn, line.size() + 2);
  const Lines beside = Wrapped(meaning, kWidth - column - 2);
  if (beside.empty()) return line + "\n";
  std::string text;
  if (column > kMaxColumn || beside.size() > kMaxBeside) {
    for (const std::string& each : Wrapped(meaning, kWidth - indent.size() - 2)) {
      text += indent + "# " + each + "\n";
    }
    return text + line + "\n";
  }
  for (const std::string& each : beside) {
    const std::string before = text.empty() ? line : "";
    text += before + std::string(column - before.size(), ' ') + "# " + each + "\n";
  }
  return text;
}

}  // namespace

std::string DocumentedYaml(const std::vector<YamlDocument::KnownKey>& keys) {
  std::string text;
  for (const YamlDocument::KnownKey& key : keys) {
    const auto depth = static_cast<std::size_t>(std::count(key.path.begin(), key.path.end(), '.'));
    const std::string indent(2 * depth, ' ');
    const std::string name = key.path.substr(key.path.rfind('.') + 1);  // npos + 1 is 0
    const std::string value = key.value.empty() ? "" : " " + key.value;
    const std::string meaning = (key.is_needed ? "needed: " : "") + key.meaning;
    if (depth == 0) text += "\n";
    text += Commented(indent + (key.is_example ? "# " : "") + name + ":" + value, indent, meaning);
  }
  return text;
}

}  // namespace voqcal
