#include "calibrate/plate_of_recording.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/progress.hpp"
#include "common/scratch_folder.hpp"
#include "core/format.hpp"
#include "core/lidar_detection/plate_size.hpp"
#include "core/selection/extrinsic_vote.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/log.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kNumSweeps = 40;  // the time grows with it, and the places hardly

template <typename Visit>
void VisitSweeps(const std::filesystem::path& log, const std::string& channel, Visit visit) {
  LogReader reader(log);
  try {
    while (const std::optional<LogEvent> event = reader.Next()) {
      if (event->channel == channel) visit(*event);
    }
  } catch (const TruncatedLogError&) {  // told by whoever collects the samples
  }
}

/// Spread over the recording; unreadable ones are left out.
std::vector<PointCloud> SomeSweeps(const std::filesystem::path& log, const std::string& channel) {
  std::size_t num = 0;
  VisitSweeps(log, channel, [&num](const LogEvent&) { ++num; });
  const std::size_t step = 1 + num / kNumSweeps;
  std::vector<PointCloud> sweeps;
  std::size_t i = 0;
  VisitSweeps(log, channel, [&](const LogEvent& event) {
    if (i++ % step != step / 2) return;
    pointcloud2_t message{};
    if (!DecodeMessage(event.bytes.data(), event.bytes.size(), &message).empty()) return;
    try {
      sweeps.push_back(FromMessage(message));
    } catch (const std::runtime_error&) {  // counted by the detector
    }
  });
  return sweeps;
}

/// How many samples agree on an extrinsic if the plate is that.
int NumAgreeing(Rig rig,
                double width_m,
                double height_m,
                const InputPaths& input,
                const std::filesystem::path& scratch) {
  rig.board.width_m = width_m;
  rig.board.height_m = height_m;
  if (!rig.board.Problems().empty()) return -1;
  const auto run = CollectSamples(rig, input, scratch);
  run->Finish(/*is_collecting_only=*/true);
  const auto rough = VoteForExtrinsic(run->samples(), run->samples().size(), rig.camera);
  return rough ? rough->num_agreeing : 0;
}

/// Width and height: what the samples agree on or, where they tell nothing, as the pattern is long.
std::pair<double, double> WidthAndHeight(const PlateSize& size,
                                         const Rig& rig,
                                         const InputPaths& input,
                                         const std::filesystem::path& scratch) {
  const std::pair<double, double> wide = {size.longer_m, size.shorter_m};
  const std::pair<double, double> high = {size.shorter_m, size.longer_m};
  const ScratchFolder as_wide(scratch / "wide");
  const ScratchFolder as_high(scratch / "high");
  const int num_wide = NumAgreeing(rig, wide.first, wide.second, input, as_wide.path());
  const int num_high = NumAgreeing(rig, high.first, high.second, input, as_high.path());
  if (num_wide != num_high) return num_wide > num_high ? wide : high;
  const Eigen::Vector2d pattern_m = rig.board.LeastPlateM();
  return pattern_m.x() > pattern_m.y() ? wide : high;
}

double ToMillimetre(double length_m) { return std::round(length_m * 1e3) / 1e3; }

}  // namespace

void MeasurePlate(const InputPaths& input, const std::filesystem::path& scratch, Rig* rig) {
  const std::string missing =
      rig->path.string() + ": board.width_m and board.height_m are missing, and ";
  if (!input.log || IsSamplesLog(*rig, *input.log)) {
    throw std::runtime_error(
        missing + input.Given().string() +
        " has no sweeps to measure the plate in: write them into the rig file");
  }
  std::optional<PlateSize> size;
  {
    Progress progress("measuring the plate");
    size = MeasurePlateSize(SomeSweeps(*input.log, rig->channels.lidar_points),
                            rig->board,
                            rig->lidar_board_detector,
                            [&progress](double share) { progress.Show(share, ""); });
  }
  if (!size) {
    throw std::runtime_error(missing + "in " + input.log->string() +
                             " no plate that its pattern fits on is seen whole at three places: "
                             "measure it with a ruler and write them into the rig file");
  }
  const auto [width_m, height_m] = WidthAndHeight(*size, *rig, input, scratch);
  rig->board.width_m = ToMillimetre(width_m);
  rig->board.height_m = ToMillimetre(height_m);
  spdlog::warn("{}",
               Format("%s leaves the plate's size out: width_m: %.3f, height_m: %.3f (+- %.0f mm), "
                      "measured at %d places. Live programs need both in the rig file, under board",
                      rig->path.c_str(),
                      rig->board.width_m,
                      rig->board.height_m,
                      std::max(1.0, std::ceil(1e3 * size->sigma_m)),
                      size->num_places));
}

}  // namespace voqcal
