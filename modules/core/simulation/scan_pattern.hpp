#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// In which directions a lidar looks, and when. Every sweep takes 0.1 s.
enum class ScanPattern {
  kVlp16,        ///< 16 rings at 2 degrees, -15 to 15; 1800 columns a turn, from behind clockwise.
  kSpinning64,   ///< 64 rings, -16.6 to 16.6 degrees; 1024 columns.
  kSpinning128,  ///< 128 rings, -22.5 to 22.5 degrees; 1024 columns.
  kRaster,       ///< 110 x 25 degrees ahead, column by column, rows denser where told; no rings.
  kRosette,      ///< A disc of 70 degrees ahead, by two turning prisms; never repeats; no rings.
};

std::string ToString(ScanPattern pattern);  ///< "vlp16", "spinning_64", ... as in rig files.
std::optional<ScanPattern> ScanPatternFromString(const std::string& name);

/// What to scan.
struct ScanOptions {
  ScanPattern pattern = ScanPattern::kVlp16;
  // kRaster only: rows between these elevations are twice as dense.
  double dense_from_rad = -4.0 * M_PI / 180.0;
  double dense_to_rad = 4.0 * M_PI / 180.0;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// One measurement of a sweep.
struct ScanBeam {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< Unit length, lidar frame.
  int emitter = 0;   ///< Which laser; of a spinning lidar its ring, counted from the lowest.
  float time_s = 0;  ///< After the sweep's begin.
};

/// The beams of the sweep that begins at `sweep_us`, in the order of their times.
std::vector<ScanBeam> BeamsOfSweep(const ScanOptions& options, std::int64_t sweep_us);

bool IsRepeating(ScanPattern pattern);  ///< All sweeps have the same beams.
bool HasRings(ScanPattern pattern);     ///< Emitters are scan lines that the sensor names.
int NumEmitters(ScanPattern pattern);

/// Whether a direction (of any length) is inside what the pattern covers, by `margin_rad` or more.
bool IsInFieldOfView(ScanPattern pattern, const Eigen::Vector3d& direction, double margin_rad);

}  // namespace voqcal
