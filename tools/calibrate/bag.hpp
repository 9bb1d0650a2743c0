#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "calibrate/recording_clocks.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// A recording of ROS, or an LCM log of packets or other types, as tools/import_ros takes it.
struct BagInput {
  std::vector<std::string> paths;
  std::string lidar_topic;       ///< Empty: the only one.
  std::string image_topic;       ///< Empty: the only one.
  bool has_images_only = false;  ///< No lidar is looked for.
};

/// Makes an LCM log of it on the rig's channels, in `folder`. What import_ros says goes to stderr.
/// @throws std::runtime_error naming the recording; import_ros has told the cause.
std::filesystem::path ImportBag(const Rig& rig,
                                const BagInput& bag,
                                RecordingTimes times,
                                const std::filesystem::path& folder);

/// The same of a rig whose sensors have names.
/// @param topics  by sensor; those left out are matched as import_ros does it.
std::filesystem::path ImportBagOfRig(const std::vector<Rig>& pairs,
                                     const std::vector<std::string>& paths,
                                     const std::multimap<std::string, std::string>& topics,
                                     RecordingTimes times,
                                     const std::filesystem::path& folder);

}  // namespace voqcal
