#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/set_extrinsic.hpp"

namespace voqcal {

/// One combination of three poses: what the selectors say of it before it is calibrated, its
/// extrinsic, and how well that fits the scene.
struct StudiedSet {
  std::array<int, 3> samples{};  ///< Indices, ascending.
  double kappa = 0.0;            ///< max(kappa_lidar, kappa_camera).
  double board_error_mm = 0.0;   ///< e_be.
  double voq = 0.0;
  double volume = 0.0;              ///< min(|det N_lidar|, |det N_camera|).
  double predicted_error_mm = 0.0;  ///< SceneErrorPredictor's.
  double centre_distance_m = 0.0;   ///< RMS distance of the three centres from their mean.
  SetExtrinsic extrinsic;
  /// Reprojection error of the board's centre over all poses of the scene: pixels, and these times
  /// the board's metres per pixel. NaN if the extrinsic is not usable or hides a board.
  double mean_px = std::numeric_limits<double>::quiet_NaN();
  double mean_mm = std::numeric_limits<double>::quiet_NaN();
  double deviation_mm = std::numeric_limits<double>::quiet_NaN();
  double held_out_mm = std::numeric_limits<double>::quiet_NaN();  ///< Mean without the set's own.

  bool IsScored() const { return held_out_mm == held_out_mm; }
};

/// The centre of one board as both sensors see it: all that an extrinsic is scored by.
class SceneCentres {
 public:
  SceneCentres(const std::vector<BoardSample>& samples, const CameraModel& camera);

  std::size_t size() const { return centres_.size(); }
  /// Reprojection error of one board's centre, pixels; NaN if it is out of the camera's sight.
  double ErrorPx(std::size_t sample, const Eigen::Isometry3d& T_camera_lidar) const;
  double MillimetresPerPixel(std::size_t sample) const { return centres_[sample].mm_per_px; }

 private:
  struct Centre {
    Eigen::Vector3d lidar_m;
    Eigen::Vector2d px;
    double mm_per_px;
  };
  CameraModel camera_;
  std::vector<Centre> centres_;
};

/// Every combination of three of the samples, in the order of their indices. What the selectors
/// leave out (unmeasured edges, singular normals) is left out here.
std::vector<StudiedSet> StudyAllSets(const std::vector<BoardSample>& samples,
                                     const BoardSpec& board,
                                     const CameraModel& camera,
                                     const SetExtrinsicOptions& options);

}  // namespace voqcal
