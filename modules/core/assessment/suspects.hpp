#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/assessment/fault_fit.hpp"

namespace voqcal {

/// One group of parameters that may be added to the plain fit, and how to speak of it.
struct Suspect {
  std::string cause;  ///< One of a few.
  std::string group;  ///< Of suspects that trade with each other: the lens' coefficients, say.
  std::vector<FaultParameter> faults;
  /// No more is possible, in the parameters' unit: an error that could be larger is open.
  double most = std::numeric_limits<double>::infinity();
  bool trades_rotation = false;  ///< The extrinsic turns with it, and points land as before.
  double scale = 1.0;            ///< From the first parameter's unit to that of the text.
  std::string unit;
  /// "the focal length given is 2.0 +- 0.1 % too long": what is wrong with what was given.
  std::function<std::string(const FaultFit& fit)> claim;
  /// What to do: the line to put into the rig file, with all that `fit` has found.
  std::function<std::string(const FaultFit& fit)> remedy;

  double Length(const FaultFit& fit) const;
  double LengthError(const FaultFit& fit) const;
};

/// The line of the rig file: "camera.distortion: [-0.44, 0.23, 0, 0, 0]".
std::string DistortionLine(const CameraModel& camera);
/// ..., and how to know it better than samples tell.
std::string SquaresLine(double square_m);

inline constexpr char kPrincipalPointCause[] = "principal point";
Suspect PrincipalPoint(const CameraModel& camera);

/// Focal lengths, that principal point, each distortion coefficient, squares, where the pattern
/// lies on the plate, the lidar's ranges.
std::vector<Suspect> SuspectsOf(const BoardSpec& board, const CameraModel& camera);

}  // namespace voqcal
