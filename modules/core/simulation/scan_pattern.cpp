#include "core/simulation/scan_pattern.hpp"

#include <cmath>
#include <sstream>
#include <utility>

#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kSweepS = 0.1;

// Rings at even steps, all of a column fired at once.
struct Spin {
  int num_rings;
  int num_columns;
  double max_elevation_rad;  // the lowest ring is at minus this
};

constexpr Spin kSpinVlp16{16, 1800, 15.0 * M_PI / 180.0};
// As Ouster's OS1 of the first and of a later generation.
constexpr Spin kSpin64{64, 1024, 16.6 * M_PI / 180.0};
constexpr Spin kSpin128{128, 1024, 22.5 * M_PI / 180.0};

// As a Spectrum-Scan: 110 x 25 degrees.
constexpr double kRasterHalfWidthRad = 55.0 * kRadPerDeg;
constexpr double kRasterHalfHeightRad = 12.5 * kRadPerDeg;
constexpr int kNumRasterColumns = 551;  // 0.2 degrees apart
constexpr double kRasterRowRad = 0.25 * kRadPerDeg;

// Two prisms of equal power that turn against each other, with the rates of a Livox Mid-40, the
// field of view of a Mid-70, and the six emitters and 240,000 points a second of an Avia.
constexpr double kRosetteHalfAngleRad = 35.2 * kRadPerDeg;
constexpr double kFirstPrismHz = 7294.0 / 60.0;
constexpr double kSecondPrismHz = -4664.0 / 60.0;
constexpr int kNumRosetteEmitters = 6;
constexpr double kRosetteEmitterStepRad = 0.9 * kRadPerDeg;
constexpr int kNumRosetteFirings = 4000;

Eigen::Vector3d DirectionOf(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

std::optional<Spin> SpinOf(ScanPattern pattern) {
  switch (pattern) {
    case ScanPattern::kVlp16:
      return kSpinVlp16;
    case ScanPattern::kSpinning64:
      return kSpin64;
    case ScanPattern::kSpinning128:
      return kSpin128;
    case ScanPattern::kRaster:
    case ScanPattern::kRosette:
      break;
  }
  return std::nullopt;
}

std::vector<ScanBeam> SpinningBeams(const Spin& spin) {
  std::vector<ScanBeam> beams;
  beams.reserve(static_cast<std::size_t>(spin.num_rings) * spin.num_columns);
  for (int column = 0; column < spin.num_columns; ++column) {
    const double azimuth_rad = M_PI - column * (2.0 * M_PI / spin.num_columns);
    const auto time_s = static_cast<float>(column * (kSweepS / spin.num_columns));
    for (int ring = 0; ring < spin.num_rings; ++ring) {
      const double elevation_rad =
          spin.max_elevation_rad * (2.0 * ring / (spin.num_rings - 1) - 1.0);
      beams.push_back({DirectionOf(azimuth_rad, elevation_rad), ring, time_s});
    }
  }
  return beams;
}

std::vector<double> RasterRowsRad(const ScanOptions& options) {
  std::vector<double> rows_rad;
  double row_rad = -kRasterHalfHeightRad;
  while (row_rad <= kRasterHalfHeightRad) {
    rows_rad.push_back(row_rad);
    const bool is_dense = row_rad >= options.dense_from_rad && row_rad < options.dense_to_rad;
    row_rad += is_dense ? kRasterRowRad / 2 : kRasterRowRad;
  }
  return rows_rad;
}

std::vector<ScanBeam> RasterBeams(const ScanOptions& options) {
  const std::vector<double> rows_rad = RasterRowsRad(options);
  const std::size_t num_beams = rows_rad.size() * kNumRasterColumns;
  std::vector<ScanBeam> beams;
  beams.reserve(num_beams);
  for (int column = 0; column < kNumRasterColumns; ++column) {
    const double azimuth_rad = kRasterHalfWidthRad * (1.0 - 2.0 * column / (kNumRasterColumns - 1));
    for (const double row_rad : rows_rad) {
      const double share = static_cast<double>(beams.size()) / static_cast<double>(num_beams);
      beams.push_back({DirectionOf(azimuth_rad, row_rad), 0, static_cast<float>(share * kSweepS)});
    }
  }
  return beams;
}

// Each prism bends the beam by half of the field of view's half angle, in the direction in which it
// stands (thin prisms: the angles add).
std::vector<ScanBeam> RosetteBeams(std::int64_t sweep_us) {
  std::vector<ScanBeam> beams;
  beams.reserve(static_cast<std::size_t>(kNumRosetteFirings) * kNumRosetteEmitters);
  for (int firing = 0; firing < kNumRosetteFirings; ++firing) {
    const double time_s = firing * (kSweepS / kNumRosetteFirings);
    const double since_start_s = static_cast<double>(sweep_us) * 1e-6 + time_s;
    const double first_rad = 2.0 * M_PI * kFirstPrismHz * since_start_s;
    const double second_rad = 2.0 * M_PI * kSecondPrismHz * since_start_s;
    const double left_rad = kRosetteHalfAngleRad / 2 * (std::cos(first_rad) + std::cos(second_rad));
    const double up_rad = kRosetteHalfAngleRad / 2 * (std::sin(first_rad) + std::sin(second_rad));
    for (int emitter = 0; emitter < kNumRosetteEmitters; ++emitter) {
      const double offset_rad =
          kRosetteEmitterStepRad * (emitter - (kNumRosetteEmitters - 1) / 2.0);
      const double bend_rad = std::hypot(left_rad, up_rad + offset_rad);
      const double towards_rad = std::atan2(up_rad + offset_rad, left_rad);
      beams.push_back({{std::cos(bend_rad),
                        std::sin(bend_rad) * std::cos(towards_rad),
                        std::sin(bend_rad) * std::sin(towards_rad)},
                       emitter,
                       static_cast<float>(time_s)});
    }
  }
  return beams;
}

}  // namespace

