#include "calibrate/bag.hpp"

#include <stdexcept>

#include "common/run_program.hpp"
#include "core/add_if_new.hpp"

namespace voqcal {
namespace {

const char* NameOf(RecordingTimes times) {
  switch (times) {
    case RecordingTimes::kAuto:
      return "auto";
    case RecordingTimes::kStamps:
      return "stamps";
    case RecordingTimes::kLog:
      return "log";
  }
  throw std::logic_error("NameOf: unknown times");
}

/// A call of import_ros.
class Import {
 public:
  Import(const Rig& rig, RecordingTimes times, const std::filesystem::path& folder)
      : log_(folder / "recording.lcm"),
        // By the shell, for stdout is calibrate's own (--json).
        args_{"/bin/sh", "-c", "exec \"$0\" \"$@\" >&2", ScriptOfTools("import_ros")} {
    Add("--out", log_.string());
    Add("--lcm-types", rig.lcm_types.string());
    Add("--times", NameOf(times));
  }

  void Add(const std::string& flag, const std::string& value) {
    if (!value.empty()) args_.insert(args_.end(), {flag, value});
  }
  void Add(const std::string& flag) { args_.push_back(flag); }

  /// @return the log.
  std::filesystem::path Run(const std::vector<std::string>& paths) {
    args_.emplace_back("--");
    args_.insert(args_.end(), paths.begin(), paths.end());
    if (RunProgram(args_).empty()) return log_;
    throw std::runtime_error(paths.front() +
                             ": no calibration: it cannot be imported (the cause is above)");
  }

 private:
  std::filesystem::path log_;
  std::vector<std::string> args_;
};

}  // namespace

std::filesystem::path ImportBag(const Rig& rig,
                                const BagInput& bag,
                                RecordingTimes times,
                                const std::filesystem::path& folder) {
  Import import(rig, times, folder);
  if (bag.has_images_only) {
    import.Add("--images-only");
  } else {
    import.Add("--rig", rig.path.string());
  }
  import.Add("--lidar-channel", rig.channels.lidar_points);
  import.Add("--image-channel", rig.channels.camera_image);
  import.Add("--lidar-topic", bag.lidar_topic);
  import.Add("--image-topic", bag.image_topic);
  return import.Run(bag.paths);
}

std::filesystem::path ImportBagOfRig(const std::vector<Rig>& pairs,
                                     const std::vector<std::string>& paths,
                                     const std::multimap<std::string, std::string>& topics,
                                     RecordingTimes times,
                                     const std::filesystem::path& folder) {
  Import import(pairs.front(), times, folder);
  import.Add("--rig", PlaceOfRig(pairs.front().path).file.string());
  std::vector<std::string> lidars;
  std::vector<std::string> cameras;
  for (const Rig& rig : pairs) {
    AddIfNew(rig.lidar_name + "=" + rig.channels.lidar_points, &lidars);
    AddIfNew(rig.camera_name + "=" + rig.channels.camera_image, &cameras);
  }
  for (const std::string& lidar : lidars) import.Add("--lidar", lidar);
  for (const std::string& camera : cameras) import.Add("--camera", camera);
  for (const auto& [sensor, topic] : topics) import.Add("--topic", sensor + "=" + topic);
  return import.Run(paths);
}

}  // namespace voqcal
