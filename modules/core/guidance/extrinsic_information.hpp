#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/likelihood.hpp"

namespace voqcal {

/// What is known of the extrinsic while it is being measured.
struct ExtrinsicBelief {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  LidarBias bias;         ///< Zero if unknown.
  LikelihoodNoise noise;  ///< As it starts if unknown.
};

/// What samples tell of the extrinsic, by the likelihood's own equations
/// (likelihood_equations.hpp): of chessboard, returns and outline of each pose, with its board's
/// pose eliminated and the lidar's faults as unknowns beside the extrinsic. Before any sample the
/// extrinsic is known to 0.5 rad and 0.5 m, so that there is a covariance from the first sample on.
class ExtrinsicInformation {
 public:
  /// @param num_rings  samples and expected samples have no higher ring.
  ExtrinsicInformation(const std::vector<const BoardSample*>& samples,
                       const ExtrinsicBelief& belief,
                       const LikelihoodOptions& options,
                       int num_rings);

  /// Of [rotation_rad; translation_m], left (camera) side: the best that an unbiased estimate can
  /// do (Cramer and Rao).
  Matrix6d Covariance() const;

  /// The same once there is a further sample as ExpectedSample makes it.
  Matrix6d CovarianceWith(const BoardSample& expected) const;

  /// What is known of [extrinsic (6); faults], priors included...
  const Eigen::MatrixXd& information() const { return information_; }

  /// ...and what a further sample would add.
  Eigen::MatrixXd InformationOf(const BoardSample& expected) const;

 private:
  Eigen::MatrixXd InformationOf(const std::vector<const BoardSample*>& samples,
                                const LidarBias& bias,
                                const LikelihoodNoise& noise) const;

  Matrix6d CovarianceOf(const Eigen::MatrixXd& information) const;

  ExtrinsicBelief belief_;
  LikelihoodOptions options_;
  Eigen::Index num_faults_;
  Eigen::VectorXd prior_information_;  // of the faults
  std::vector<bool> is_free_;          // of the faults
  Eigen::MatrixXd information_;        // of [extrinsic (6); faults]
};

}  // namespace voqcal
