#include "rig/channel_section.hpp"

#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "core/sensor_network/sensor_pair.hpp"

namespace voqcal {
namespace {

enum class Owner { kLidar, kCamera, kPair, kRig };

struct ChannelKey {
  const char* key;
  std::string Channels::*name;
  Owner owner;
  const char* meaning;
};

constexpr char kMeaning[] = "name of each message's channel";

constexpr ChannelKey kKeys[] = {
    {"lidar_points", &Channels::lidar_points, Owner::kLidar, "sweeps"},
    {"lidar_packets", &Channels::lidar_packets, Owner::kLidar, "a lidar's datagrams as they came"},
    {"camera_image", &Channels::camera_image, Owner::kCamera, "images"},
    {"camera_info", &Channels::camera_info, Owner::kCamera, "the lens"},
    {"lidar_board", &Channels::lidar_board, Owner::kLidar, "boards seen by the lidar"},
    {"camera_board", &Channels::camera_board, Owner::kCamera, "boards seen by the camera"},
    {"calib_command", &Channels::calib_command, Owner::kRig, "the operator's commands"},
    {"calib_event", &Channels::calib_event, Owner::kPair, "each accept or reject"},
    {"calib_samples", &Channels::calib_samples, Owner::kPair, "all accepted samples"},
    {"voq_sets", &Channels::voq_sets, Owner::kPair, "the chosen sets"},
    {"extrinsic_averaged", &Channels::extrinsic_averaged, Owner::kPair, "the sets' mean"},
    {"extrinsic_refined", &Channels::extrinsic_refined, Owner::kPair, "the result"},
    {"calib_assessment", &Channels::calib_assessment, Owner::kPair, "its scores"},
    {"next_pose", &Channels::next_pose, Owner::kPair, "where to hold the board next"},
    {"simulated_board",
     &Channels::simulated_board,
     Owner::kRig,
     "where a simulated board that follows the guidance is"},
    {"module_status", &Channels::module_status, Owner::kRig, "every module's heartbeat"},
    {"camera_to_lidar", &Channels::camera_to_lidar, Owner::kPair, "publish_extrinsic's transform"},
    {"extrinsic_check",
     &Channels::extrinsic_check,
     Owner::kPair,
     "whether the extrinsic is still right"},
    {"rig_extrinsics",
     &Channels::rig_extrinsics,
     Owner::kRig,
     "of several sensors: all as one tree"},
};

/// Channels that LCM can carry, and no two the same.
class ChannelNames {
 public:
  explicit ChannelNames(std::string prefix) : prefix_(std::move(prefix)) {}

  /// The channel `name`, prefix included. Errors are those of `key` in `section`, which must
  /// outlive this.
  std::string Take(const std::string& name, const char* key, OptionSection* section) {
    constexpr std::size_t kMaxLength = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH of LCM 1.3
    if (name.empty()) section->AddError(key, "must not be empty");
    std::string channel = prefix_ + name;
    if (channel.size() > kMaxLength) {
      section->AddError(key, "must have at most 63 letters, prefix and sensors' names included");
    }
    const auto [same, is_new] = taken_.emplace(channel, std::make_pair(section, key));
    if (!is_new) {  // told of the one that the file gives: the other may be a default
      const auto& [other_section, other_key] = same->second;
      const bool is_here = section->Has(key);
      (is_here ? section : other_section)
          ->AddError(is_here ? key : other_key, "must differ from other channels");
    }
    return channel;
  }

 private:
  std::string prefix_;
  std::map<std::string, std::pair<OptionSection*, const char*>> taken_;
};

}  // namespace

void ReadChannels(OptionSection* top, const std::string& prefix, Channels* channels) {
  OptionSection section = top->Section("channels", kMeaning);
  ChannelNames names(prefix);
  for (const ChannelKey& each : kKeys) {
    std::string& name = channels->*each.name;
    section.Read(each.key, &name, each.meaning);
    name = names.Take(name, each.key, &section);
  }
  section.RefuseUnknownKeys();
}

void ReadChannels(OptionSection* top,
                  const std::string& prefix,
                  const PairOfEntries& pair,
                  SensorEntries* entries,
                  Channels* channels) {
  OptionSection shared = top->Section("channels", kMeaning);
  ChannelNames names(prefix);
  const std::string ending_of_pair = "_" + PairName(pair.lidar->name, pair.camera->name);
  for (const ChannelKey& each : kKeys) {
    std::string& name = channels->*each.name;
    shared.Read(each.key, &name, each.meaning);
    if (each.owner == Owner::kPair) name += ending_of_pair;
    if (each.owner == Owner::kPair || each.owner == Owner::kRig) {
      name = names.Take(name, each.key, &shared);
    }
  }
  shared.RefuseUnknownKeys();

  std::deque<OptionSection> sections;  // stay where they are
  const Channels base = *channels;
  const auto read_sensor = [&](SensorEntry* entry, Owner kind, bool is_chosen) {
    OptionSection& section = sections.emplace_back(
        entry->section.Section("channels", "of this sensor: else they end with its name"));
    for (const ChannelKey& each : kKeys) {
      if (each.owner != kind) continue;
      std::string name = base.*each.name + "_" + entry->name;
      section.Read(each.key, &name, each.meaning);
      name = names.Take(name, each.key, &section);
      if (is_chosen) channels->*each.name = name;
    }
    section.RefuseUnknownKeys();
  };
  for (SensorEntry& each : entries->lidars) {
    read_sensor(&each, Owner::kLidar, &each == pair.lidar);
  }
  for (SensorEntry& each : entries->cameras) {
    read_sensor(&each, Owner::kCamera, &each == pair.camera);
  }
}

}  // namespace voqcal
