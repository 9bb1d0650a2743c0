#pragma once

#include <string>
#include <vector>

namespace voqcal {

/// What is expected before the data speak. Model errors add to the detectors' covariances; how far
/// to believe the sum is estimated from the data.
struct LikelihoodOptions {
  double common_prior_m = 0.03;     ///< 1 sigma of the offset common to all ranges.
  double dark_step_prior_m = 0.03;  ///< 1 sigma of dark against bright surfaces.
  double ring_prior_m = 0.015;      ///< 1 sigma of each scan line's own offset.
  /// 1 sigma of an error of the outlines' height (along the lidar's z) that all sweeps share: scan
  /// lines cut the outline coarsely, and always at the same elevations.
  double outline_lift_prior_m = 0.001;
  double outline_rise_prior = 0.0005;  ///< The same, growing with the range: metres a metre.
  /// 1 sigma of what each sighting is off by beyond the detectors' noise: the priors of what the
  /// session shows.
  double outline_error_m = 0.001;    ///< Of the outline's centre.
  double outline_error_rad = 0.003;  ///< Of its turn in the plane.
  double camera_error_m = 0.003;     ///< Of the chessboard's depth...
  double camera_error_rad = 0.005;   ///< ...and of its tilt: the board bends, the lens model errs.
  // Plausible errors of what the rig file says of camera and board (CovarianceByRigErrors).
  /// 1 sigma of each of the LensErrors, here and where they are estimated (RefineWithLens). Four
  /// rig files of other people were off by 0.7 % of focal length and by 1.2 % of half the image's
  /// width in the principal point (root mean square, less calibrate_lens' own errors).
  double lens_error = 0.01;
  double board_size_error = 0.0005;       ///< 1 sigma of a chessboard square, relative.
  double pattern_offset_error_m = 0.001;  ///< 1 sigma in each direction of the plate.
  /// 1 sigma of a chessboard's corner where corners tell of the lens (CovarianceByRigErrors,
  /// RefineWithLens): more than its noise, as neighbours err alike.
  double corner_error_px = 0.3;
  int max_iterations = 50;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

}  // namespace voqcal
