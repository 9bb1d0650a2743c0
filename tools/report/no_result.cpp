#include "report/no_result.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "calibrate/advice.hpp"
#include "common/run_program.hpp"
#include "common/scratch_folder.hpp"
#include "files/atomic_file.hpp"
#include "files/sha256.hpp"
#include "images/jpeg.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/session_misses.hpp"
#include "messaging/session_scenes.hpp"
#include "report/seen.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::json;

/// Pictures in a folder, and what is told of each.
class Pictures {
 public:
  explicit Pictures(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The name of the file that it was written to.
  std::string Write(const cv::Mat& picture) {
    constexpr int kQuality = 78;
    const std::string name = std::to_string(num_++) + ".jpg";
    const std::vector<std::uint8_t> jpeg = EncodeJpeg(picture, kQuality);
    WriteFileAtomically(folder_ / name, {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
    return name;
  }

 private:
  std::filesystem::path folder_;
  int num_ = 0;
};

Json PartOf(const ImageMiss& miss, const Rig& rig, Pictures* pictures) {
  const cv::Mat image = FromMessage(miss.image);
  const std::string& detail = miss.board.detail;
  return {{"sensor", "camera"},
          {"reason", miss.board.miss + (detail.empty() ? "" : ": " + detail)},
          {"advice", AdviceOn("camera_board_detector", miss.board.miss)},
          {"files", {pictures->Write(DrawImage(image, {}, rig.camera))}}};
}

Json PartOf(const SweepMiss& miss, Pictures* pictures) {
  const PointCloud sweep_lidar_m = FromMessage(miss.sweep);
  std::optional<BoardPose> unsure;
  if (!miss.board.candidates.empty()) unsure = FromMessage(miss.board.candidates[0].pose);
  Json part = {{"sensor", "lidar"},
               {"reason", miss.board.miss},
               {"advice", AdviceOn("lidar_board_detector", miss.board.miss)},
               {"files", {pictures->Write(DrawSweep(sweep_lidar_m, unsure))}}};
  if (unsure && unsure->centre_m.allFinite()) {
    part["files"].push_back(pictures->Write(DrawSweepNear(sweep_lidar_m, *unsure)));
  }
  return part;
}

/// "LIDAR_MISS: no plane" is the lidar's, what has no such beginning the collector's.
Json PartOf(const counter_t& counter) {
  const std::vector<std::pair<std::string, std::string>> kModules = {
      {kLidarMissChannel, "lidar_board_detector"}, {kCameraMissChannel, "camera_board_detector"}};
  for (const auto& [channel, module] : kModules) {
    const std::string beginning = channel + ": ";
    if (counter.name.compare(0, beginning.size(), beginning) != 0) continue;
    const std::string reason = counter.name.substr(beginning.size());
    return {{"module", module},
            {"reason", reason},
            {"num_times", counter.count},
            {"advice", AdviceOn(module, reason)}};
  }
  return {{"module", "sample_collector"},
          {"reason", counter.name},
          {"num_times", counter.count},
          {"advice", AdviceOn("sample_collector", counter.name)}};
}

/// What is no miss, and what the detectors' own counts say already.
bool IsToldElsewhere(const std::string& counted) {
  for (const char* beginning :
       {"accepted", "sweeps between", "images between", "camera: ", "lidar: "}) {
    if (counted.rfind(beginning, 0) == 0) return true;
  }
  return false;
}

Json Counts(std::vector<counter_t> counters) {
  std::stable_sort(counters.begin(), counters.end(), [](const auto& a, const auto& b) {
    return a.count > b.count;
  });
  Json counts = Json::array();
  for (const counter_t& counter : counters) {
    if (!IsToldElsewhere(counter.name)) counts.push_back(PartOf(counter));
  }
  return counts;
}

Json Misses(const SessionMisses& misses, const Rig& rig, Pictures* pictures) {
  Json parts = Json::array();
  const auto add = [&parts](const auto& make) {
    try {
      parts.push_back(make());
    } catch (const std::exception&) {  // an image that is none: its reason says so in the table
    }
  };
  for (const ImageMiss& miss : misses.images) add([&] { return PartOf(miss, rig, pictures); });
  for (const SweepMiss& miss : misses.sweeps) add([&] { return PartOf(miss, pictures); });
  return parts;
}

Json Samples(const Rig& rig,
             const std::vector<BoardSample>& samples,
             const std::filesystem::path& session,
             Pictures* pictures) {
  Json parts = Json::array();
  if (samples.empty()) return parts;
  SessionSceneReader reader(session / kSamplesLogName);
  while (const std::optional<SessionScene> scene = reader.Next()) {
    for (const BoardSample& sample : samples) {
      if (sample.id != scene->sample_id) continue;
      const PointCloud sweep_lidar_m = FromMessage(scene->sweep);
      const BoardPose& board_lidar = sample.lidar.pose;
      const cv::Mat image = DrawImage(FromMessage(scene->image), sample.camera.pose, rig.camera);
      parts.push_back({{"id", sample.id},
                       {"files",
                        {pictures->Write(image),
                         pictures->Write(DrawSweepNear(sweep_lidar_m, board_lidar)),
                         pictures->Write(DrawSweep(sweep_lidar_m, board_lidar))}}});
    }
  }
  return parts;
}

}  // namespace

std::string WriteNoResult(const Rig& rig,
                          const std::string& problem,
                          const std::vector<BoardSample>& samples,
                          const std::filesystem::path& session,
                          const std::filesystem::path& folder) try {
  std::filesystem::create_directories(folder);
  const ScratchFolder scratch(folder / "seen");
  Pictures pictures(scratch.path());
  const SessionMisses misses = ReadMisses(session);
  const std::string trouble =
      misses.trouble.empty() || problem.find(misses.trouble) != std::string::npos
          ? ""
          : "\n" + misses.trouble;
  const std::filesystem::path log = session / kSamplesLogName;
  const std::string log_sha256 = std::filesystem::exists(log) ? Sha256OfFile(log) : "";
  const Json json = {{"rig", rig.name},
                     {"problem", problem + trouble},
                     {"num_samples", samples.size()},
                     {"counts", Counts(misses.counts)},
                     {"misses", Misses(misses, rig, &pictures)},
                     {"samples", Samples(rig, samples, session, &pictures)},
                     {"log_sha256", log_sha256}};
  const std::filesystem::path file = scratch.path() / "no_result.json";
  WriteFileAtomically(file, json.dump(1, ' ', false, Json::error_handler_t::replace));
  return RunProgram({ScriptOfTools("report/make_report.py"),
                     "--no-result",
                     file,
                     scratch.path(),
                     folder / kNoResultName});
} catch (const std::exception& error) {  // there is a failure to tell already
  return error.what();
}

}  // namespace voqcal
