#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// A lens and its coefficients, in the order of `lens`; the rest is zero.
struct NamedLens {
  LensModel lens = LensModel::kPlumbBob;
  std::array<double, 8> distortion{};
};

/// A lens model by which key it was asked for, and the rule that it breaks.
struct LensRefusal {
  bool is_of_coefficients = false;  ///< Of their number or values; else of the model's name.
  std::string rule;                 ///< "must be ...", with what to do.
};

/// The model alone, where its coefficients are not known yet: by the names below.
Expected<LensModel, LensRefusal> LensModelByName(const std::string& model);

/// The lens that a calibration speaks of, by the names and the coefficients of ROS, OpenCV and
/// Kalibr (radtan and equidistant of 4; plumb_bob of 4, 5, 8, 12 or 14, of which those of the thin
/// prism and the tilt must be zero). What is another lens is refused with how to convert it.
Expected<NamedLens, LensRefusal> LensByName(const std::string& model,
                                            const std::vector<double>& distortion);

}  // namespace voqcal
