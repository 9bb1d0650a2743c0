// voqcal_figures guidance-bound: how few poses the best choice among places drawn at random would
// need.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/guidance/best_design.hpp"
#include "core/guidance/extrinsic_information.hpp"
#include "core/median.hpp"
#include "figures/figures.hpp"
#include "figures/simulated_session.hpp"
#include "support/guided_session.hpp"

namespace voqcal {
namespace {

struct BoundArgs {
  std::filesystem::path rig;
  int num_candidates = 300;
  int num_draws = 101;
  int num_poses = 40;
  std::uint32_t seed = 1;
};

// Of each number of poses.
struct Curves {
  std::vector<double> bound;          // no choice among the places is below
  std::vector<double> one_at_a_time;  // each pose the best at its time
  std::vector<double> at_random;      // median
};

void PrintNeeded(const Curves& curves) {
  std::puts("poses needed");
  std::puts("tolerance mm  at least  ratio  one at a time  ratio  random");
  for (const double tolerance_mm : {7.0, 5.0, 4.0, 3.0, 2.5}) {
    const int at_least = test::PosesNeeded(curves.bound, tolerance_mm);
    const int one_at_a_time = test::PosesNeeded(curves.one_at_a_time, tolerance_mm);
    const int at_random = test::PosesNeeded(curves.at_random, tolerance_mm);
    if (at_random > static_cast<int>(curves.at_random.size())) continue;
    std::printf("%12.1f  %8d  %5.2f  %13d  %5.2f  %6d\n",
                tolerance_mm,
                at_least,
                static_cast<double>(at_least) / at_random,
                one_at_a_time,
                static_cast<double>(one_at_a_time) / at_random,
                at_random);
  }
}

class Bound {
 public:
  Bound(const BoundArgs& args, const Rig& rig)
      : args_(args),
        rig_{rig.board, rig.camera, rig.extrinsic_refiner.likelihood},
        guidance_(rig.pose_guide),
        T_truth_(rig.simulation.T_camera_lidar),
        scene_(rig.camera, T_truth_, guidance_.enough.tolerance),
        nothing_({}, {T_truth_, {}, {}}, rig_.likelihood, guidance_.sensors.num_rows),
        random_(args.seed) {
    guidance_.limits.min_distance_m = rig.simulation.min_distance_m;
    guidance_.limits.max_distance_m = rig.simulation.max_distance_m;
  }

  void Print() {
    const std::vector<Eigen::MatrixXd> asked = Asked();
    const std::vector<Eigen::MatrixXd> at_random = AtRandom(M_PI / 4);
    std::printf("worst error by information alone, %s; %zu places\n",
                ToString(guidance_.enough.tolerance.unit).c_str(),
                asked.size());
    std::puts("poses   no choice is below   best design  one at a time  at random");
    Curves curves;
    Eigen::MatrixXd greedy = nothing_.information();
    for (int n = 1; n <= args_.num_poses; ++n) {
      const Design design = BestDesign(nothing_.information(), asked, scene_.Forms(), n);
      greedy += BestAddition(greedy, asked);
      curves.bound.push_back(design.least_error);
      curves.one_at_a_time.push_back(Worst(greedy));
      curves.at_random.push_back(MedianOf(at_random, n));
      std::printf("%5d  %20.2f  %11.2f  %13.2f  %9.2f\n",
                  n,
                  design.least_error,
                  design.worst_error,
                  curves.one_at_a_time.back(),
                  curves.at_random.back());
      std::fflush(stdout);
    }
    PrintNeeded(curves);
  }

 private:
  Eigen::MatrixXd InformationAt(const Eigen::Isometry3d& T_camera_board) {
    return nothing_.InformationOf(
        ExpectedSample(T_camera_board, T_truth_, rig_.board, rig_.camera, guidance_.sensors));
  }

