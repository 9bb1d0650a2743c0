// voqcal_figures field: what becomes of recordings that other people made, one folder each.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "figures/field_set.hpp"
#include "figures/figures.hpp"

namespace voqcal {
namespace {

struct FieldArgs {
  std::filesystem::path data;
  std::string only;  // one set's name; empty: all
  bool is_verbose = false;
};

// The folders of `data` that have a rig file, by name.
std::vector<std::filesystem::path> SetsIn(const FieldArgs& args) {
  std::vector<std::filesystem::path> sets;
  for (const auto& entry : std::filesystem::directory_iterator(args.data)) {
    if (!std::filesystem::exists(entry.path() / "rig.yaml")) continue;
    if (args.only.empty() || entry.path().filename() == args.only) sets.push_back(entry.path());
  }
  std::sort(sets.begin(), sets.end());
  return sets;
}

// "deg 0.1 -0.2 0.0 (0.3 0.3 0.4)": the difference, and one sigma of it.
void PrintAxes(const char* unit,
               double factor,
               const Eigen::Vector3d& r,
               const Eigen::Vector3d& s) {
  std::printf("  %s %6.2f %6.2f %6.2f", unit, factor * r.x(), factor * r.y(), factor * r.z());
  std::printf(" (%.2f %.2f %.2f)", factor * s.x(), factor * s.y(), factor * s.z());
}

void Print(const FieldSet& set, bool is_verbose) {
  std::printf("%-26s %5zu  %6zu  %5zu  %7zu  %10zu  %5zu  ",
              set.name.c_str(),
              set.num_pairs,
              set.num_camera_boards,
              set.num_lidar_boards,
              set.num_samples,
              set.num_consistent,
              set.NumWrong());
  if (std::isnan(set.held_out_mm)) {
    std::printf("unknown%s%s\n", set.problem.empty() ? "" : ": ", set.problem.c_str());
  } else {
    std::printf("%.2f\n", set.held_out_mm);
  }
  if (!is_verbose) return;
  for (const SampleDifference& d : set.differences) {
    std::printf("  sample %3lld  sides %d  off by %4.1f sigma%s",
                static_cast<long long>(d.id),
                d.num_measured_sides,
                d.sigmas,
                d.IsWrong() ? " WRONG" : "");
    PrintAxes("deg", kDegPerRad, d.r.head<3>(), d.sigma.head<3>());
    PrintAxes("mm", 1e3, d.r.tail<3>(), d.sigma.tail<3>());
    std::puts("");
  }
  std::printf(
      "  beyond their covariances: %.1f mm along the ray, across it %.1f level and %.1f "
      "upright, tilt %.2f deg, turn %.2f\n",
      kMmPerM * set.errors.along_ray_m,
      kMmPerM * set.errors.level_m,
      kMmPerM * set.errors.upright_m,
      kDegPerRad * set.errors.tilt_rad,
      kDegPerRad * set.errors.turn_rad);
  std::printf("  %s\n", set.counts.c_str());
}

void PrintField(const FieldArgs& args) {
  std::puts(
      "set                        pairs  camera  lidar  samples  consistent  wrong  held-out "
      "centre mm");
  for (const std::filesystem::path& folder : SetsIn(args)) {
    try {
      Print(MeasureFieldSet(folder), args.is_verbose);
    } catch (const std::exception& error) {
      std::printf("%-26s %s\n", folder.filename().c_str(), error.what());
    }
    std::fflush(stdout);
  }
}

}  // namespace

void AddField(CLI::App* app) {
  const auto args = std::make_shared<FieldArgs>();
  CLI::App* figure = app->add_subcommand(
      "field", "Recordings of other people: which boards become samples, and whether any is wrong");
  figure
      ->add_option("--data",
                   args->data,
                   "Folder of sets: each has rig.yaml, images/poseN.png and pcd/poseN_full.pcd")
      ->required()
      ->check(CLI::ExistingDirectory);
  figure->add_option("--only", args->only, "The name of one set");
  figure->add_flag("--verbose", args->is_verbose, "Each sample's difference from the others");
  figure->callback([args] { PrintField(*args); });
}

}  // namespace voqcal
