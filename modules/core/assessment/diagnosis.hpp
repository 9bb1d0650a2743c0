#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// What makes a cause worth a word: it must be beyond chance, help on samples that it was not
/// fitted to, and matter in practice.
struct DiagnosisOptions {
  double min_log_likelihood_gain = 10;  ///< Chance gains about a half for each parameter.
  double min_held_out_gain = 0.1;       ///< Share by which the held-out error must fall.
  double min_focal_scale = 0.005;
  double min_principal_point_px = 4;
  double min_square_scale = 0.005;
  double min_range_offset_m = 0.01;
  double max_range_offset_m = 0.03;  ///< That was taken out; datasheets claim as much accuracy.
  double min_edge_error_m = 0.02;  ///< Of the mean edge length; beams of finite width widen edges.
  double max_outlier_factor = 6;   ///< A sample so many times the median error off stands out.
  int min_samples = 8;             ///< Fewer are too few...
  double min_tilt_spread_rad =
      0.1745329252;  ///< ...and normals that spread less (10 deg) too similar...
  double min_view_spread_rad = 0.1047197551;  ///< ...as are centres in one direction (RMS 6 deg).

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// One thing that is likely wrong.
struct Finding {
  std::string cause;           ///< "focal length", "moving sample", ...: one of a few.
  std::string text;            ///< A sentence with the evidence.
  bool is_dealt_with = false;  ///< Nothing is left to be done about it.
  double value = std::numeric_limits<double>::quiet_NaN();  ///< In `unit`; NaN if it has none.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::string unit;
  double log_likelihood_gain = std::numeric_limits<double>::quiet_NaN();
  double explained = std::numeric_limits<double>::quiet_NaN();  ///< Share of the squared residual.
  double held_out_before_mm = std::numeric_limits<double>::quiet_NaN();
  double held_out_after_mm = std::numeric_limits<double>::quiet_NaN();
};

struct Diagnosis {
  std::vector<Finding> findings;  ///< Most likely first; empty: nothing wrong was found.
  std::vector<std::string>
      not_judged;  ///< "time offset: ..." and what else the samples leave open.
};

/// Says what is most likely wrong, by nested models: does the fit with one more group of parameters
/// (a longer focal length, larger squares, ...) explain the residuals so much better that it cannot
/// be chance, also on samples left out of it? Groups are added one at a time, the best first, so
/// that one fault is not reported under several names. Samples that stand out are set aside first.
///
/// @param samples  those that the result is made from.
/// @param num_inconsistent  how many others contradict them (FindConsistent).
/// @param T_camera_lidar  the result.
/// @param range_offset  what the result has taken out of the lidar's ranges, if it is observable:
///     then it is free in every model compared, and a finding only if no lidar errs so much. Too
///     large squares look like too short ranges.
/// @throws std::invalid_argument if `options` has Problems().
Diagnosis Diagnose(const std::vector<const BoardSample*>& samples,
                   int num_inconsistent,
                   const BoardSpec& board,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar,
                   const BiasEstimate& range_offset,
                   const DiagnosisOptions& options);

}  // namespace voqcal
