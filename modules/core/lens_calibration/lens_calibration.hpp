#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/image_parts.hpp"
#include "core/lens_calibration/lens_fit.hpp"
#include "core/lens_calibration/lens_view.hpp"

namespace voqcal {

/// How a lens is found from views, and when it is not to be used.
struct LensCalibrationOptions {
  std::optional<LensModel> lens;  ///< Nothing: the one that held-out views choose.
  std::size_t min_views = 8;      ///< Fewer tell nothing that can be checked.
  double max_view_ratio = 3.0;    ///< A view's RMS in the median view's; more: it is left out.
  std::size_t num_groups = 5;     ///< Of neighbouring views, each held out once.
  double max_rms_px = 1.5;        ///< More: the board or the lens is another.
  /// 1 sigma of scale and shift where the boards were, as a share of the focal length: 10 mm a
  /// metre.
  double max_sigma = 0.01;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// How well a lens predicts views that it was not fitted to: each with its own pose.
struct HeldOutErrors {
  double rms_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> view_px2;  ///< Mean square of each view's corners; infinite without a pose.
};

/// A form that was tried, and how it did.
struct LensTrial {
  LensFit fit;
  HeldOutErrors held_out;
};

/// Where the corners were, and how the boards were held.
struct LensCoverage {
  std::array<int, kNumImageParts> num_corners{};  ///< By part of the image, row by row.
  double least_tilt_rad = 0.0;                    ///< Of a board against the image plane.
  double most_tilt_rad = 0.0;
  /// Boards tilted by 15 degrees or more whose face looks left, right, up, down.
  std::array<int, 4> num_tilted{};
};

/// What views say of a camera's lens.
struct LensCalibration {
  std::optional<LensTrial> best;
  std::vector<LensTrial> trials;   ///< All, simplest first.
  std::vector<LensView> views;     ///< Those used.
  std::vector<LensView> odd;       ///< Left out: they fit far worse than the others.
  std::vector<double> odd_rms_px;  ///< Of each; infinite without a pose.
  LensCoverage coverage;
  /// One line on why it should not be used; empty if it may be.
  std::string refusal;
  std::vector<std::string> advice;  ///< A line each: what would make it better.
};

/// The lens by which the board fell on the images as it did: of one model, or of the simplest form
/// whose held-out error is within a standard error of the best one's.
/// @throws std::invalid_argument if `options` has Problems().
LensCalibration CalibrateLens(const std::vector<LensView>& views,
                              const BoardSpec& board,
                              const cv::Size& image_px,
                              const LensCalibrationOptions& options);

/// How a lens that was found elsewhere predicts the views.
HeldOutErrors ErrorsOfLens(const CameraModel& camera,
                           const BoardSpec& board,
                           const std::vector<LensView>& views);

}  // namespace voqcal
