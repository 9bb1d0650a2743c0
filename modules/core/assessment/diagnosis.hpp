#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// What makes a cause worth a word: it must be beyond chance, and matter in practice.
struct DiagnosisOptions {
  double min_log_likelihood_gain = 10;  ///< Chance gains about a half for each parameter.
  double min_moved_intervals = 1;  ///< What moves the result less, of its 95 % interval, is in it.
  double max_range_offset_m = 0.03;  ///< That was taken out; datasheets claim as much accuracy.
  double min_edge_error_m = 0.02;  ///< Of the mean edge length; beams of finite width widen edges.
  double min_side_error_m = 0.01;  ///< Of width against height, which such beams widen alike.
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
  std::string cause;            ///< "focal length", "moving sample", ...: one of a few.
  std::string text;             ///< A sentence with the evidence.
  bool is_dealt_with = false;   ///< Nothing is left to be done about it.
  bool must_be_mended = false;  ///< The result is wrong by it, beyond what is said of it.
  double value = std::numeric_limits<double>::quiet_NaN();  ///< In `unit`; NaN if it has none.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::string unit;
  double log_likelihood_gain = std::numeric_limits<double>::quiet_NaN();
  /// How far the result moves if it is mended, in 95 % intervals, of the parameter that moves most.
  double moved_intervals = std::numeric_limits<double>::quiet_NaN();
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
/// be chance? Groups are added one at a time, the best first, so that one fault is not reported
/// under several names. And by trial: would the samples fit if the rig file said something else?
/// Samples that stand out are set aside first.
///
/// @param samples  those that the result is made from.
/// @param num_inconsistent  how many others contradict them (FindConsistent).
/// @param T_camera_lidar  the result...
/// @param covariance  ...and its own, if the rig file is right: what moves it less than it says is
///     no finding.
/// @param range_offset  what the result has taken out of the lidar's ranges, if it is observable:
///     then it is free in every model compared, and a finding only if no lidar errs so much. Too
///     large squares look like too short ranges.
/// @throws std::invalid_argument if `options` has Problems().
Diagnosis Diagnose(const std::vector<const BoardSample*>& samples,
                   int num_inconsistent,
                   const BoardSpec& board,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar,
                   const Matrix6d& covariance,
                   const BiasEstimate& range_offset,
                   const DiagnosisOptions& options);

}  // namespace voqcal
