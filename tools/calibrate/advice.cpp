#include "calibrate/advice.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/camera_detection/camera_board_fault.hpp"
#include "core/format.hpp"
#include "core/lidar_detection/lidar_board_miss.hpp"
#include "core/starts_with.hpp"

namespace voqcal {
namespace {

/// A reason that is none of a bad view now and then, if nearly all have it.
constexpr double kNearlyAll = 0.8;

const char* TextOn(CameraBoardFault fault) {
  switch (fault) {
    case CameraBoardFault::kNoBoard:
      return "do the images show the board? Then check board.pattern, board.num_corners_x and "
             "num_corners_y";
    case CameraBoardFault::kPartlyHidden:
      return "check board.num_corners_x and num_corners_y: the inner corners, along width_m and "
             "height_m";
    case CameraBoardFault::kNoPose:
      return "check camera.lens_model, fx_px, fy_px, cx_px, cy_px and distortion; calibrate_lens "
             "finds them from these images";
    case CameraBoardFault::kPoorFit:
      return "check camera.lens_model, fx_px, fy_px, cx_px, cy_px and distortion (calibrate_lens "
             "finds them from these images); is the board flat?";
    case CameraBoardFault::kBlurred:
      return "focus the lens, shorten the exposure, and let the board rest at each place";
    case CameraBoardFault::kGlare:
      return "lower the exposure, or turn the board from the light";
    case CameraBoardFault::kCutOff:
      return "hold the board wholly within the image";
    case CameraBoardFault::kTooSmall:
    case CameraBoardFault::kAmbiguous:
      return "";  // warnings of boards that were found
  }
  return "";
}

const char* TextOn(LidarBoardMiss miss) {
  switch (miss) {
    case LidarBoardMiss::kTooFewPoints:
      return "check lidar_board_detector.min_range_m and max_range_m: nearly no return lies "
             "between, or the clouds are in millimetres";
    case LidarBoardMiss::kNoPlane:
      return "check board.width_m and height_m; hold the board nearer, away from walls and people";
    case LidarBoardMiss::kSizeMismatch:
      return "check board.width_m and height_m";
    case LidarBoardMiss::kFlat:
      return "turn the board's face more towards the lidar";
    case LidarBoardMiss::kJoined:
      return "hold the board free, off the ground and away from what it touches; check "
             "board.width_m and height_m";
    case LidarBoardMiss::kCutOff:
    case LidarBoardMiss::kHidden:
      return "hold the board where the lidar sees all of it; check board.width_m and height_m";
    case LidarBoardMiss::kGap:
      return "hold the board nearer, where more beams meet it; check board.width_m and height_m";
    case LidarBoardMiss::kLoose:
      return "hold the board nearer, as a diamond";
    case LidarBoardMiss::kBent:
      return "flatten the board, or check lidar_board_detector.max_bend_m";
    case LidarBoardMiss::kAmbiguous:
      return "take away what looks like the board: the same size, at rest";
  }
  return "";
}

/// A detail may stand behind the reason: "joined to something below".
/// @tparam Fault  kAmbiguous is its last.
template <typename Fault>
std::string AdviceOnCounted(const std::string& reason) {
  for (int i = 0; i <= static_cast<int>(Fault::kAmbiguous); ++i) {
    const auto fault = static_cast<Fault>(i);
    if (reason == ToString(fault) || StartsWith(reason, std::string(ToString(fault)) + " ")) {
      return TextOn(fault);
    }
  }
  return {};
}

// "boards: blurred" warns of boards that were found.
bool IsOfAFrame(const std::string& what) { return !StartsWith(what, "boards: "); }

/// Reasons of one module that have one advice.
struct Failures {
  std::string advice;
  std::string reasons;  ///< "no board" in quotation marks, with commas between.
  std::int64_t num_times = 0;
};

std::vector<Failures> FailuresOf(const Module& module) {
  std::vector<Failures> all;
  for (const auto& [what, count] : module.counters()) {
    const std::string advice = AdviceOn(module.Name(), what);
    if (advice.empty()) continue;
    auto same = std::find_if(
        all.begin(), all.end(), [&advice](const Failures& each) { return each.advice == advice; });
    if (same == all.end()) same = all.insert(all.end(), {advice, "", 0});
    same->reasons += (same->reasons.empty() ? "\"" : ", \"") + what + "\"";
    same->num_times += count;
  }
  return all;
}

}  // namespace

std::string AdviceOn(const std::string& module, const std::string& reason) {
  if (module == "camera_board_detector") {
    if (StartsWith(reason, "image of ")) return "check camera.width_px and height_px";
    return AdviceOnCounted<CameraBoardFault>(reason);
  }
  if (module == "lidar_board_detector") return AdviceOnCounted<LidarBoardMiss>(reason);
  if (module == "sample_collector") {
    if (reason == "sweeps between two images") {
      return "do both sensors take their time from one clock? Their frames are further apart than "
             "sample_collector.max_pair_offset_s";
    }
    if (reason == "board is moving") {
      return "let the board rest a second at each place; one frame a place needs "
             "sample_collector.num_still_frames: 1";
    }
  }
  return {};
}

std::string FailureAdvice(const OfflineRun& run) {
  std::string lines;
  const std::string trouble = "trouble: ";
  for (const Module* module : run.modules()) {
    if (StartsWith(module->State(), trouble)) {
      return "\n" + module->Name() + ": " + module->State().substr(trouble.size());
    }
    std::int64_t num_all = 0;
    for (const auto& [what, count] : module->counters()) num_all += IsOfAFrame(what) ? count : 0;
    for (const Failures& failures : FailuresOf(*module)) {
      const auto num_times = static_cast<double>(failures.num_times);
      if (num_times < kNearlyAll * static_cast<double>(num_all)) continue;
      lines += Format("\n%s: %s %lld times of %lld: %s",
                      module->Name().c_str(),
                      failures.reasons.c_str(),
                      static_cast<long long>(failures.num_times),
                      static_cast<long long>(num_all),
                      failures.advice.c_str());
    }
  }
  return lines;
}

}  // namespace voqcal
