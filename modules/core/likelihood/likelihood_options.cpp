#include "core/likelihood/likelihood_options.hpp"

#include "core/problems.hpp"

namespace voqcal {

std::vector<std::string> LikelihoodOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("common_prior_m", common_prior_m);
  problems.RequirePositive("dark_step_prior_m", dark_step_prior_m);
  problems.RequirePositive("ring_prior_m", ring_prior_m);
  problems.RequirePositive("outline_lift_prior_m", outline_lift_prior_m);
  problems.RequirePositive("outline_rise_prior", outline_rise_prior);
  problems.RequirePositive("outline_error_m", outline_error_m);
  problems.RequirePositive("outline_error_rad", outline_error_rad);
  problems.RequirePositive("camera_error_m", camera_error_m);
  problems.RequirePositive("camera_error_rad", camera_error_rad);
  problems.RequirePositive("lens_error", lens_error);
  problems.Require(pattern_offset_error_m >= 0.0,
                   "pattern_offset_error_m must not be negative",
                   pattern_offset_error_m);
  problems.Require(
      board_size_error >= 0.0, "board_size_error must not be negative", board_size_error);
  problems.RequirePositive("corner_error_px", corner_error_px);
  problems.RequirePositive("max_iterations", max_iterations);
  return problems.lines();
}

}  // namespace voqcal
