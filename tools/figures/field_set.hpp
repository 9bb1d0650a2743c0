#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How far one sample is from where all the others put it.
struct SampleDifference {
  std::int64_t id = 0;
  int num_measured_sides = 4;
  Vector6d r = Vector6d::Zero();      ///< [rotation_rad; translation_m], camera axes.
  Vector6d sigma = Vector6d::Zero();  ///< Of each, both sensors' and the extrinsic's together.
  double sigmas = 0.0;                ///< Root of r' C^-1 r.

  /// As rare as 3 sigma of one dimension: 0.27 %.
  bool IsWrong() const { return sigmas * sigmas > 20.06; }
};

/// Each sample against the extrinsic that the others' poses give by their covariances (FitPoses).
/// Left out where the others give none.
std::vector<SampleDifference> DifferencesFromOthers(const std::vector<const BoardSample*>& samples,
                                                    const CameraModel& camera);

/// What became of one recording of other people.
struct FieldSet {
  std::string name;
  std::size_t num_pairs = 0;
  std::size_t num_camera_boards = 0;
  std::size_t num_lidar_boards = 0;  ///< By the lidar alone.
  std::size_t num_samples = 0;
  std::size_t num_consistent = 0;
  std::vector<SampleDifference> differences;  ///< Of the consistent ones.
  double held_out_mm = 0.0;                   ///< Centre, mean; NaN if unknown.
  std::string problem;                        ///< Why there is no result; empty if there is one.
  std::string counts;                         ///< What each module counted.

  std::size_t NumWrong() const;
};

/// @param folder  has rig.yaml, images/poseN.png and pcd/poseN_full.pcd.
/// @throws std::runtime_error naming the file and the cause.
FieldSet MeasureFieldSet(const std::filesystem::path& folder);

}  // namespace voqcal
