#include "calibrate/bag.hpp"

#include <stdexcept>

#include "common/run_program.hpp"

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

}  // namespace

std::filesystem::path ImportBag(const Rig& rig,
                                const BagInput& bag,
                                RecordingTimes times,
                                const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / "recording.lcm";
  // By the shell, for stdout is calibrate's own (--json).
  std::vector<std::string> args = {
      "/bin/sh", "-c", "exec \"$0\" \"$@\" >&2", ScriptOfTools("import_ros")};
  const auto add = [&args](const std::string& flag, const std::string& value) {
    if (!value.empty()) args.insert(args.end(), {flag, value});
  };
  add("--out", log.string());
  if (bag.has_images_only) {
    args.emplace_back("--images-only");
  } else {
    add("--rig", rig.path.string());
  }
  add("--lidar-channel", rig.channels.lidar_points);
  add("--image-channel", rig.channels.camera_image);
  add("--lidar-topic", bag.lidar_topic);
  add("--image-topic", bag.image_topic);
  add("--lcm-types", rig.lcm_types.string());
  add("--times", NameOf(times));
  args.push_back("--");
  args.insert(args.end(), bag.paths.begin(), bag.paths.end());
  if (RunProgram(args).empty()) return log;
  throw std::runtime_error(bag.paths.front() +
                           ": no calibration: it cannot be imported (the cause is above)");
}

}  // namespace voqcal
