#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/assessment/given_session.hpp"

namespace voqcal {

/// One thing that may be wrong with what a calibration is given.
struct SessionFault {
  const char* name;
  std::vector<std::string> causes;  ///< Findings that name it.
  /// A size to measure its effect with; 0: it is there or not.
  double probe = 0.0;
  double max_size = 0.0;
  std::function<void(double size, GivenSession* session)> inject;
};

/// Faults of the rig file and of the sensors, as their effect on samples: nothing is rendered.
const std::vector<SessionFault>& SessionFaults();

}  // namespace voqcal
