// calibrate_rig: every pair of a rig's lidars and cameras on one recording, joined to one tree.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "calibrate/bag.hpp"
#include "calibrate/finish_session.hpp"
#include "calibrate_rig/calibrate_pairs.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "core/add_if_new.hpp"
#include "files/atomic_file.hpp"
#include "files/nearest_word.hpp"
#include "messaging/log.hpp"
#include "result/rig_extrinsics.hpp"
#include "rig/rig.hpp"
#include "rig/rig_doubts.hpp"

namespace voqcal {
namespace {

struct CalibrateRigArgs {
  std::filesystem::path rig;
  std::filesystem::path log;
  std::vector<std::string> bag;  ///< Instead of log: a recording of ROS, its paths.
  std::multimap<std::string, std::string> topics;  ///< Of bag, by sensor.
  std::filesystem::path out;
  std::string reference;  ///< Empty: the first lidar.
  RecordingTimes times = RecordingTimes::kAuto;
  std::string demand;  ///< "usable" or "good"; empty: none.

  /// The recording, for people.
  std::string Given() const { return bag.empty() ? log.string() : bag.front(); }
};

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

RigSensors SensorsOf(const std::vector<Rig>& pairs) {
  RigSensors sensors;
  for (const Rig& rig : pairs) {
    AddIfNew(rig.lidar_name, &sensors.lidars);
    AddIfNew(rig.camera_name, &sensors.cameras);
  }
  return sensors;
}

std::vector<std::string> NamesOf(const RigSensors& sensors) {
  std::vector<std::string> names = sensors.lidars;
  names.insert(names.end(), sensors.cameras.begin(), sensors.cameras.end());
  return names;
}

void TellDoubts(const std::vector<Rig>& pairs) {
  std::vector<std::string> doubts;
  for (const Rig& rig : pairs) {
    for (const std::string& doubt : BoardDoubts(rig.board)) AddIfNew(doubt, &doubts);
    for (const std::string& doubt : CameraDoubts(rig.camera)) {
      AddIfNew(rig.camera_name + ": " + doubt, &doubts);
    }
  }
  for (const std::string& doubt : doubts) spdlog::warn("{}", doubt);
}

/// @param flag  that names it.
/// @throws std::runtime_error unless it is one of the sensors.
void RequireSensor(const std::string& flag,
                   const std::string& name,
                   const CalibrateRigArgs& args,
                   const RigSensors& sensors) {
  const std::vector<std::string> names = NamesOf(sensors);
  const std::set<std::string> words(names.begin(), names.end());
  if (words.count(name) != 0) return;
  const std::string meant = NearestWord(name, words);
  throw std::runtime_error(flag + " must be a sensor of " + args.rig.string() + ", is '" + name +
                           "'" + (meant.empty() ? "" : " (did you mean " + meant + "?)") +
                           "; it has " + Joined(names));
}

void RequireSensors(const CalibrateRigArgs& args, const RigSensors& sensors) {
  if (!args.reference.empty()) RequireSensor("--reference", args.reference, args, sensors);
  for (const auto& [name, topic] : args.topics) {
    RequireSensor("--topic " + name + "=" + topic, name, args, sensors);
  }
}

bool AreByName(const std::vector<Rig>& pairs) {
  return !PlaceOfRig(pairs.front().path).names.empty();
}

/// The file and, of its sensors, those whose channel is there.
std::string WithoutMissing(const CalibrateRigArgs& args,
                           const RigSensors& sensors,
                           const std::map<std::string, std::string>& missing) {
  std::string text;
  for (const std::string& name : NamesOf(sensors)) {
    if (missing.count(name) == 0) text += (text.empty() ? "#" : ",") + name;
  }
  return PlaceOfRig(args.rig).file.string() + text;
}

/// A sensor that was not recorded is better told before an hour of work than after it.
/// @throws std::runtime_error with a line for each.
void RequireChannels(const CalibrateRigArgs& args, const std::vector<Rig>& pairs) {
  std::map<std::string, std::string> missing;  // channel by sensor
  for (const Rig& rig : pairs) {
    missing[rig.lidar_name] = rig.channels.lidar_points;
    missing[rig.camera_name] = rig.channels.camera_image;
  }
  std::set<std::string> there;
  LogReader reader(args.log);
  try {
    while (!missing.empty()) {
      const std::optional<LogEvent> event = reader.Next();
      if (!event) break;
      if (!there.insert(event->channel).second) continue;
      for (auto each = missing.begin(); each != missing.end();) {
        each = each->second == event->channel ? missing.erase(each) : std::next(each);
      }
    }
  } catch (const TruncatedLogError&) {  // told by who collects the samples
  }
  if (missing.empty()) return;
  const RigSensors sensors = SensorsOf(pairs);
  std::string text;
  for (const auto& [sensor, channel] : missing) {
    text += (text.empty() ? "" : "\n") + args.log.string() + ": has no channel " + channel + " (" +
            sensor + ")";
  }
  text += "; it has " + Joined({there.begin(), there.end()});
  if (AreByName(pairs)) {
    text += ". Name each sensor's own channel under its `channels`, or leave sensors out: " +
            WithoutMissing(args, sensors, missing);
  }
  throw std::runtime_error(text);
}

void RequireFolder(const CalibrateRigArgs& args, const std::vector<Rig>& pairs) {
  if (std::filesystem::exists(args.out) && !std::filesystem::is_directory(args.out)) {
    throw std::runtime_error(args.out.string() + ": is in the way: --out names a folder");
  }
  for (const Rig& rig : pairs) {  // a live session's, which must not be replaced
    RequireNotBeingWritten(args.out / FolderOf(rig) / kSamplesLogName);
  }
}

/// @throws std::runtime_error unless the rig is one piece.
///
/// @param advice  of each pair, where nearly all frames failed for one reason.
void RequireOnePiece(const CalibrateRigArgs& args,
                     const RigExtrinsics& result,
                     const std::vector<std::string>& advice) {
  if (result.network.IsUsable()) return;
  const bool has_cause = std::any_of(
      advice.begin(), advice.end(), [](const std::string& each) { return !each.empty(); });
  std::string text = args.Given() + ": no calibration of the rig: " + result.network.problem;
  for (const CalibratedPair& pair : result.pairs) {
    if (!pair.problem.empty()) text += "\n" + pair.Name() + ": " + pair.problem;
  }
  if (has_cause) text += "\nfirst mend what was said above of pairs whose frames nearly all fail";
  const std::filesystem::path earlier = args.out / kRigResultName;
  if (std::filesystem::exists(earlier)) text += "\n" + earlier.string() + " is of an earlier run";
  throw std::runtime_error(text);
}

/// @return the log.
std::filesystem::path Import(const CalibrateRigArgs& args,
                             const std::vector<Rig>& pairs,
                             const std::filesystem::path& folder) {
  if (AreByName(pairs)) return ImportBagOfRig(pairs, args.bag, args.topics, args.times, folder);
  const Rig& rig = pairs.front();
  BagInput bag;
  bag.paths = args.bag;
  for (const auto& [name, topic] : args.topics) {
    (name == rig.lidar_name ? bag.lidar_topic : bag.image_topic) = topic;
  }
  return ImportBag(rig, bag, args.times, folder);
}

CalibratedPairs CalibrateAll(const CalibrateRigArgs& args, const std::vector<Rig>& pairs) {
  if (args.bag.empty()) RequireChannels(args, pairs);
  const ScratchFolder scratch(args.out);
  RigRecording recording = {args.log, args.times, args.Given()};
  if (!args.bag.empty()) {
    recording.log = Import(args, pairs, scratch.path());
    recording.times = RecordingTimes::kStamps;  // the import has settled them
  }
  return CalibratePairs(pairs, recording, {scratch.path(), args.out});
}

/// "left=/left/image": a sensor's topic.
void TakeTopic(const std::string& text, CalibrateRigArgs* args) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw CLI::ValidationError("--topic", "must be SENSOR=NAME, is " + text);
  }
  args->topics.emplace(text.substr(0, equals), text.substr(equals + 1));
}

