// voqcal_load: all drivers of a rig, and a watch on what the modules make of it.
//
// Sends sweeps and images at the rig's rates, a thread each, as the drivers do, each stamped with
// the time at which it is sent; hears the detectors' answers and every module's status; reads the
// modules' memory. Losses and latencies are printed at the end.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/load_report.hpp"
#include "common/tool_main.hpp"
#include "core/simulation/rig_simulation.hpp"
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

/// One sensor of the rig, and what it sees at each stop of the board. Sent again and again, so that
/// the sender's cost is a driver's and not the simulator's.
struct Sender {
  std::string name;
  bool is_lidar = true;
  std::string channel;
  std::string board_channel;  ///< Of its detector's answers.
  double rate_hz = 0.0;
  int jpeg_quality = 0;
  std::vector<PointCloud> sweeps;
  std::vector<std::vector<std::uint8_t>> jpegs;
};

/// The middle of each time for which the board rests.
std::vector<double> StopsS(const SimulationOptions& options) {
  std::vector<double> stops_s;
  for (int i = 0; i < options.num_poses; ++i) {
    stops_s.push_back(i * (options.hold_s + options.move_s) + options.hold_s / 2);
  }
  return stops_s;
}

Sender LidarOf(const Rig& rig) {
  Sender sender;
  sender.name = rig.lidar_name;
  sender.channel = rig.channels.lidar_points;
  sender.board_channel = rig.channels.lidar_board;
  sender.rate_hz = rig.lidar_driver.rate_hz;
  return sender;
}

Sender CameraOf(const Rig& rig) {
  Sender sender;
  sender.name = rig.camera_name;
  sender.is_lidar = false;
  sender.channel = rig.channels.camera_image;
  sender.board_channel = rig.channels.camera_board;
  sender.rate_hz = rig.camera_driver.rate_hz;
  sender.jpeg_quality = rig.camera_driver.jpeg_quality;
  return sender;
}

/// What a pair of sensors sees.
void FillFrames(const Rig& rig, std::vector<Sender>* senders) {
  const Simulation simulation(rig.simulation, rig.board, rig.camera);
  for (const double time_s : StopsS(rig.simulation)) {
    senders->at(0).sweeps.push_back(simulation.Sweep(time_s));
    senders->at(1).jpegs.push_back(
        EncodeJpeg(simulation.Image(time_s), senders->at(1).jpeg_quality));
  }
}

/// What several sensors see of one world.
void FillFramesOfRig(const Rig& rig, std::vector<Sender>* senders) {
  RigSimulation simulation(rig.simulated_rig, rig.board);
  for (Sender& sender : *senders) {
    for (const double time_s : StopsS(rig.simulated_rig.world)) {
      if (sender.is_lidar) {
        const std::size_t lidar = IndexOfName(rig.simulated_rig.lidars, sender.name);
        sender.sweeps.push_back(simulation.Sweep(lidar, time_s));
      } else {
        const std::size_t camera = IndexOfName(rig.simulated_rig.cameras, sender.name);
        sender.jpegs.push_back(EncodeJpeg(simulation.Image(camera, time_s), sender.jpeg_quality));
      }
    }
  }
}

/// One for each of the rig's sensors.
std::vector<Sender> SendersOf(const std::vector<Rig>& pairs, double rate_share) {
  std::vector<Sender> senders;
  std::set<std::string> names;
  for (const Rig& rig : pairs) {
    if (names.insert(rig.lidar_name).second) senders.push_back(LidarOf(rig));
  }
  for (const Rig& rig : pairs) {
    if (names.insert(rig.camera_name).second) senders.push_back(CameraOf(rig));
  }
  for (Sender& sender : senders) sender.rate_hz *= rate_share;
  if (pairs.front().simulated_rig.lidars.empty()) {
    FillFrames(pairs.front(), &senders);
  } else {
    FillFramesOfRig(pairs.front(), &senders);
  }
  return senders;
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

void Send(const Sender& sender,
          const std::string& lcm_url,
          const std::atomic<bool>& is_done,
          SensorLoad* load) {
  Bus bus(lcm_url);
  SendAt(sender.rate_hz, is_done, [&](std::int64_t n) {
    const std::size_t num_stops = std::max(sender.sweeps.size(), sender.jpegs.size());
    const std::size_t stop = StopOf(n, sender.rate_hz, num_stops);
    if (sender.is_lidar) {
      bus.Publish(sender.channel,
                  ToMessage(sender.sweeps[stop], WallClockUs(), static_cast<std::int32_t>(n)));
    } else {
      bus.Publish(sender.channel, EncodedToMessage(sender.jpegs[stop], WallClockUs(), n));
    }
    load->num_sent = n + 1;
  });
}

template <typename Message>
void HearAnswers(const std::string& channel, Bus* bus, SensorLoad* load) {
  bus->Subscribe<Message>(channel, Queue::kEvery, [load](const Message& message) {
    load->Answer(message.utime, WallClockUs());
  });
}

void Run(const LoadArgs& args) {
  const std::vector<Rig> pairs = LoadPairs(args.rig);
  const std::string& lcm_url = pairs.front().lcm_url;
  const std::vector<Sender> senders = SendersOf(pairs, args.rate_share);
  LoadReport report(args.watched);
  Bus bus(lcm_url);
  bus.Subscribe<module_status_t>(pairs.front().channels.module_status,
                                 Queue::kEvery,
                                 [&](const module_status_t& message) { report.Take(message); });
  std::atomic<bool> is_done{false};
  std::vector<std::thread> threads;
  for (const Sender& sender : senders) {
    SensorLoad* load = report.AddSensor(sender.name);
    if (sender.is_lidar) {
      HearAnswers<lidar_board_t>(sender.board_channel, &bus, load);
    } else {
      HearAnswers<camera_board_t>(sender.board_channel, &bus, load);
    }
    threads.emplace_back([&, load] { Send(sender, lcm_url, is_done, load); });
  }
  using Clock = std::chrono::steady_clock;
  const auto run = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(60.0 * args.minutes));
  const Clock::time_point end = Clock::now() + run;
  // Afterwards: two seconds for the modules' last statuses, longer for answers that are still to
  // come.
  const auto is_heard_out = [&](Clock::time_point now) {
    return now > end + std::chrono::seconds(report.NumUnanswered() == 0 ? 2 : 20);
  };
  for (auto now = Clock::now(); !is_heard_out(now); now = Clock::now()) {
    is_done = now >= end;
    bus.HandleOnce(std::chrono::milliseconds(100));
    report.ReadMemoryIfDue();
  }
  for (std::thread& thread : threads) thread.join();
  std::fputs(report.Text().c_str(), stdout);
  if (report.NumLost() > 0) throw std::runtime_error("messages were lost");
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Sends what the sensors of a rig would, and tells losses, latencies and memory.",
               "voqcal_load");
  voqcal::LoadArgs args;
  app.add_option("--rig", args.rig, "The rig file")->required();
  app.add_option("--minutes", args.minutes, "How long to send");
  app.add_option("--rate-share", args.rate_share, "Of the rig's rates: 0.5 is half as many");
  app.add_option("--watch", args.watched, "NAME=PID of each module whose memory is read");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Run(args); });
}
