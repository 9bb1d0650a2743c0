// A rig of many sensors: how far each pair is from the truth, alone and joined with the others, and
// how honest the covariances are.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/calibration/calibrate.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/least_samples.hpp"
#include "core/median.hpp"
#include "core/sensor_network/common_boards.hpp"
#include "core/sensor_network/sensor_network.hpp"
#include "core/units.hpp"
#include "figures/figures.hpp"
#include "figures/simulated_rig_session.hpp"
#include "support/rig_of_five.hpp"

namespace voqcal {
namespace {

struct RigArgs {
  std::filesystem::path rig;
  int num_seeds = 50;
  int num_poses = 60;
  std::uint32_t first_seed = 1;
  std::string method = "automatic";
};

using PairName = std::pair<std::string, std::string>;  // from, to

// Errors of one pair over the seeds, and how many of its numbers were in their 95 % interval.
struct Tally {
  std::vector<double> rotations_deg;
  std::vector<double> translations_mm;
  int num_inside = 0;

  void Take(const SensorPair& pair, const Eigen::Isometry3d& T_truth) {
    constexpr double kSigmas95 = 1.959964;
    const Vector6d error = DifferenceLeft(T_truth, pair.T_to_from);
    Take(error);
    for (int i = 0; i < 6; ++i) {
      num_inside += std::abs(error[i]) < kSigmas95 * std::sqrt(pair.covariance(i, i)) ? 1 : 0;
    }
  }

  void Take(const Vector6d& difference) {
    rotations_deg.push_back(kDegPerRad * difference.head<3>().norm());
    translations_mm.push_back(1e3 * difference.tail<3>().norm());
  }

  std::string Text() const {
    if (rotations_deg.empty()) return "      -";
    const auto worst = [](const std::vector<double>& values) {
      return *std::max_element(values.begin(), values.end());
    };
    return Format("%6.3f %5.2f  %6.3f %5.2f",
                  Median(rotations_deg),
                  Median(translations_mm),
                  worst(rotations_deg),
                  worst(translations_mm));
  }

  std::string Inside() const {
    if (rotations_deg.empty()) return "    -";
    return Format("%5.1f", 100.0 * num_inside / (6.0 * static_cast<double>(rotations_deg.size())));
  }
};

struct PairTallies {
  Tally alone;
  Tally joined;
};

struct RigTallies {
  std::map<PairName, PairTallies> pairs;
  Tally closure;
  int num_doubtful = 0;
  int num_failed = 0;
};

// Calibrate's extrinsic, or why there is none; its assessment takes most of the time.
BestExtrinsic Refined(const std::vector<BoardSample>& samples, const CalibrationTask& task) {
  const auto failed = [](const std::string& problem) {
    BestExtrinsic none;
    none.problem = problem;
    return none;
  };
  const ChosenSamples chosen = ChooseSamples(samples, task.camera, task.options.consistency);
  const ChosenSets sets = ChooseSets(chosen, task);
  if (!sets.problem.empty()) return failed(sets.problem);
  const std::vector<const BoardSample*> used = chosen.Used();
  const AveragedSets averaged = AverageSets(used, sets.sets, task);
  if (!averaged.problem.empty()) return failed(averaged.problem);
  return RefineBest(used, task.board, task.camera, averaged.average, {}, task.options.refinement);
}

class RigRun {
 public:
  RigRun(const RigArgs& args, std::uint32_t seed)
      : rig_(LoadRig(args.rig)), simulation_(test::RigOfFive()) {
    SimulationOptions& world = simulation_.world;
    world.seed = seed;
    world.num_poses = args.num_poses;
    world.common_bias_m = 0.02;  // as FaultySimulation
    world.dark_bias_m = 0.0075;
    world.ring_bias_m = 0.008;
    rig_.extrinsic_refiner.method = RefineMethodFromString(args.method);  // automatic: none
    session_ = SimulateRigSession(simulation_, rig_);
  }

  // The published method on each lidar and camera that have samples enough, what fails is said; and
  // cameras that share boards.
  std::vector<SensorPair> CalibratePairs() const {
    std::vector<SensorPair> pairs;
    for (std::size_t l = 0; l < simulation_.lidars.size(); ++l) {
      for (std::size_t c = 0; c < simulation_.cameras.size(); ++c) {
        const auto samples = session_.Samples(l, c);
        if (samples.size() < kLeastSamples) continue;
        CalibrationTask task = rig_.Task();
        task.camera = simulation_.cameras[c].model;
        const BestExtrinsic refined = Refined(samples, task);
        const std::string& lidar = simulation_.lidars[l].name;
        const std::string& camera = simulation_.cameras[c].name;
        if (!refined.problem.empty()) {
          std::printf("seed %u, %s - %s: %s\n",
                      simulation_.world.seed,
                      lidar.c_str(),
                      camera.c_str(),
                      refined.problem.c_str());
          continue;
        }
        pairs.push_back({lidar, camera, refined.T_camera_lidar, refined.covariance_given_rig});
      }
    }
    for (std::size_t a = 0; a < simulation_.cameras.size(); ++a) {
      for (std::size_t b = a + 1; b < simulation_.cameras.size(); ++b) {
        const SimulatedCamera& to = simulation_.cameras[b];
        const auto pair = PairOfCameras(
            simulation_.cameras[a].name, to.name, session_.CommonBoards(a, b), to.model);
        if (pair) pairs.push_back(*pair);
      }
    }
    return pairs;
  }

