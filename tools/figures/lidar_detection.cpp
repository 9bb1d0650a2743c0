// lidar-detection: how often the board is found, how often something else is taken for it, and how
// well errors agree with their covariance; for each scan pattern, among clutter, by range; then
// with each thing that may touch a board, by the number of sides that were measured, and of sweeps
// that are put together.

#include "support/lidar_detection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/median.hpp"
#include "figures/figures.hpp"

namespace voqcal {
namespace {

using test::ExpectedBoard;
using test::LidarSighting;
using test::SightingVerdict;

std::vector<std::string> AllPatterns() {
  return {"vlp16", "spinning_64", "spinning_128", "raster", "rosette"};
}

std::vector<std::string> AllParts() {
  return {"whole", "touched", "expected", "open-sides", "accumulated"};
}

struct Flags {
  std::vector<std::string> patterns = AllPatterns();
  int num_runs = 200;
  std::uint32_t seed = 1;
  bool is_list = false;
  std::vector<std::string> parts = AllParts();
};

// Of some sightings.
struct Tally {
  int num = 0;
  int num_enough = 0;  // with so much on the board that it must be found
  int num_found = 0;   // of those
  int num_wrong = 0;
  std::vector<double> centre_nees;
  std::vector<double> normal_nees;
  std::vector<double> centre_error_mm;
  std::vector<double> normal_error_deg;