void CalibrateRig(const CalibrateRigArgs& args) {
  const std::vector<Rig> pairs = LoadPairs(args.rig, PairLine::kIsIgnored);
  const RigSensors sensors = SensorsOf(pairs);
  RequireSensors(args, sensors);
  RequireFolder(args, pairs);
  TellDoubts(pairs);
  const CalibratedPairs calibrated = CalibrateAll(args, pairs);
  const std::string reference = args.reference.empty() ? sensors.lidars.front() : args.reference;
  const RigExtrinsics result =
      JoinSessions(calibrated.sessions,
                   reference,
                   {pairs.front().rig_name, pairs.front().sha256, VOQCAL_VERSION});
  RequireOnePiece(args, result, calibrated.advice);
  WriteFileAtomically(args.out / kRigResultName, ToYaml(result));
  std::cout << Summary(result) << "written\n  " << (args.out / kRigResultName).string() << '\n';
  for (const Rig& rig : pairs) std::cout << "  " << (args.out / FolderOf(rig)).string() << "/\n";
  RequireVerdict(VerdictOf(result), args.demand);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  using voqcal::RecordingTimes;
  CLI::App app(
      "Calibrates every pair of a rig's lidars and cameras from one recording of all of them, and "
      "joins them to one tree. Pairs that never see the board together are left out, as long as "
      "others join the rig.\n"
      "Exit status: 0 done; 1 and 2 errors, among them a rig that falls apart; 3 the result is not "
      "what --require demands.",
      "calibrate_rig");
  voqcal::CalibrateRigArgs args;
  app.add_option("rig",
                 args.rig,
                 "The rig file (YAML), with its sensors by name under lidars and cameras; "
                 "FILE#front,left,right takes these alone")
      ->required();
  auto* input = app.add_option_group("input", "One of:");
  input->add_option("--log", args.log, "A recording (LCM log) of all sensors");
  auto* bag = input->add_option("--bag",
                                args.bag,
                                "A recording of ROS 1 or 2: .bag, .mcap, .db3, their folder; "
                                "several files if it is split. Or an LCM log of lidars' packets or "
                                "of types of your own");
  input->require_option(1);
  app.add_option_function<std::vector<std::string>>(
         "--topic",
         [&](const std::vector<std::string>& topics) {
           for (const std::string& topic : topics) voqcal::TakeTopic(topic, &args);
         },
         "SENSOR=NAME, of --bag: a sensor's topic; may be left out where there are as many topics "
         "as sensors, with the sensors' names in theirs")
      ->needs(bag)
      ->allow_extra_args(false);
  app.add_option("--out",
                 args.out,
                 "Folder for rig_extrinsics.yaml and, in LIDAR_CAMERA/, what calibrate leaves of "
                 "each pair; made if missing")
      ->required();
  app.add_option(
      "--reference", args.reference, "The sensor in whose frame the others stand; the first lidar");
  const std::map<std::string, RecordingTimes> times = {{"auto", RecordingTimes::kAuto},
                                                       {"stamps", RecordingTimes::kStamps},
                                                       {"log", RecordingTimes::kLog}};
  app.add_option_function<std::string>(
         "--times",
         [&](const std::string& name) { args.times = times.at(name); },
         "A message's time is its stamp, or when it was recorded (log); auto, unless told, takes "
         "stamps unless those of a pair are of different clocks")
      ->check(CLI::IsMember({"auto", "stamps", "log"}));
  app.add_option("--require",
                 args.demand,
                 "End with exit status 3 unless the verdict is at least this: usable or good")
      ->check(CLI::IsMember({"usable", "good"}));
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::CalibrateRig(args); });
}
