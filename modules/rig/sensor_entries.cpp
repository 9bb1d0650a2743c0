#include "rig/sensor_entries.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <stdexcept>

#include "core/sensor_network/sensor_pair.hpp"
#include "files/nearest_word.hpp"

namespace voqcal {
namespace {

/// Names are part of channels, folders and frames.
bool IsName(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_';
         });
}

/// What YAML reads as a truth value or as nothing, where it stands without quotes.
bool IsWordOfYaml(std::string name) {
  static const std::set<std::string> kWords = {
      "y", "n", "yes", "no", "on", "off", "true", "false", "null"};
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return kWords.count(name) != 0;
}

std::vector<SensorEntry> ReadKind(OptionSection* top,
                                  const std::string& kind,
                                  std::set<std::string>* taken) {
  std::vector<SensorEntry> entries;
  OptionSection section =
      top->Section(kind, "each under a name of its own, with the sections that are of it");
  if (section.keys().empty()) top->AddError(kind, "must have a section for each, under its name");
  for (const std::string& name : section.keys()) {
    if (!IsName(name)) {
      section.AddError(name, "must be named by a letter, then letters, digits and _ alone");
    } else if (IsWordOfYaml(name)) {
      section.AddError(name, "must be named otherwise: YAML has a meaning for that word");
    }
    if (!taken->insert(name).second) {
      section.AddError(name, "must be named unlike every other sensor");
    }
    entries.push_back({name, section.Section(name, "one of the " + kind)});
  }
  return entries;
}

/// Pairs go by their names: those of two must not be the same.
void RefuseSameNames(const SensorEntries& entries, OptionSection* top) {
  std::map<std::string, std::string> words;  // by name
  for (const SensorEntry& lidar : entries.lidars) {
    for (const SensorEntry& camera : entries.cameras) {
      const std::string name = PairName(lidar.name, camera.name);
      const std::string pair = lidar.name + " with " + camera.name;
      const auto [same, is_new] = words.emplace(name, pair);
      if (is_new) continue;
      top->AddError("cameras",
                    "must not make pairs of one name: " + same->second + " and " + pair +
                        " are both " + name);
    }
  }
}

std::vector<std::string> NamesOf(const std::vector<SensorEntry>& entries) {
  std::vector<std::string> names;
  for (const SensorEntry& entry : entries) names.push_back(entry.name);
  return names;
}

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? " " : ", ") + name;
  return text;
}

SensorEntry* Find(const std::string& name, std::vector<SensorEntry>* entries) {
  const auto found = std::find_if(entries->begin(),
                                  entries->end(),
                                  [&name](const SensorEntry& each) { return each.name == name; });
  return found == entries->end() ? nullptr : &*found;
}

/// "lidars front, rear; cameras left".
std::string ListOf(const RigSensors& sensors) {
  return "lidars" + Joined(sensors.lidars) + "; cameras" + Joined(sensors.cameras);
}

void Take(const RigPlace& place, SensorEntry* entry, const std::string& kind, SensorEntry** slot) {
  if (*slot != nullptr) {
    throw std::runtime_error(place.file.string() + ": " + (*slot)->name + " and " + entry->name +
                             " are both " + kind + ": a pair is a lidar and a camera");
  }
  *slot = entry;
}

std::string HowToName(const RigPlace& place, SensorChoice choice, const RigSensors& sensors) {
  const std::string file = place.file.string() + "#";
  switch (choice) {
    case SensorChoice::kLidar:
      return "name a lidar, as in " + file + sensors.lidars[0];
    case SensorChoice::kCamera:
      return "name a camera, as in " + file + sensors.cameras[0];
    case SensorChoice::kPair:
      break;
  }
  return "name a pair of them, as in " + file + sensors.lidars[0] + "," + sensors.cameras[0] +
         " (tools/up, calibrate_rig and check_rig take them all)";
}

}  // namespace

RigSensors SensorEntries::Names() const { return {NamesOf(lidars), NamesOf(cameras)}; }

SensorEntries ReadSensorEntries(OptionSection* top) {
  SensorEntries entries;
  if (!top->Has("lidars") && !top->Has("cameras")) {
    top->Peek("lidars");  // known keys
    top->Peek("cameras");
    return entries;
  }
  std::set<std::string> taken;
  entries.lidars = ReadKind(top, "lidars", &taken);
  entries.cameras = ReadKind(top, "cameras", &taken);
  RefuseSameNames(entries, top);
  const auto refuse = [top](const char* key, const std::string& kind) {
    if (top->Has(key)) {
      top->AddError(key,
                    "must be in a sensor's own section, " + kind +
                        ".NAME, beside lidars and "
                        "cameras");
      top->Peek(key);
    }
  };
  refuse("lidar_driver", "lidars");
  refuse("camera_driver", "cameras");
  refuse("camera", "cameras");
  return entries;
}

void RequireNames(const RigPlace& place, const RigSensors& sensors) {
  std::set<std::string> words(sensors.lidars.begin(), sensors.lidars.end());
  words.insert(sensors.cameras.begin(), sensors.cameras.end());
  for (const std::string& name : place.names) {
    if (words.count(name) != 0) continue;
    const std::string meant = NearestWord(name, words);
    throw std::runtime_error(
        place.file.string() + ": has no sensor '" + name + "'" +
        (meant.empty() ? "" : " (did you mean " + meant + "?)") + "; it has " +
        (words.empty() ? "one lidar and one camera, neither by name: leave out what follows #"
                       : ListOf(sensors)));
  }
}

PairOfEntries ChoosePair(const RigPlace& place, SensorChoice choice, SensorEntries* entries) {
  const RigSensors sensors = entries->Names();
  RequireNames(place, sensors);
  PairOfEntries pair;
  for (const std::string& name : place.names) {
    if (SensorEntry* lidar = Find(name, &entries->lidars)) {
      Take(place, lidar, "lidars", &pair.lidar);
    } else {
      Take(place, Find(name, &entries->cameras), "cameras", &pair.camera);
    }
  }
  const bool is_one_lidar = entries->lidars.size() == 1 || choice == SensorChoice::kCamera;
  const bool is_one_camera = entries->cameras.size() == 1 || choice == SensorChoice::kLidar;
  if (pair.lidar == nullptr && is_one_lidar) pair.lidar = &entries->lidars[0];
  if (pair.camera == nullptr && is_one_camera) pair.camera = &entries->cameras[0];
  if (pair.lidar != nullptr && pair.camera != nullptr) return pair;
  throw std::runtime_error(place.file.string() + ": has " + ListOf(sensors) + ": " +
                           HowToName(place, choice, sensors));
}

}  // namespace voqcal
