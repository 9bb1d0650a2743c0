// Sessions of a world that is not as the estimators take it: do the intervals of the published
// result still hold, and how much worse is it?

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/assessment/given_session.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/camera/lens_errors.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/rig_errors.hpp"
#include "core/median.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/units.hpp"
#include "figures/figures.hpp"
#include "figures/simulated_session.hpp"

namespace voqcal {
namespace {

struct WrongModelsArgs {
  std::filesystem::path rig;
  int num_runs = 10;
  int num_poses = 30;
  std::uint32_t seed = 1;
  std::string only;
};

/// What is to be spoilt of one session.
struct Session {
  const Rig& rig;
  SimulationOptions options;
  SpoiltWorld spoilt;
  CameraModel camera;  ///< That the rig file has.
  BoardSpec board;     ///< That the rig file has.
};

struct WrongModel {
  const char* name;
  const char* what;
  std::function<void(Session*)> spoil;
};

// Each scan line's elevation is off by 0.05 degrees, 1 sigma.
void MistakeElevations(Session* session) {
  const KeyedNoise noise(session->options.seed, NoiseUse::kRingBias, -1);
  session->spoilt.sweep = [noise](const Eigen::Isometry3d&, PointCloud* sweep) {
    constexpr double kSigmaRad = 0.05 * kRadPerDeg;
    for (LidarPoint& point : sweep->points) {
      const double up_rad = kSigmaRad * noise.Normals(static_cast<std::uint64_t>(point.ring)).first;
      const Eigen::Vector3d position_m = point.position_m.cast<double>();
      const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(position_m).normalized();
      point.position_m = (Eigen::AngleAxisd(-up_rad, left) * position_m).cast<float>();
    }
  };
}

// The board's middle stands out by 3 mm.
void BendBoard(Session* session) {
  const BoardSpec& board = session->rig.board;
  const auto bend_m = [board](double x_m, double y_m) {
    constexpr double kDepthM = 0.003;
    const double x = 2 * x_m / board.width_m;
    const double y = 2 * y_m / board.height_m;
    return kDepthM * (1 - 0.5 * (x * x + y * y));
  };
  session->spoilt.corner = [bend_m](Eigen::Vector3d* corner_m) {
    corner_m->z() += bend_m(corner_m->x(), corner_m->y());
  };
  session->spoilt.sweep = [board, bend_m](const Eigen::Isometry3d& T_lidar_board,
                                          PointCloud* sweep) {
    constexpr double kNearM = 0.1;  // noise and offsets
    for (LidarPoint& point : sweep->points) {
      const Eigen::Vector3d position_m = point.position_m.cast<double>();
      const Eigen::Vector3d at = T_lidar_board.inverse() * position_m;
      const bool is_on_board = std::abs(at.z()) < kNearM && 2 * std::abs(at.x()) < board.width_m &&
                               2 * std::abs(at.y()) < board.height_m;
      if (!is_on_board) continue;
      const Eigen::Vector3d ray = position_m.normalized();
      const double facing = ray.dot(T_lidar_board.linear().col(2));
      point.position_m = (position_m + bend_m(at.x(), at.y()) / facing * ray).cast<float>();
    }
  };
}

// The board does not quite rest between sweep and image: 2 mm and 0.1 degrees, 1 sigma an axis.
void MoveBetween(Session* session) {
  session->spoilt.T_seen_true = [seed = session->options.seed](int stop) {
    const KeyedNoise noise(seed, NoiseUse::kHolds, stop);
    Vector6d moved;
    for (int i = 0; i < 6; ++i) {
      const double sigma = i < 3 ? 0.1 * kRadPerDeg : 0.002;
      moved[i] = sigma * noise.Normals(static_cast<std::uint64_t>(i)).first;
    }
    return PerturbLeft(Eigen::Isometry3d::Identity(), moved);
  };
}

// What was measured beforehand is off by what the intervals hold of it, drawn anew for each
// session.
void MistakeWhatIsAdmitted(Session* session) {
  const LikelihoodOptions& options = session->rig.extrinsic_refiner.likelihood;
  const KeyedNoise noise(session->options.seed, NoiseUse::kHolds, -1);
  RigErrors errors = PlausibleRigErrors(options);
  for (Eigen::Index i = 0; i < kNumRigErrors; ++i) {
    errors[i] *= noise.Normals(static_cast<std::uint64_t>(i)).first;
  }
  session->camera = CorrectedCamera(session->camera, errors.head<kNumLensErrors>());
  session->board.square_m *= 1 + errors[kSquares];
  session->board.pattern_offset_x_m += errors[kPatternOffsetX];
  session->board.pattern_offset_y_m += errors[kPatternOffsetY];
}

const std::vector<WrongModel>& WrongModels() {
  static const std::vector<WrongModel> models = {
      {"none", "as the estimators take it", [](Session*) {}},
      {"admitted", "camera and board by what the intervals hold", MistakeWhatIsAdmitted},
      {"blur",
       "edges of the board twice as blurred",
       [](Session* session) {
         session->options.pointing_noise_rad *= 2;
         session->options.beam_divergence_rad *= 1.5;
       }},
      {"ranges",
       "offset 40 mm, rings 16 mm, dark squares 30 mm",
       [](Session* session) {
         session->options.common_bias_m = 0.04;
         session->options.ring_bias_m = 0.016;
         session->options.dark_bias_m = 0.015;
       }},
      {"elevations", "scan lines off by 0.05 deg", MistakeElevations},
      {"lens",
       "f 0.1 %, cx 1 px, k1 0.003 wrong",
       [](Session* session) {
         session->camera.fx_px *= 1.001;
         session->camera.fy_px *= 1.001;
         session->camera.cx_px += 1;
         session->camera.distortion[0] += 0.003;
       }},
      {"bend", "the board's middle 3 mm out", BendBoard},
      {"motion", "2 mm, 0.1 deg between sweep and image", MoveBetween},
  };
  return models;
}

struct Tally {
  std::vector<double> rotations_deg;
  std::vector<double> translations_mm;
  int num_inside = 0;
  int num_inside_given_rig = 0;
  int num_refused = 0;
};

void Take(const CalibrationOutcome& outcome, const Eigen::Isometry3d& T_truth, Tally* tally) {
  constexpr double kSigmas95 = 1.959964;
  const Vector6d error = DifferenceLeft(T_truth, outcome.refined.T_camera_lidar);
  tally->rotations_deg.push_back(kDegPerRad * error.head<3>().norm());
  tally->translations_mm.push_back(1e3 * error.tail<3>().norm());
  for (int i = 0; i < 6; ++i) {
    const auto is_inside = [&](const Matrix6d& covariance) {
      return std::abs(error[i]) < kSigmas95 * std::sqrt(covariance(i, i)) ? 1 : 0;
    };
    tally->num_inside += is_inside(outcome.refined.covariance);
    tally->num_inside_given_rig += is_inside(outcome.refined.covariance_given_rig);
  }
  tally->num_refused += VerdictOf(outcome.calibration).grade == Grade::kBad ? 1 : 0;
}

void PrintWrongModels(const WrongModelsArgs& args) {
  const Rig rig = LoadRig(args.rig);
  std::printf("%d sessions of %d poses, the published result without scenes\n",
              args.num_runs,
              args.num_poses);
  std::puts(
      "wrong        median error: deg    mm   inside 95 % (asked: 90)  if the rig file is right  "
      "do not use  what");
  for (const WrongModel& model : WrongModels()) {
    if (!args.only.empty() && args.only != model.name) continue;
    Tally tally;
    for (int run = 0; run < args.num_runs; ++run) {
      SimulationOptions options =
          FaultySimulation(rig, args.num_poses, args.seed + static_cast<std::uint32_t>(run));
      Session session{rig, options, {}, rig.camera, rig.board};
      model.spoil(&session);
      GivenSession given{
          session.board, session.camera, SimulateProjected(rig, session.options, session.spoilt)};
      SeeBoardsAgain(&given);
      CalibrationTask task = rig.Task();
      task.camera = session.camera;
      task.board = session.board;
      const CalibrationOutcome outcome = Calibrate(given.samples, {}, task);
      if (!outcome.problem.empty()) {
        std::printf("%s, seed %u: %s\n", model.name, options.seed, outcome.problem.c_str());
        continue;
      }
      Take(outcome, rig.simulation.T_camera_lidar, &tally);
    }
    if (tally.rotations_deg.empty()) continue;
    const double num = static_cast<double>(tally.rotations_deg.size());
    std::printf("%-12s %17.3f  %5.2f  %22.1f%%  %23.1f%%  %10d  %s\n",
                model.name,
                Median(tally.rotations_deg),
                Median(tally.translations_mm),
                100.0 * tally.num_inside / (6.0 * num),
                100.0 * tally.num_inside_given_rig / (6.0 * num),
                tally.num_refused,
                model.what);
    std::fflush(stdout);
  }
}

}  // namespace

void AddWrongModels(CLI::App* app) {
  CLI::App* figure = app->add_subcommand(
      "wrong-models", "Error and coverage in a world that is not as the estimators take it");
  auto args = std::make_shared<WrongModelsArgs>();
  figure->add_option("--rig", args->rig, "A simulated rig (YAML)")->required();
  figure->add_option("--runs", args->num_runs, "Sessions of each")->capture_default_str();
  figure->add_option("--num-poses", args->num_poses, "Of a session")->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the first run")->capture_default_str();
  figure->add_option("--only", args->only, "One of them, by its name");
  figure->callback([args] { PrintWrongModels(*args); });
}

}  // namespace voqcal
