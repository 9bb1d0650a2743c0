#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// A rig file in the making: keys and values by section, as YAML has them, each section with a
/// comment on where its values are from.
class RigDraft {
 public:
  /// @param name  of the rig.
  explicit RigDraft(std::string name) : name_(std::move(name)) {}

  /// Takes "board.width_m=0.61".
  /// @throws std::invalid_argument naming it if it is not SECTION.KEY=VALUE.
  void Add(const std::string& assignment);
  void Add(const CameraModel& camera, const std::string& from);
  /// As the others, unless the key is there.
  void AddDefault(const std::string& section, const std::string& key, const std::string& value);

  bool Has(const std::string& section, const std::string& key) const;

  /// A line for each number of the board that only who holds it can know and that is not given: its
  /// key with an example and its meaning. Empty if all are there.
  std::string MissingOfBoard() const;

  /// The file.
  std::string Text() const;

  /// What the file says, checked.
  /// @throws std::runtime_error naming each wrong key and its value.
  Rig Read() const;

 private:
  struct Section {
    std::string comment;
    std::vector<std::pair<std::string, std::string>> keys;
  };

  std::string name_;
  std::map<std::string, Section> sections_;  // board and camera come first by their names
};

}  // namespace voqcal
