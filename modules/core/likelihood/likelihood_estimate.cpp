#include "core/likelihood/likelihood_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

#include "core/likelihood/likelihood_equations.hpp"
#include "core/units.hpp"

namespace voqcal {

void SetFaults(const Eigen::VectorXd& lidar_faults, LidarBias* bias) {
  bias->common.value_m = lidar_faults[kCommon];
  bias->dark_step.value_m = lidar_faults[kDarkStep];
  bias->outline_lift.value_m = lidar_faults[kLift];
  bias->outline_rise.value_m = lidar_faults[kRise];
  for (std::size_t i = 0; i < bias->rings.size(); ++i) {
    const Eigen::Index fault = kFirstRing + static_cast<Eigen::Index>(i);
    if (fault < lidar_faults.size()) bias->rings[i].value_m = lidar_faults[fault];
  }
}

bool LensEstimate::IsObservable() const {
  return std::find(is_observable.begin(), is_observable.end(), true) != is_observable.end();
}

LidarBias LikelihoodExtrinsic::BiasAt(const Eigen::Isometry3d& T_camera_lidar_given) const {
  if (lidar_faults.size() == 0) return bias;  // as a message brings it: it goes with its extrinsic
  const Eigen::VectorXd moves = faults_by_extrinsic.topRows(lidar_faults.size()) *
                                DifferenceLeft(T_camera_lidar, T_camera_lidar_given);
  LidarBias moved = bias;
  SetFaults(lidar_faults + moves, &moved);
  return moved;
}

ChessboardTurn LikelihoodExtrinsic::ChessboardTurnAt(
    const Eigen::Isometry3d& T_camera_lidar_given) const {
  if (camera_faults.values.size() != kNumChessboardTurns) return {};
  const Eigen::Vector2d move_rad = faults_by_extrinsic.bottomRows(kNumChessboardTurns) *
                                   DifferenceLeft(T_camera_lidar, T_camera_lidar_given);
  return {camera_faults.values + move_rad, camera_faults.standard_errors};
}

std::string LikelihoodExtrinsic::Summary() const {
  std::ostringstream text;
  text << "likelihood " << ToString(status);
  if (!IsUsable()) return text.str();
  const Vector6d sigma = uncertainty.covariance.diagonal().cwiseSqrt();
  text.precision(3);
  text << ": 1 sigma up to " << kDegPerRad * sigma.head<3>().maxCoeff() << " deg and "
       << 1000.0 * sigma.tail<3>().maxCoeff() << " mm; range offset " << bias.common.Text()
       << ", dark against bright " << bias.dark_step.Text();
  return text.str();
}

}  // namespace voqcal
