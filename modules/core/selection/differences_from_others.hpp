#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How far one sample is from where all the others put it: its deleted residual (Cook and Weisberg
/// 1982, "Residuals and influence in regression"). The others give the extrinsic, and how large
/// errors of single sightings are (FitWithErrors); the sample's own covariance counts too.
struct SampleDifference {
  std::int64_t id = 0;
  int num_measured_sides = 4;
  Vector6d r = Vector6d::Zero();      ///< [rotation_rad; translation_m], camera axes.
  Vector6d sigma = Vector6d::Zero();  ///< Of each, of all that counts together.
  double sigmas = 0.0;                ///< Root of r' C^-1 r.

  /// As rare as 3 sigma of one dimension: 0.27 %.
  bool IsWrong() const { return sigmas * sigmas > 20.06; }
};

/// Of each sample. Left out where the others give no extrinsic.
std::vector<SampleDifference> DifferencesFromOthers(const std::vector<const BoardSample*>& samples,
                                                    const CameraModel& camera);

/// Those that are wrong by all the others, of which there must be seven: the farthest goes, then
/// the farthest of those that are left, until none is wrong. Where all sightings of a session are
/// bad, none is an outlier: their errors are large.
/// @param samples  that agree pairwise (FindConsistent).
std::vector<SampleDifference> FindOutlying(std::vector<const BoardSample*> samples,
                                           const CameraModel& camera);

/// "is off by 27.1 mm and 1.90 deg from where all the others put it: 5.1 sigma", for people.
std::string ReasonFor(const SampleDifference& difference);

}  // namespace voqcal
