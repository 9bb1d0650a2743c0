#pragma once

#include <vector>

namespace voqcal {

/// How dark a return is: +1/2 on dark surfaces, -1/2 on bright ones.
struct ShadeScale {
  double dark_intensity = 0.0;
  double bright_intensity = 0.0;  ///< Not above dark_intensity: shades are not told apart.

  /// Zero, neither dark nor bright, if shades are not told apart or the intensity is not finite.
  double ShadeOf(float intensity) const;
};

/// The scale of a chessboard's returns: their 15th percentile is dark, and bright begins half-way
/// to the 85th, as bright squares lose intensity with range and slant, but dark ones have none to
/// lose. No scale without finite intensities.
ShadeScale ShadeScaleOf(std::vector<float> intensities);

/// How much longer dark returns read than bright ones, metres: least squares of residuals on their
/// shades, with zero expected, give or take 20 mm.
///
/// @param residuals_m  How much farther each return is than its surface.
/// @param shades       Of the same returns.
double DarkStepM(const std::vector<double>& residuals_m, const std::vector<double>& shades);

}  // namespace voqcal
