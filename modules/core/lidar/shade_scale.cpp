#include "core/lidar/shade_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voqcal {

double ShadeScale::ShadeOf(float intensity) const {
  if (!(bright_intensity > dark_intensity) || !std::isfinite(intensity)) return 0.0;
  const double brightness = (intensity - dark_intensity) / (bright_intensity - dark_intensity);
  return 0.5 - std::clamp(brightness, 0.0, 1.0);
}

ShadeScale ShadeScaleOf(std::vector<float> intensities) {
  constexpr double kDarkShare = 0.15;
  constexpr double kBrightShare = 0.85;
  const auto is_broken = [](float intensity) { return !std::isfinite(intensity); };
  intensities.erase(std::remove_if(intensities.begin(), intensities.end(), is_broken),
                    intensities.end());
  if (intensities.empty()) return {};
  const auto at = [&intensities](double share) {
    const auto place =
        intensities.begin() +
        static_cast<std::ptrdiff_t>(share * static_cast<double>(intensities.size() - 1));
    std::nth_element(intensities.begin(), place, intensities.end());
    return static_cast<double>(*place);
  };
  const double dark = at(kDarkShare);
  return {dark, 0.5 * (dark + at(kBrightShare))};
}

double DarkStepM(const std::vector<double>& residuals_m, const std::vector<double>& shades) {
  constexpr double kExpectedM = 0.02;  // of a VLP-16 it is 15 mm
  constexpr double kNoiseM = 0.01;     // of one return, 1 sigma
  if (shades.empty()) return 0.0;
  double mean_residual_m = 0.0;
  double mean_shade = 0.0;
  const auto num = static_cast<double>(shades.size());
  for (std::size_t i = 0; i < shades.size(); ++i) {
    mean_residual_m += residuals_m[i] / num;
    mean_shade += shades[i] / num;
  }
  double information = (kNoiseM * kNoiseM) / (kExpectedM * kExpectedM);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < shades.size(); ++i) {
    const double shade = shades[i] - mean_shade;
    information += shade * shade;
    sum_m += shade * (residuals_m[i] - mean_residual_m);
  }
  return sum_m / information;
}

}  // namespace voqcal
