#include "core/estimation/refine_status.hpp"

#include <stdexcept>

namespace voqcal {

std::string ToString(RefineStatus status) {
  switch (status) {
    case RefineStatus::kConverged:
      return "converged";
    case RefineStatus::kNotConverged:
      return "not converged";
    case RefineStatus::kDegenerate:
      return "degenerate";
  }
  throw std::logic_error("unknown RefineStatus");
}

}  // namespace voqcal
