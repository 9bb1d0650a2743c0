#include "files/yaml_reader.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "core/units.hpp"
#include "files/nearest_word.hpp"
#include "files/number_text.hpp"
#include "files/yaml_hint.hpp"

namespace voqcal {
namespace {

int LineOfNode(const YAML::Node& node) { return node.Mark().line + 1; }

/// What a value is, as an error shows it.
std::string Shown(const YAML::Node& node) {
  constexpr std::size_t kMaxShown = 60;
  if (node.IsMap()) return "a section";
  if (node.IsSequence()) return "a list of " + std::to_string(node.size());
  if (!node.IsScalar()) return "empty";
  const std::string& text = node.Scalar();
  return '"' + (text.size() <= kMaxShown ? text : text.substr(0, kMaxShown) + "...") + '"';
}

/// A plain scalar that is a number from its first to its last character. Text in quotes is text.
template <typename Number>
bool Parse(const YAML::Node& node, Number* number) {
  if (!node.IsScalar() || node.Tag() == "!") return false;
  return ParseNumber(node.Scalar(), number);
}

bool Parse(const YAML::Node& node, bool* value) {
  if (!node.IsScalar() || node.Tag() == "!") return false;
  *value = node.Scalar() == "true";
  return *value || node.Scalar() == "false";
}

bool Parse(const YAML::Node& node, std::string* value) {
  if (!node.IsScalar()) return false;
  *value = node.Scalar();
  return true;
}

bool ParseFinite(const YAML::Node& node, double* value) {
  return Parse(node, value) && std::isfinite(*value);
}

std::optional<std::vector<double>> ParseList(const YAML::Node& node) {
  if (!node.IsSequence()) return std::nullopt;
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    double value = 0;
    if (!ParseFinite(item, &value)) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

/// "x_rad must ..., is 0.1" as a file with degrees says it: "x_deg must ..., is 5.72958".
std::string InDegrees(std::string problem) {
  const std::string is = ", is ";
  const std::size_t name_end = problem.find(' ');
  const std::size_t unit = problem.rfind("_rad", name_end);
  const std::size_t value = problem.rfind(is);
  if (unit == std::string::npos || unit + 4 != name_end || value == std::string::npos) {
    return problem;
  }
  std::ostringstream text;
  text << problem.substr(0, unit) << "_deg" << problem.substr(name_end, value - name_end) << is
       << std::stod(problem.substr(value + is.size())) / kRadPerDeg;
  return text.str();
}

class IgnoreEvents : public YAML::EventHandler {
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;
  void OnDocumentStart(const Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, Anchor) override {}
  void OnAlias(const Mark&, Anchor) override {}
  void OnScalar(const Mark&, const std::string&, Anchor, const std::string&) override {}
  void OnSequenceStart(const Mark&, const std::string&, Anchor, Style) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark&, const std::string&, Anchor, Style) override {}
  void OnMapEnd() override {}
};

/// Whether anything follows the first document. (YAML::LoadAll finds documents without end, and
/// keeps them, where a broken one leaves something behind.)
bool HasMoreThanOneDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  IgnoreEvents ignore;
  return parser.HandleNextDocument(ignore) && parser.HandleNextDocument(ignore);
}

/// yaml-cpp's words, and what people who read them had done.
std::string SyntaxText(const std::string& message) {
  const bool is_layout = message == "end of map not found" || message == "illegal map value";
  return "is not YAML: " + message +
         (is_layout
              ? " (is a colon missing here or above, or is it indented unlike its neighbours?)"
              : "");
}

YAML::Node ParseDocument(const std::string& name, const std::string& text) {
  if (text.find('\0') != std::string::npos) {
    throw std::runtime_error(name + ": is not a text file (wanted: YAML)");
  }
  try {
    const YAML::Node document = YAML::Load(text);
    if (document.IsMap() && !HasMoreThanOneDocument(text)) return document;
  } catch (const YAML::Exception& error) {
    const YamlHint hint =
        FindYamlHint(text).value_or(YamlHint{error.mark.line + 1, SyntaxText(error.msg)});
    throw std::runtime_error(name + ":" + std::to_string(hint.line) + ": " + hint.text);
  }
  throw std::runtime_error(name + ":1: must be one mapping of keys to values" +
                           (text.empty() ? ", is empty" : ""));
}

}  // namespace

YamlDocument::YamlDocument(std::string name, const std::string& text)
    : name_(std::move(name)), root_(ParseDocument(name_, text)) {}

void YamlDocument::AddError(int line, const std::string& text) {
  errors_.emplace(line, name_ + ":" + std::to_string(line) + ": " + text);
}

std::vector<std::string> YamlDocument::Remarks() const {
  std::vector<std::string> lines;
  for (const auto& [line, text] : remarks_) lines.push_back(text);
  return lines;
}

void YamlDocument::ThrowIfWrong() const {
  std::string lines;
  for (const auto& [line, text] : errors_) lines += (lines.empty() ? "" : "\n") + text;
  if (!lines.empty()) throw std::runtime_error(lines);
}

YamlSection::YamlSection(YamlDocument* document) : YamlSection(document, document->root_, "", 1) {}

YamlSection::YamlSection(YamlDocument* document, YAML::Node node, std::string path, int line)
    : document_(document), path_(std::move(path)), line_(line) {
  for (const auto& item : node) {
    const int key_line = LineOfNode(item.first);
    if (!item.first.IsScalar()) {
      document_->AddError(key_line, "a key must be a word, is " + Shown(item.first));
      continue;
    }
    const auto [entry, is_new] =
        entries_.try_emplace(item.first.Scalar(), Entry{item.second, key_line, false});
    if (is_new) keys_.push_back(entry->first);
    if (!is_new) {
      document_->AddError(key_line,
                          PathOf(entry->first) + " is given twice, first on line " +
                              std::to_string(entry->second.line));
    }
  }
}

