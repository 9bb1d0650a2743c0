#pragma once

namespace voqcal {

/// Fewer samples hold no extrinsic: each gives a plane and a point.
constexpr int kLeastSamples = 3;

}  // namespace voqcal
