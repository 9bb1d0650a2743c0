#include "calibrate/advice.hpp"

#include <array>
#include <cstdint>

#include "core/format.hpp"

namespace voqcal {
namespace {

/// A reason that is none of a bad view now and then, if nearly all have it.
constexpr double kNearlyAll = 0.8;

struct Advice {
  const char* module;
  const char* reason;  ///< As the module counts it, or how that begins.
  const char* text;
};

constexpr std::array<Advice, 17> kAdvice = {{
    {"camera_board_detector",
     "no board",
     "do the images show the board? Then check board.pattern, board.num_corners_x and "
     "num_corners_y"},
    {"camera_board_detector",
     "partly hidden",
     "check board.num_corners_x and num_corners_y: the inner corners, along width_m and height_m"},
    {"camera_board_detector",
     "no pose",
     "check camera.lens_model, fx_px, fy_px, cx_px, cy_px and distortion"},
    {"camera_board_detector",
     "poor fit",
     "check camera.lens_model, fx_px, fy_px, cx_px, cy_px and distortion; is the board flat?"},
    {"camera_board_detector",
     "blurred",
     "focus the lens, shorten the exposure, and let the board rest at each place"},
    {"camera_board_detector", "glare", "lower the exposure, or turn the board from the light"},
    {"camera_board_detector", "cut off", "hold the board wholly within the image"},
    {"camera_board_detector", "image of ", "check camera.width_px and height_px"},
    {"lidar_board_detector",
     "too few points",
     "check lidar_board_detector.min_range_m and max_range_m: nearly no return lies between"},
    {"lidar_board_detector",
     "no plane of the board's size",
     "check board.width_m and height_m; hold the board nearer, away from walls and people"},
    {"lidar_board_detector", "size mismatch", "check board.width_m and height_m"},
    {"lidar_board_detector",
     "seen at too flat an angle",
     "turn the board's face more towards the lidar"},
    {"lidar_board_detector",
     "outline open",
     "hold the board where the lidar sees all of it; check board.width_m and height_m"},
    {"lidar_board_detector",
     "too few beams tell its outline",
     "hold the board nearer, as a diamond"},
    {"lidar_board_detector",
     "board bent",
     "flatten the board, or check lidar_board_detector.max_bend_m"},
    {"sample_collector",
     "no camera frame at that time",
     "do both sensors take their time from one clock?"},
    {"sample_collector", "board is moving", "let the board rest a second at each place"},
}};

bool BeginsWith(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

// "boards: blurred" warns of boards that were found.
bool IsOfAFrame(const std::string& what) { return !BeginsWith(what, "boards: "); }

}  // namespace

std::string FailureAdvice(const OfflineRun& run) {
  std::string lines;
  for (const Module* module : run.modules()) {
    std::int64_t num_all = 0;
    for (const auto& [what, count] : module->counters()) num_all += IsOfAFrame(what) ? count : 0;
    for (const Advice& advice : kAdvice) {
      if (module->Name() != advice.module) continue;
      std::int64_t num_so = 0;
      for (const auto& [what, count] : module->counters()) {
        num_so += BeginsWith(what, advice.reason) ? count : 0;
      }
      if (num_so == 0 || static_cast<double>(num_so) < kNearlyAll * static_cast<double>(num_all)) {
        continue;
      }
      lines += Format("\n%s: \"%s\" %lld times of %lld: ",
                      advice.module,
                      advice.reason,
                      static_cast<long long>(num_so),
                      static_cast<long long>(num_all)) +
               advice.text;
    }
  }
  return lines;
}

}  // namespace voqcal