YamlSection YamlSection::Section(const std::string& key) {
  known_.insert(key);
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) return {document_, YAML::Node(), PathOf(key), line_};
  entry->second.is_read = true;
  YAML::Node node = entry->second.value;
  // "key:" with nothing below it is a section whose every option was commented out.
  if (!node.IsMap() && !node.IsNull()) {
    AddError(key, "must be a section");
    node = YAML::Node();
  }
  return {document_, node, PathOf(key), entry->second.line};
}

void YamlSection::Require(const std::string& key, const std::string& remedy) {
  if (!Has(key)) document_->AddError(line_, PathOf(key) + " is missing" + remedy);
}

YamlSection YamlSection::RequiredSection(const std::string& key, const std::string& remedy) {
  Require(key, remedy);
  return Section(key);
}

const YAML::Node* YamlSection::Find(const std::string& key) {
  known_.insert(key);
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) {
    if (is_required_) document_->AddError(line_, PathOf(key) + " is missing" + remedy_);
    is_complete_ = is_complete_ && !is_required_;
    return nullptr;
  }
  entry->second.is_read = true;
  return &entry->second.value;
}

template <typename Value>
void YamlSection::ReadScalar(const std::string& key, const char* rule, Value* value) {
  const YAML::Node* node = Find(key);
  if (node == nullptr) return;
  Value parsed{};
  if (!Parse(*node, &parsed)) return AddError(key, rule);
  *value = parsed;
}

void YamlSection::Read(const std::string& key, double* value) {
  double parsed = *value;
  ReadScalar(key, "must be a number", &parsed);
  if (!std::isfinite(parsed)) return AddError(key, "must be finite");
  *value = parsed;
}

void YamlSection::ReadDegrees(const std::string& key, double* value_rad) {
  const double default_deg = *value_rad / kRadPerDeg;
  double value_deg = default_deg;
  Read(key, &value_deg);
  // The default itself is not sent through degrees and back: it stays exact.
  if (value_deg != default_deg) *value_rad = value_deg * kRadPerDeg;
}

void YamlSection::Read(const std::string& key, int* value) {
  ReadScalar(key, "must be a whole number", value);
}

void YamlSection::Read(const std::string& key, std::uint32_t* value) {
  ReadScalar(key, "must be a whole number from 0 to 4294967295", value);
}

void YamlSection::Read(const std::string& key, bool* value) {
  ReadScalar(key, "must be true or false", value);
}

void YamlSection::Read(const std::string& key, std::string* value) {
  ReadScalar(key, "must be text", value);
}

void YamlSection::Read(const std::string& key, std::vector<double>* values) {
  const YAML::Node* node = Find(key);
  if (node == nullptr) return;
  if (auto parsed = ParseList(*node)) {
    *values = std::move(*parsed);
  } else {
    AddError(key, "must be a list of finite numbers");
  }
}

void YamlSection::Read(const std::string& key, Eigen::Vector3d* value) {
  const YAML::Node* node = Find(key);
  if (node == nullptr) return;
  const auto parsed = ParseList(*node);
  if (!parsed || parsed->size() != 3) return AddError(key, "must be a list of 3 finite numbers");
  *value = Eigen::Map<const Eigen::Vector3d>(parsed->data());
}

void YamlSection::Read(const std::string& key, std::vector<std::vector<double>>* rows) {
  const YAML::Node* node = Find(key);
  if (node == nullptr) return;
  std::vector<std::vector<double>> parsed;
  if (node->IsSequence()) {
    for (const YAML::Node& row : *node) {
      if (auto values = ParseList(row)) parsed.push_back(std::move(*values));
    }
  }
  if (!node->IsSequence() || parsed.size() != node->size()) {
    return AddError(key, "must be a list of rows of finite numbers");
  }
  *rows = std::move(parsed);
}

void YamlSection::AddError(const std::string& key, const std::string& rule) {
  is_complete_ = false;
  const auto entry = entries_.find(key);
  const std::string shown = entry == entries_.end() ? "not given" : Shown(entry->second.value);
  document_->AddError(LineOf(key), PathOf(key) + " " + rule + ", is " + shown);
}

void YamlSection::AddProblems(const std::vector<std::string>& problems) {
  for (const std::string& in_radians : problems) {
    const std::string problem = InDegrees(in_radians);
    const std::string key = problem.substr(0, problem.find(' '));
    document_->AddError(LineOf(key), (path_.empty() ? "" : path_ + ": ") + problem);
  }
}

void YamlSection::PassOver(const std::string& key, const std::string& instead) {
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) return;
  entry->second.is_read = true;
  AddRemark(key, "is no longer used, see " + PathOf(instead));
}

void YamlSection::AddRemark(const std::string& key, const std::string& text) {
  const int line = LineOf(key);
  document_->remarks_.emplace(
      line, document_->name_ + ":" + std::to_string(line) + ": " + PathOf(key) + " " + text);
}

void YamlSection::RefuseUnknownKeys() {
  for (const auto& [key, entry] : entries_) {
    if (entry.is_read) continue;
    const std::string meant = NearestWord(key, known_);
    document_->AddError(entry.line,
                        PathOf(key) + " is not a known key" +
                            (meant.empty() ? "" : ": did you mean " + meant + "?"));
  }
}

std::string YamlSection::PathOf(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

int YamlSection::LineOf(const std::string& key) const {
  const auto entry = entries_.find(key);
  return entry == entries_.end() ? line_ : entry->second.line;
}

}  // namespace voqcal
