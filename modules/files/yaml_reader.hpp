#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <yaml-cpp/node/node.h>

namespace voqcal {

/// One YAML file and what is wrong in it. All errors are kept, so that a user sees them at once.
class YamlDocument {
 public:
  /// A key that was read with its meaning (OptionSection), given or not.
  struct KnownKey {
    std::string path;   ///< "camera.fx_px".
    std::string value;  ///< As YAML: the file's, or else its default; empty for a section.
    std::string meaning;
    bool is_example = false;  ///< `value` is not, or not exactly, what holds without the key.
    bool is_needed = false;   ///< The file must have it.
  };

  /// @param name  what errors call the file.
  /// @throws std::runtime_error naming file and line if `text` is not one YAML mapping.
  YamlDocument(std::string name, const std::string& text);

  void AddError(int line, const std::string& text);

  /// What is to be told of the file although it can be read, in its order.
  std::vector<std::string> Remarks() const;

  /// @throws std::runtime_error with one line for each error, in the order of the file.
  void ThrowIfWrong() const;

  const std::vector<KnownKey>& known_keys() const { return known_keys_; }

 private:
  friend class YamlSection;
  friend class OptionSection;

  std::string name_;
  YAML::Node root_;
  std::multimap<int, std::string> errors_;  ///< By line.
  std::multimap<int, std::string> remarks_;
  std::vector<KnownKey> known_keys_;
};

/// One mapping of a document. Keys that are not given leave the value as it is; values of a wrong
/// type, repeated keys and keys that nobody read are errors of the document.
class YamlSection {
 public:
  /// The top level. The document must outlive the section.
  explicit YamlSection(YamlDocument* document);

  /// A mapping within this one; empty if it is not given.
  YamlSection Section(const std::string& key);
  /// The same, and an error if it is not given, which ends with `remedy`.
  YamlSection RequiredSection(const std::string& key, const std::string& remedy = "");

  /// An error if the key is not given, which ends with `remedy`.
  void Require(const std::string& key, const std::string& remedy);

  bool Has(const std::string& key) const { return entries_.count(key) > 0; }

  /// Every key that is given, in the file's order.
  const std::vector<std::string>& keys() const { return keys_; }

  void Read(const std::string& key, double* value);  ///< Finite.
  void Read(const std::string& key, int* value);
  void Read(const std::string& key, std::uint32_t* value);
  void Read(const std::string& key, bool* value);
  void Read(const std::string& key, std::string* value);
  void Read(const std::string& key, std::vector<double>* values);
  void Read(const std::string& key, Eigen::Vector3d* value);
  void Read(const std::string& key, std::vector<std::vector<double>>* rows);

  /// Degrees in the file, radians here.
  void ReadDegrees(const std::string& key, double* value_rad);

  /// The same as Read, and an error if the key is not given, which ends with `remedy`.
  template <typename Value>
  void ReadRequired(const std::string& key, Value* value, const std::string& remedy = "") {
    is_required_ = true;
    remedy_ = remedy;
    Read(key, value);
    is_required_ = false;
  }

  /// A key that older files may have: it does nothing, which is a remark if it is given.
  /// @param instead  the key of this section that does now what it was there for.
  void PassOver(const std::string& key, const std::string& instead);

  /// A remark at the key's value.
  void AddRemark(const std::string& key, const std::string& text);

  /// True if every required key was given with a value of its type: checks of the whole make sense.
  bool IsComplete() const { return is_complete_; }

  /// An error at the key's value: "camera.lens_model must be ..., is "x"".
  void AddError(const std::string& key, const std::string& rule);

  /// Errors of this section as a whole, at the line of the key that they begin with, if it is here.
  void AddProblems(const std::vector<std::string>& problems);

  /// The keys that nobody has read become errors, with the known one that they resemble. The last
  /// thing to do with a section.
  void RefuseUnknownKeys();

 protected:
  std::string PathOf(const std::string& key) const;
  YamlDocument& document() { return *document_; }

 private:
  struct Entry {
    YAML::Node value;
    int line = 0;  ///< Of the key.
    bool is_read = false;
  };

  YamlSection(YamlDocument* document, YAML::Node node, std::string path, int line);

  /// The key is known from now on; its value, or nullptr if it is not given.
  const YAML::Node* Find(const std::string& key);
  template <typename Value>
  void ReadScalar(const std::string& key, const char* rule, Value* value);
  int LineOf(const std::string& key) const;

  YamlDocument* document_;
  std::string path_;  ///< "camera"; empty at the top level.
  int line_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> keys_;
  std::set<std::string> known_;  ///< Keys that were asked for.
  bool is_required_ = false;
  std::string remedy_;  ///< Of the required key that is read.
  bool is_complete_ = true;
};

}  // namespace voqcal