  // One place, as what a pose there tells, until there are enough; most draws are out of view.
  template <typename Draw>
  std::vector<Eigen::MatrixXd> Places(Draw draw) {
    constexpr int kMaxTrialsEach = 10000;
    std::vector<Eigen::MatrixXd> informations;
    for (int trial = 0; trial < kMaxTrialsEach * args_.num_candidates; ++trial) {
      const std::optional<Eigen::Isometry3d> pose = draw();
      if (pose) informations.push_back(InformationAt(*pose));
      if (static_cast<int>(informations.size()) == args_.num_candidates) return informations;
    }
    throw std::runtime_error("the rig has hardly a place where both sensors see the board");
  }

  std::vector<Eigen::MatrixXd> Asked() {
    return Places([&]() -> std::optional<Eigen::Isometry3d> {
      Placement placement;
      placement.centre_px = {random_.Uniform(0, rig_.camera.width_px - 1),
                             random_.Uniform(0, rig_.camera.height_px - 1)};
      placement.distance_m =
          random_.Uniform(guidance_.limits.min_distance_m, guidance_.limits.max_distance_m);
      const double tilt = guidance_.limits.max_incidence_rad;
      placement.yaw_rad = random_.Uniform(-tilt, tilt);
      placement.pitch_rad = random_.Uniform(-tilt, tilt);
      const auto pose = PoseOf(placement, rig_.camera, T_truth_.linear().col(2));
      if (!pose ||
          !IsInView(
              *pose, T_truth_, rig_.board, rig_.camera, guidance_.sensors, guidance_.limits)) {
        return {};
      }
      return pose;
    });
  }

  std::vector<Eigen::MatrixXd> AtRandom(double max_roll_rad) {
    return Places(
        [&] { return test::RandomHold(max_roll_rad, T_truth_, rig_, guidance_, &random_); });
  }

  const Eigen::MatrixXd& BestAddition(const Eigen::MatrixXd& known,
                                      const std::vector<Eigen::MatrixXd>& candidates) const {
    const auto worst = [&](const Eigen::MatrixXd& added) { return Worst(known + added); };
    return *std::min_element(candidates.begin(),
                             candidates.end(),
                             [&](const auto& a, const auto& b) { return worst(a) < worst(b); });
  }

  double Worst(const Eigen::MatrixXd& information) const {
    const Eigen::MatrixXd gain =
        information.llt().solve(Eigen::MatrixXd::Identity(information.rows(), 6));
    return scene_.Worst(gain.topRows<6>()).error;
  }

  double MedianOf(const std::vector<Eigen::MatrixXd>& holds, int num_poses) {
    std::vector<double> errors;
    for (int draw = 0; draw < args_.num_draws; ++draw) {
      Eigen::MatrixXd information = nothing_.information();
      for (int i = 0; i < num_poses; ++i) information += holds[random_.Index(holds.size())];
      errors.push_back(Worst(information));
    }
    return Median(std::move(errors));
  }

  const BoundArgs& args_;
  GuidedRig rig_;
  GuidanceOptions guidance_;
  Eigen::Isometry3d T_truth_;
  ErrorScene scene_;
  ExtrinsicInformation nothing_;
  test::Random random_;
};

}  // namespace

void AddGuidanceBound(CLI::App* app) {
  const auto args = std::make_shared<BoundArgs>();
  CLI::App* figure = app->add_subcommand(
      "guidance-bound",
      "Poses that an accuracy takes at least, with the best choice among places drawn at random");
  figure->add_option("--rig", args->rig, "A simulated rig (YAML)")->required();
  figure->add_option("--candidates", args->num_candidates, "Places that are looked at")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  figure->add_option("--runs", args->num_draws, "Random sessions")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  figure->add_option("--num-poses", args->num_poses, "Of a session")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  figure->add_option("--seed", args->seed, "Of the places and sessions")->capture_default_str();
  figure->callback([args] {
    const Rig rig = LoadRig(args->rig);
    Bound(*args, rig).Print();
  });
}

}  // namespace voqcal
