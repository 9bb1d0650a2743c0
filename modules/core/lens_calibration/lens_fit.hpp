#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/types.hpp>

#include "core/camera/camera_model.hpp"
#include "core/lens_calibration/lens_view.hpp"

namespace voqcal {

/// A lens model and how many of its coefficients, from the first, are estimated; the rest is zero.
struct LensForm {
  LensModel lens = LensModel::kPlumbBob;
  int num_free = 5;

  int NumParameters() const { return 4 + num_free; }  ///< fx fy cx cy first.
};

/// "equidistant", "plumb_bob with k1 k2 alone".
std::string ToString(const LensForm& form);

/// A form with all of its model's coefficients.
LensForm WholeForm(LensModel lens);

/// Those that an automatic choice is made of, simplest first.
const std::vector<LensForm>& LensForms();

/// The lens by which the boards' corners fall where they were seen.
struct LensFit {
  LensForm form;
  CameraModel camera;
  std::vector<Eigen::Isometry3d> T_camera_board;  ///< By view.
  /// By view, of a corner's two errors together; infinite where the lens brings a corner to no
  /// pixel.
  std::vector<double> view_rms_px;
  double rms_px = 0.0;  ///< Of all views' corners.
  /// Of fx fy cx cy and the free coefficients: what the corners' scatter makes of them, times how
  /// much more the views differ from each other than that (errors that a view's corners share, a
  /// board that bends). Infinite where the views leave a parameter open.
  Eigen::MatrixXd covariance;
  /// How far the lens as a whole may be off where the corners were, 1 sigma: what a change of the
  /// focal length and a shift of all pixels explain of its errors there. (The focal length itself
  /// is that of the axis, which may be far from any corner.)
  double scale_sigma = 0.0;     ///< Relative.
  double shift_sigma_px = 0.0;  ///< The larger of both directions.

  double Sigma(int parameter) const;
};

/// The least squares over all views, their poses with the lens.
/// @param start  a lens near it, of whatever model (only its numbers are taken).
/// @param huge_px  a view of that RMS begins to count less (a robust loss); 0: all alike.
/// @return nothing if some view has no pose with the start, or the solution is no camera.
std::optional<LensFit> FitLens(const LensForm& form,
                               const std::vector<Eigen::Vector3d>& corners_board_m,
                               const std::vector<LensView>& views,
                               const CameraModel& start,
                               double huge_px);

/// Where to begin: of a row of focal lengths, without distortion, the one by which the median view
/// fits best. `corners_board_m` as above.
std::optional<CameraModel> StartLens(LensModel lens,
                                     const cv::Size& image_px,
                                     const std::vector<Eigen::Vector3d>& corners_board_m,
                                     const std::vector<LensView>& views);

}  // namespace voqcal
