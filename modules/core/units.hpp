#pragma once

namespace voqcal {

// Angles are radians and lengths metres; these are for the edges, where people read and write.
inline constexpr double kDegPerRad = 57.295779513082320877;
inline constexpr double kRadPerDeg = 0.017453292519943295769;
inline constexpr double kMmPerM = 1000.0;

}  // namespace voqcal
