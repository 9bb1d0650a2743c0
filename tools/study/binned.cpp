#include "study/binned.hpp"

#include "core/geometry/rigid.hpp"
#include "core/median.hpp"
#include "core/units.hpp"
#include "study/statistics.hpp"

namespace voqcal {
namespace {

using Members = std::vector<const StudiedSet*>;

// Standard deviation of [rotation_rad; translation_m] about the bin's mean, on the left side.
Vector6d SpreadOfResults(const Members& members) {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d translation_sum_m = Eigen::Vector3d::Zero();
  for (const StudiedSet* set : members) {
    rotations.push_back(set->extrinsic.T_camera_lidar.linear());
    translation_sum_m += set->extrinsic.T_camera_lidar.translation();
  }
  const double n = static_cast<double>(members.size());
  Eigen::Isometry3d T_mean = Eigen::Isometry3d::Identity();
  T_mean.linear() = MeanRotation(rotations);
  T_mean.translation() = translation_sum_m / n;
  Vector6d sum_of_squares = Vector6d::Zero();
  for (const StudiedSet* set : members) {
    sum_of_squares += DifferenceLeft(T_mean, set->extrinsic.T_camera_lidar).cwiseAbs2();
  }
  return (sum_of_squares / (n - 1)).cwiseSqrt();
}

double MeanOf(const Members& members, double StudiedSet::*figure) {
  std::vector<double> values;
  for (const StudiedSet* set : members) values.push_back(set->*figure);
  return Mean(values);
}

StudyBin BinOf(const Members& members, double StudiedSet::*figure) {
  const Vector6d spread = SpreadOfResults(members);
  std::vector<double> errors_mm;
  for (const StudiedSet* set : members) errors_mm.push_back(set->mean_mm);
  StudyBin bin;
  bin.num_sets = static_cast<int>(members.size());
  bin.figure = MeanOf(members, figure);
  bin.rotation_spread_deg = kDegPerRad * spread.head<3>().norm();
  bin.translation_spread_mm = kMmPerM * spread.tail<3>().norm();
  bin.error_mm = Mean(errors_mm);
  bin.median_error_mm = Median(errors_mm);
  bin.deviation_mm = MeanOf(members, &StudiedSet::deviation_mm);
  return bin;
}

}  // namespace

std::vector<StudyBin> BinSets(const std::vector<StudiedSet>& sets,
                              double StudiedSet::*figure,
                              double max_kappa,
                              int num_bins) {
  Members taking_part;
  std::vector<double> values;
  for (const StudiedSet& set : sets) {
    if (!set.IsScored() || set.kappa > max_kappa) continue;
    taking_part.push_back(&set);
    values.push_back(set.*figure);
  }
  std::vector<StudyBin> bins;
  for (const std::vector<int>& indices : EqualCountBins(values, num_bins)) {
    Members members;
    for (const int i : indices) members.push_back(taking_part[static_cast<std::size_t>(i)]);
    bins.push_back(BinOf(members, figure));
  }
  return bins;
}

}  // namespace voqcal
