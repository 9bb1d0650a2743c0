#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "files/yaml_reader.hpp"

namespace voqcal {

/// A value as YAML that reads back as the same.
std::string YamlText(double value);
std::string YamlText(int value);
std::string YamlText(std::uint32_t value);
std::string YamlText(bool value);
std::string YamlText(const std::string& value);
std::string YamlText(const std::vector<double>& values);

/// A section of options: who reads a key also says what it means, which the document keeps for
/// those who print it (DocumentedYaml).
class OptionSection : public YamlSection {
 public:
  explicit OptionSection(YamlDocument* document) : YamlSection(document) {}

  OptionSection Section(const std::string& key, const std::string& meaning);
  OptionSection RequiredSection(const std::string& key,
                                const std::string& meaning,
                                const std::string& remedy = "");
  /// A section that is described elsewhere.
  YamlSection Peek(const std::string& key) { return YamlSection::Section(key); }

  template <typename Value>
  void Read(const std::string& key, Value* value, const std::string& meaning) {
    YamlSection::Read(key, value);
    Describe(key, YamlText(*value), meaning);
  }

  template <typename Value>
  void ReadRequired(const std::string& key,
                    Value* value,
                    const std::string& meaning,
                    const std::string& remedy = "") {
    YamlSection::ReadRequired(key, value, remedy);
    Describe(key, YamlText(*value), meaning);
    MarkAsNeeded();
  }

  /// Degrees in the file, radians here.
  void ReadDegrees(const std::string& key, double* value_rad, const std::string& meaning);

  /// {quaternion_xyzw, translation_m}; nothing if it is not given.
  std::optional<Eigen::Isometry3d> ReadTransform(const std::string& key,
                                                 const std::string& meaning);

  /// One of these words, each with what it stands for. The meaning goes on with them.
  template <typename Value>
  void ReadOneOf(const std::string& key,
                 const std::vector<std::pair<std::string, Value>>& words,
                 Value* value,
                 const std::string& meaning) {
    std::vector<std::string> names;
    std::string word;
    for (const auto& [name, stands_for] : words) {
      names.push_back(name);
      if (stands_for == *value) word = name;
    }
    ReadWord(key, names, &word, meaning);
    for (const auto& [name, stands_for] : words) {
      if (name == word) *value = stands_for;
    }
  }

  /// Says what a key means that is read by other means.
  /// @param is_example  see YamlDocument::KnownKey.
  void Describe(const std::string& key,
                const std::string& value,
                const std::string& meaning,
                bool is_example = false);

 private:
  explicit OptionSection(YamlSection section) : YamlSection(std::move(section)) {}

  void MarkAsNeeded();  ///< What was described last.

  void ReadWord(const std::string& key,
                const std::vector<std::string>& words,
                std::string* word,
                const std::string& meaning);
};

/// The keys as a YAML file that explains each of them.
std::string DocumentedYaml(const std::vector<YamlDocument::KnownKey>& keys);

}  // namespace voqcal