std::string ToString(ScanPattern pattern) {
  switch (pattern) {
    case ScanPattern::kVlp16:
      return "vlp16";
    case ScanPattern::kSpinning64:
      return "spinning_64";
    case ScanPattern::kSpinning128:
      return "spinning_128";
    case ScanPattern::kRaster:
      return "raster";
    case ScanPattern::kRosette:
      return "rosette";
  }
  return "unknown";
}

std::optional<ScanPattern> ScanPatternFromString(const std::string& name) {
  for (const ScanPattern pattern : {ScanPattern::kVlp16,
                                    ScanPattern::kSpinning64,
                                    ScanPattern::kSpinning128,
                                    ScanPattern::kRaster,
                                    ScanPattern::kRosette}) {
    if (ToString(pattern) == name) return pattern;
  }
  return std::nullopt;
}

std::vector<std::string> ScanOptions::Problems() const {
  if (dense_from_rad <= dense_to_rad && std::isfinite(dense_from_rad) &&
      std::isfinite(dense_to_rad)) {
    return {};
  }
  std::ostringstream text;
  text << "dense_from_deg must be at most dense_to_deg, is " << dense_from_rad / kRadPerDeg
       << " and " << dense_to_rad / kRadPerDeg;
  return {text.str()};
}

std::vector<ScanBeam> BeamsOfSweep(const ScanOptions& options, std::int64_t sweep_us) {
  if (const auto spin = SpinOf(options.pattern)) return SpinningBeams(*spin);
  if (options.pattern == ScanPattern::kRaster) return RasterBeams(options);
  return RosetteBeams(sweep_us);
}

bool IsRepeating(ScanPattern pattern) { return pattern != ScanPattern::kRosette; }

bool HasRings(ScanPattern pattern) { return SpinOf(pattern).has_value(); }

int NumEmitters(ScanPattern pattern) {
  if (const auto spin = SpinOf(pattern)) return spin->num_rings;
  return pattern == ScanPattern::kRosette ? kNumRosetteEmitters : 1;
}

bool IsInFieldOfView(ScanPattern pattern, const Eigen::Vector3d& direction, double margin_rad) {
  const double level = direction.head<2>().norm();
  const double elevation_rad = std::abs(std::atan2(direction.z(), level));
  if (const auto spin = SpinOf(pattern))
    return elevation_rad < spin->max_elevation_rad - margin_rad;
  if (pattern == ScanPattern::kRaster) {
    return elevation_rad < kRasterHalfHeightRad - margin_rad &&
           std::abs(std::atan2(direction.y(), direction.x())) < kRasterHalfWidthRad - margin_rad;
  }
  const double bend_rad = std::atan2(direction.tail<2>().norm(), direction.x());
  return bend_rad < kRosetteHalfAngleRad - margin_rad;
}

}  // namespace voqcal