  void Add(const LidarSighting& sighting) {
    ++num;
    if (sighting.IsEnough()) ++num_enough;
    if (sighting.verdict == SightingVerdict::kWrong) ++num_wrong;
    if (sighting.verdict != SightingVerdict::kRight) return;
    if (sighting.IsEnough()) ++num_found;
    centre_nees.push_back(sighting.centre_nees);
    normal_nees.push_back(sighting.normal_nees);
    centre_error_mm.push_back(1e3 * sighting.centre_error_m);
    normal_error_deg.push_back(sighting.normal_error_rad * 180.0 / M_PI);
  }
};

/// What --list shows: a wrong one, a miss of what must be found, an error that is far beyond what
/// its covariance says.
bool IsFailure(const LidarSighting& sighting) {
  constexpr double kMaxNees = 5.4;  // of three dimensions, one in a thousand
  switch (sighting.verdict) {
    case SightingVerdict::kWrong:
      return true;
    case SightingVerdict::kMissed:
      return sighting.IsEnough();
    case SightingVerdict::kRight:
      break;
  }
  return sighting.centre_nees > kMaxNees;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());  // NaN without values
}

double Percent(int part, int whole) { return 100.0 * part / whole; }

void PrintRow(const std::string& name, const Tally& tally) {
  std::cout << std::left << std::setw(24) << name << std::right << std::fixed << std::setw(7)
            << tally.num << std::setw(8) << tally.num_enough << std::setprecision(2) << std::setw(9)
            << Percent(tally.num_found, tally.num_enough) << std::setw(9)
            << Percent(tally.num_wrong, tally.num) << std::setw(9) << Mean(tally.centre_nees)
            << std::setw(9) << Mean(tally.normal_nees) << std::setw(9)
            << Median(tally.centre_error_mm) << std::setw(9) << Median(tally.normal_error_deg)
            << '\n';
}

void RunPattern(ScanPattern pattern, const Flags& flags) {
  test::LidarDetectionOptions options;
  options.pattern = pattern;
  options.num_sweeps = flags.num_runs;
  options.seed = flags.seed;
  constexpr std::array<double, 4> kRangesM = {1.5, 3.0, 5.0, 8.0};
  Tally all;
  std::array<Tally, kRangesM.size() - 1> by_range;
  std::vector<std::string> failures;
  for (const LidarSighting& sighting : test::SightLidarBoards(options, {})) {
    all.Add(sighting);
    const auto* const above =
        std::upper_bound(kRangesM.begin() + 1, kRangesM.end() - 1, sighting.DistanceM());
    by_range[above - kRangesM.begin() - 1].Add(sighting);
    if (IsFailure(sighting)) failures.push_back(sighting.Line());
  }
  PrintRow(ToString(pattern), all);
  for (std::size_t i = 0; i < by_range.size(); ++i) {
    std::ostringstream name;
    name << "  " << kRangesM[i] << " to " << kRangesM[i + 1] << " m";
    PrintRow(name.str(), by_range[i]);
  }
  if (!flags.is_list) return;
  for (const std::string& failure : failures) std::cout << "    " << failure << '\n';
}

void PrintHead(const std::string& what) {
  std::cout << what << '\n'
            << std::left << std::setw(24) << "pattern" << std::right << std::setw(7) << "sweeps"
            << std::setw(8) << "enough" << std::setw(9) << "found %" << std::setw(9) << "wrong %"
            << std::setw(18) << "NEES ctr  normal" << std::setw(18) << "ctr mm  nrm deg" << '\n';
}

void PrintAsked(const std::string& found, const std::string& wrong) {
  std::cout << std::left << std::setw(24) << "asked" << std::right << std::setw(7) << ""
            << std::setw(8) << "" << std::setw(9) << found << std::setw(9) << wrong << std::setw(18)
            << "0.8 to 1.2, each" << '\n';
}

test::LidarDetectionOptions OptionsOf(const std::string& pattern, const Flags& flags) {
  test::LidarDetectionOptions options;
  options.pattern = *ScanPatternFromString(pattern);
  options.num_sweeps = flags.num_runs;
  options.seed = flags.seed;
  return options;
}

/// Something touches every board.
void RunContacts(const Flags& flags, const std::string& title, ExpectedBoard expected) {
  PrintHead(title);
  PrintAsked(">= 95", "<= 0.1");
  for (const BoardContact contact : AllBoardContacts()) {
    for (const std::string& pattern : flags.patterns) {
      test::LidarDetectionOptions options = OptionsOf(pattern, flags);
      options.contact = contact;
      options.expected = expected;
      Tally tally;
      for (const LidarSighting& sighting : test::SightLidarBoards(options, {})) {
        tally.Add(sighting);
        if (flags.is_list && IsFailure(sighting)) std::cout << "    " << sighting.Line() << '\n';
      }
      PrintRow(ToString(contact) + ", " + pattern, tally);
    }
  }
}

/// The board is expected, and some of its sides are joined to leaves in its plane.
void RunOpenSides(const Flags& flags) {
  constexpr std::array<const char*, 5> kNames = {
      "plane alone", "three sides open", "two sides open", "one side open", "whole"};
  std::array<Tally, kNames.size()> by_sides;  // that were measured
  for (const std::string& pattern : flags.patterns) {
    for (int num_joined = 1; num_joined <= 4; ++num_joined) {
      test::LidarDetectionOptions options = OptionsOf(pattern, flags);
      options.num_joined = num_joined;
      options.expected = ExpectedBoard::kAlways;
      for (LidarSighting sighting : test::SightLidarBoards(options, {})) {
        if (sighting.verdict == SightingVerdict::kMissed) continue;
        // Where a side is open the centre may rightly be off: the covariance judges it.
        sighting.verdict = SightingVerdict::kRight;
        by_sides[static_cast<std::size_t>(sighting.num_measured_sides)].Add(sighting);
        if (flags.is_list && IsFailure(sighting)) std::cout << "    " << sighting.Line() << '\n';
      }
    }
  }
  PrintHead(
      "\nboards that are expected, with one to four sides joined to something in their plane");
  PrintAsked("", "");
  for (std::size_t i = kNames.size(); i-- > 0;) PrintRow(kNames[i], by_sides[i]);
}

/// Boards that rest through ten sweeps of the rosette: as dense as it is simulated, and thinner.
void RunAccumulated(const Flags& flags) {
  constexpr std::array<double, 4> kRangesM = {3.0, 5.0, 7.0, 10.0};
  constexpr std::array<int, 3> kNumPoints = {24000, 10000, 4000};
  constexpr double kNumBeams = 24000;
  std::cout << "\nboards that rest through ten sweeps, 0.1 s apart\n"
            << std::left << std::setw(34) << "points a sweep, distance" << std::right
            << std::setw(7) << "boards" << std::setw(10) << "from one" << std::setw(10)
            << "from ten" << std::setw(8) << "wrong" << std::setw(18) << "NEES ctr  normal"
            << std::setw(18) << "ctr mm  nrm deg" << '\n';
  for (const int num_points : kNumPoints) {
    for (std::size_t i = 0; i + 1 < kRangesM.size(); ++i) {
      test::LidarDetectionOptions options = OptionsOf("rosette", flags);
      options.min_distance_m = kRangesM[i];
      options.max_distance_m = kRangesM[i + 1];
      options.num_frames = 10;
      options.dropout = 1.0 - num_points / kNumBeams;
      Tally all;
      Tally several;
      int num_from_one = 0;
      for (const LidarSighting& sighting : test::SightLidarBoards(options, {})) {
        all.Add(sighting);
        if (sighting.num_frames > 1) several.Add(sighting);
        const bool is_right = sighting.verdict == SightingVerdict::kRight;
        num_from_one += is_right && sighting.num_frames == 1;
        if (flags.is_list && !is_right) std::cout << "    " << sighting.Line() << '\n';
      }
      std::ostringstream name;
      name << num_points << ", " << kRangesM[i] << " to " << kRangesM[i + 1] << " m";
      std::cout << std::left << std::setw(34) << name.str() << std::right << std::setw(7) << all.num
                << std::setw(10) << num_from_one << std::setw(10) << all.centre_nees.size()
                << std::setw(8) << all.num_wrong << std::fixed << std::setprecision(2)
                << std::setw(9) << Mean(several.centre_nees) << std::setw(9)
                << Mean(several.normal_nees) << std::setw(9) << Median(several.centre_error_mm)
                << std::setw(9) << Median(several.normal_error_deg) << std::endl;
    }
  }
}

void RunWhole(const Flags& flags) {
  PrintHead(
      "boards of 0.61 x 0.85 m at 1.5 to 8 m among clutter and a board of another size\n"
      "enough: 6 rings or 150 points on the board; found: of these; wrong: of all sweeps");
  PrintAsked(">= 98", "<= 0.1");
  for (const std::string& name : flags.patterns) RunPattern(*ScanPatternFromString(name), flags);
}

void Run(const Flags& flags) {
  const auto is_asked = [&flags](const std::string& part) {
    return std::find(flags.parts.begin(), flags.parts.end(), part) != flags.parts.end();
  };
  if (is_asked("whole")) RunWhole(flags);
  if (is_asked("touched")) {
    RunContacts(flags,
                "\nthe same boards, each touched by one thing, by the lidar alone",
                ExpectedBoard::kNever);
  }
  if (is_asked("expected")) {
    RunContacts(flags,
                "\nthe same; where the lidar is unsure, a camera tells where to look, 0.9 deg and "
                "20 mm off",
                ExpectedBoard::kWhereUnsure);
  }
  if (is_asked("open-sides")) RunOpenSides(flags);
  if (is_asked("accumulated")) RunAccumulated(flags);
}

}  // namespace

void AddLidarDetection(CLI::App* app) {
  const auto flags = std::make_shared<Flags>();
  CLI::App* command = app->add_subcommand(
      "lidar-detection", "The lidar board detector on simulated sweeps of every scan pattern");
  command->add_option("--pattern", flags->patterns, "only these (default: all)")
      ->check(CLI::IsMember(AllPatterns()));
  command->add_option("--runs", flags->num_runs, "sweeps of each pattern (default 200)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", flags->seed, "of the first hall; ten sweeps in each (default 1)");
  command->add_option("--part", flags->parts, "only these tables (default: all)")
      ->check(CLI::IsMember(AllParts()));
  command->add_flag("--list",
                    flags->is_list,
                    "list each miss, each wrong one and each that is farther off than it says");
  command->callback([flags] { Run(*flags); });
}

}  // namespace voqcal
