#include "files/option_section.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/format.hpp"
#include "core/units.hpp"
#include "files/number_text.hpp"
#include "files/transform_yaml.hpp"

namespace voqcal {
namespace {

/// Words that mean themselves without quotes.
bool IsPlain(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.';
  });
}

/// "a, b or c".
std::string Listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  }
  return text;
}

}  // namespace

/// People read 0.0005 more easily than 5e-04.
std::string YamlText(double value) {
  if (std::abs(value) < 1e-6 || std::abs(value) >= 1) return NumberText(value);
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}
std::string YamlText(int value) { return std::to_string(value); }
std::string YamlText(std::uint32_t value) { return std::to_string(value); }
std::string YamlText(bool value) { return value ? "true" : "false"; }
std::string YamlText(const std::vector<double>& values) { return ListYaml(values); }

std::string YamlText(const std::string& value) {
  if (IsPlain(value)) return value;
  std::ostringstream text;
  text << std::quoted(value);
  return text.str();
}

OptionSection OptionSection::Section(const std::string& key, const std::string& meaning) {
  Describe(key, "", meaning);
  return OptionSection(YamlSection::Section(key));
}

OptionSection OptionSection::RequiredSection(const std::string& key,
                                             const std::string& meaning,
                                             const std::string& remedy) {
  Describe(key, "", meaning);
  MarkAsNeeded();
  return OptionSection(YamlSection::RequiredSection(key, remedy));
}

void OptionSection::ReadDegrees(const std::string& key,
                                double* value_rad,
                                const std::string& meaning) {
  YamlSection::ReadDegrees(key, value_rad);
  const double value_deg = *value_rad / kRadPerDeg;
  double shown_deg = 0;
  ParseNumber(Format("%.4g", value_deg), &shown_deg);
  const bool is_rounded = shown_deg != value_deg && shown_deg * kRadPerDeg != *value_rad;
  Describe(key, YamlText(shown_deg), meaning, is_rounded);
}

std::optional<Eigen::Isometry3d> OptionSection::ReadTransform(const std::string& key,
                                                              const std::string& meaning) {
  YamlSection section = YamlSection::Section(key);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  voqcal::ReadTransform(&section, &T);
  section.RefuseUnknownKeys();
  Describe(key,
           "{quaternion_xyzw: " + ListYaml(Eigen::Quaterniond(T.linear()).coeffs()) +
               ", translation_m: " + ListYaml(Eigen::Vector3d(T.translation())) + "}",
           meaning,
           !Has(key));
  return Has(key) ? std::optional(T) : std::nullopt;
}

void OptionSection::ReadWord(const std::string& key,
                             const std::vector<std::string>& words,
                             std::string* word,
                             const std::string& meaning) {
  std::string read = *word;
  YamlSection::Read(key, &read);
  if (std::count(words.begin(), words.end(), read) != 0) {
    *word = read;
  } else {
    AddError(key, "must be " + Listed(words));
  }
  Describe(key, *word, meaning + ": " + Listed(words));
}

void OptionSection::MarkAsNeeded() { document().known_keys_.back().is_needed = true; }

void OptionSection::Describe(const std::string& key,
                             const std::string& value,
                             const std::string& meaning,
                             bool is_example) {
  document().known_keys_.push_back({PathOf(key), value, meaning, is_example});
}

}  // namespace voqcal