  std::vector<std::string> Sensors() const {
    std::vector<std::string> names;
    for (const SimulatedLidar& lidar : simulation_.lidars) names.push_back(lidar.name);
    for (const SimulatedCamera& camera : simulation_.cameras) names.push_back(camera.name);
    return names;
  }

  Eigen::Isometry3d Truth(const PairName& pair) const {
    return T_rig(pair.second).inverse() * T_rig(pair.first);
  }

 private:
  Eigen::Isometry3d T_rig(const std::string& sensor) const {
    for (const SimulatedLidar& lidar : simulation_.lidars) {
      if (lidar.name == sensor) return lidar.T_rig_lidar;
    }
    for (const SimulatedCamera& camera : simulation_.cameras) {
      if (camera.name == sensor) return camera.T_camera_rig.inverse();
    }
    throw std::logic_error(sensor);
  }

  Rig rig_;
  RigSimulationOptions simulation_;
  RigSession session_;
};

void TakeRun(const RigRun& run, RigTallies* tallies) {
  const std::vector<SensorPair> pairs = run.CalibratePairs();
  const std::vector<std::string> sensors = run.Sensors();
  const SensorNetwork network = JoinPairs(sensors, sensors.front(), pairs);
  if (!network.IsUsable()) {
    std::puts(network.problem.c_str());
    ++tallies->num_failed;
    return;
  }
  if (!network.warning.empty()) {
    std::puts(network.warning.c_str());
    ++tallies->num_doubtful;
  }
  for (const SensorPair& pair : pairs) {
    const PairName name(pair.from, pair.to);
    tallies->pairs[name].alone.Take(pair, run.Truth(name));
  }
  for (std::size_t a = 0; a < sensors.size(); ++a) {
    for (std::size_t b = a + 1; b < sensors.size(); ++b) {
      const PairName name(sensors[a], sensors[b]);
      tallies->pairs[name].joined.Take(network.Between(name.first, name.second), run.Truth(name));
    }
  }
  for (const PairClosure& closure : network.closures) tallies->closure.Take(closure.difference);
}

void PrintRig(const RigArgs& args) {
  RigTallies tallies;
  for (int i = 0; i < args.num_seeds; ++i) {
    TakeRun(RigRun(args, args.first_seed + static_cast<std::uint32_t>(i)), &tallies);
  }
  std::printf(
      "%d sessions of %d poses, pairs by the method \"%s\"; asked: median 0.03 deg, 2 mm; "
      "inside 93 to 97 %%; closure 0.03 deg, 2 mm\n",
      args.num_seeds,
      args.num_poses,
      args.method.c_str());
  std::puts(
      "                   alone: median    worst           in 95 %  joined: median   worst"
      "           in 95 %");
  int num_inside = 0;
  std::size_t num_numbers = 0;
  for (const auto& [name, pair] : tallies.pairs) {
    std::printf("%-18s %-30s %5s  %-30s %5s\n",
                (name.first + " - " + name.second).c_str(),
                pair.alone.Text().c_str(),
                pair.alone.Inside().c_str(),
                pair.joined.Text().c_str(),
                pair.joined.Inside().c_str());
    num_inside += pair.joined.num_inside;
    num_numbers += 6 * pair.joined.rotations_deg.size();
  }
  std::printf("closure            %s  (deg, mm), a pair in a loop against the others\n",
              tallies.closure.Text().c_str());
  std::printf("all joined pairs: %.1f %% inside; %d sessions with a pair in doubt, %d not joined\n",
              100.0 * num_inside / static_cast<double>(num_numbers),
              tallies.num_doubtful,
              tallies.num_failed);
}

}  // namespace

void AddRig(CLI::App* app) {
  CLI::App* figure = app->add_subcommand(
      "rig", "Error and coverage of the pairs of a rig of five sensors, alone and joined");
  auto args = std::make_shared<RigArgs>();
  figure->add_option("--rig", args->rig, "A rig (YAML), for its board and options")->required();
  figure->add_option("--seeds", args->num_seeds, "Simulated sessions")->capture_default_str();
  figure->add_option("--num-poses", args->num_poses, "Of a session")->capture_default_str();
  figure->add_option("--seed", args->first_seed, "Of the first session")->capture_default_str();
  figure->add_option("--method", args->method, "Of each pair's refinement, as in a rig file")
      ->capture_default_str();
  figure->callback([args] { PrintRig(*args); });
}

}  // namespace voqcal
