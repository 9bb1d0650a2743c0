#pragma once

#include <string>

namespace voqcal {

/// How a refinement ended.
enum class RefineStatus { kConverged, kNotConverged, kDegenerate };
std::string ToString(RefineStatus status);

}  // namespace voqcal
