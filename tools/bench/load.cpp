// voqcal_load: both drivers of a heavy rig, and a watch on what the modules make of it.
//
// Sends sweeps and images at the rig's rates from two threads, as the drivers do, each stamped with
// the time at which it is sent; hears the detectors' answers and every module's status; reads the
// modules' memory. Losses and latencies are printed at the end.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bench/load_report.hpp"
#include "common/tool_main.hpp"
#include "core/simulation/simulation.hpp"
#include "images/jpeg.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/pacer.hpp"
#include "messaging/wall_clock.hpp"
#include "rig/rig.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {
namespace {

struct LoadArgs {
  std::string rig;
  double minutes = 10.0;
  double rate_share = 1.0;           ///< Of the rig's rates.
  std::vector<std::string> watched;  ///< NAME=PID
};

/// What the sensors see at each stop of the board. Sent again and again, so that the sender's cost
/// is a driver's and not the simulator's.
struct Stops {
  std::vector<PointCloud> sweeps;
  std::vector<std::vector<std::uint8_t>> jpegs;
};

Stops Simulate(const Rig& rig) {
  const Simulation simulation(rig.simulation, rig.board, rig.camera);
  Stops stops;
  for (int i = 0; i < rig.simulation.num_poses; ++i) {
    const double time_s =
        i * (rig.simulation.hold_s + rig.simulation.move_s) + rig.simulation.hold_s / 2;
    stops.sweeps.push_back(simulation.Sweep(time_s));
    stops.jpegs.push_back(EncodeJpeg(simulation.Image(time_s), rig.camera_driver.jpeg_quality));
  }
  return stops;
}

/// Calls send(n) for n = 0, 1, ... at `rate_hz` until `is_done`.
template <typename Send>
void SendAt(double rate_hz, const std::atomic<bool>& is_done, const Send& send) {
  Pacer pacer(rate_hz);
  for (std::int64_t n = 0; !is_done; ++n) {
    std::this_thread::sleep_until(pacer.Next());
    send(n);
    pacer.Advance();
  }
}

/// The stop at frame n: each for a second.
std::size_t StopOf(std::int64_t n, double rate_hz, std::size_t num_stops) {
  return static_cast<std::size_t>(static_cast<double>(n) / rate_hz) % num_stops;
}

void SendSweeps(const Rig& rig, const Stops& stops, std::atomic<bool>* is_done, SensorLoad* load) {
  Bus bus(rig.lcm_url);
  SendAt(rig.lidar_driver.rate_hz, *is_done, [&](std::int64_t n) {
    const std::size_t stop = StopOf(n, rig.lidar_driver.rate_hz, stops.sweeps.size());
    bus.Publish(rig.channels.lidar_points,
                ToMessage(stops.sweeps[stop], WallClockUs(), static_cast<std::int32_t>(n)));
    load->num_sent = n + 1;
  });
}

void SendImages(const Rig& rig, const Stops& stops, std::atomic<bool>* is_done, SensorLoad* load) {
  Bus bus(rig.lcm_url);
  SendAt(rig.camera_driver.rate_hz, *is_done, [&](std::int64_t n) {
    const std::size_t stop = StopOf(n, rig.camera_driver.rate_hz, stops.jpegs.size());
    bus.Publish(rig.channels.camera_image, EncodedToMessage(stops.jpegs[stop], WallClockUs(), n));
    load->num_sent = n + 1;
  });
}

void Run(const LoadArgs& args) {
  Rig rig = LoadRig(args.rig);
  rig.lidar_driver.rate_hz *= args.rate_share;
  rig.camera_driver.rate_hz *= args.rate_share;
  const Stops stops = Simulate(rig);
  LoadReport report(args.watched);
  Bus bus(rig.lcm_url);
  bus.Subscribe<lidar_board_t>(
      rig.channels.lidar_board, Queue::kEvery, [&report](const lidar_board_t& message) {
        report.lidar.Answer(message.utime, WallClockUs());
      });
  bus.Subscribe<camera_board_t>(
      rig.channels.camera_board, Queue::kEvery, [&report](const camera_board_t& message) {
        report.camera.Answer(message.utime, WallClockUs());
      });
  bus.Subscribe<module_status_t>(
      rig.channels.module_status, Queue::kEvery, [&report](const module_status_t& message) {
        report.Take(message);
      });
  std::atomic<bool> is_done{false};
  std::thread lidar(SendSweeps, std::cref(rig), std::cref(stops), &is_done, &report.lidar);
  std::thread camera(SendImages, std::cref(rig), std::cref(stops), &is_done, &report.camera);
  using Clock = std::chrono::steady_clock;
  const auto run = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(60.0 * args.minutes));
  const Clock::time_point end = Clock::now() + run;
  // Afterwards: two seconds for the modules' last statuses, longer for answers that are still to
  // come.
  const auto is_heard_out = [&](Clock::time_point now) {
    const bool is_answered = report.lidar.NumUnanswered() + report.camera.NumUnanswered() == 0;
    return now > end + std::chrono::seconds(is_answered ? 2 : 20);
  };
  for (auto now = Clock::now(); !is_heard_out(now); now = Clock::now()) {
    is_done = now >= end;
    bus.HandleOnce(std::chrono::milliseconds(100));
    report.ReadMemoryIfDue();
  }
  lidar.join();
  camera.join();
  std::fputs(report.Text().c_str(), stdout);
  if (report.NumLost() > 0) throw std::runtime_error("messages were lost");
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Sends what two heavy sensors would, and tells losses, latencies and memory.",
               "voqcal_load");
  voqcal::LoadArgs args;
  app.add_option("--rig", args.rig, "The rig file")->required();
  app.add_option("--minutes", args.minutes, "How long to send");
  app.add_option("--rate-share", args.rate_share, "Of the rig's rates: 0.5 is half as many");
  app.add_option("--watch", args.watched, "NAME=PID of each module whose memory is read");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Run(args); });
}
