#include "core/estimation/average.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "core/problems.hpp"

namespace voqcal {
namespace {

// The mean transform and each member's departure from it, [rotation_rad; translation_m], left side.
struct MeanAndDepartures {
  Eigen::Isometry3d T_mean = Eigen::Isometry3d::Identity();
  std::vector<Vector6d> departures;
};

MeanAndDepartures AboutTheMean(const std::vector<Eigen::Isometry3d>& transforms) {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Vector3d translation_sum_m = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& T : transforms) {
    rotations.push_back(T.linear());
    translation_sum_m += T.translation();
  }
  MeanAndDepartures about;
  about.T_mean.linear() = MeanRotation(rotations);
  about.T_mean.translation() = translation_sum_m / static_cast<double>(transforms.size());
  for (const Eigen::Isometry3d& T : transforms) {
    about.departures.push_back(DifferenceLeft(about.T_mean, T));
  }
  return about;
}

// Sample standard deviation (n - 1) of each parameter. One member shows no spread: NaN.
Vector6d StandardDeviation(const std::vector<Vector6d>& departures) {
  if (departures.size() < 2) return Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector6d sum_of_squares = Vector6d::Zero();
  for (const Vector6d& d : departures) sum_of_squares += d.cwiseAbs2();
  return (sum_of_squares / static_cast<double>(departures.size() - 1)).cwiseSqrt();
}

// Why a result goes: the parameter that is farthest off, in standard deviations; empty if none is
// too far.
std::string ReasonToDrop(const Vector6d& departure, const Vector6d& deviation, double max_z_score) {
  constexpr const char* kNames[6] = {
      "rotation x", "rotation y", "rotation z", "translation x", "translation y", "translation z"};
  // Equal results have no spread; the slack keeps their rounding from looking like an outlier.
  constexpr double kRounding = 1e-12;
  if ((departure.cwiseAbs().array() <= max_z_score * deviation.array() + kRounding).all())
    return {};
  Eigen::Index worst = 0;
  const double z_score =
      (departure.cwiseAbs().array() / (deviation.array() + kRounding)).maxCoeff(&worst);
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(2);
  text << kNames[worst] << " is " << z_score << " standard deviations from the mean of all sets";
  return text.str();
}

}  // namespace

std::vector<std::string> AverageOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("max_z_score", max_z_score);
  return problems.lines();
}

AveragedExtrinsic AverageExtrinsics(const std::vector<SetExtrinsic>& sets,
                                    const AverageOptions& options) {
  RequireUsable("AverageOptions", options.Problems());

  AveragedExtrinsic average;
  average.is_kept.assign(sets.size(), false);
  average.reasons.resize(sets.size());
  std::vector<Eigen::Isometry3d> usable;
  std::vector<std::size_t> usable_index;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!sets[i].IsUsable()) {
      average.reasons[i] = ToString(sets[i].status);
      continue;
    }
    usable.push_back(sets[i].T_camera_lidar);
    usable_index.push_back(i);
  }
  if (usable.empty()) return average;

  const MeanAndDepartures all = AboutTheMean(usable);
  Vector6d deviation = StandardDeviation(all.departures);
  if (usable.size() == 1) deviation.setZero();  // one set is its own mean
  std::vector<Eigen::Isometry3d> kept;
  for (std::size_t i = 0; i < usable.size(); ++i) {
    std::string& reason = average.reasons[usable_index[i]];
    reason = ReasonToDrop(all.departures[i], deviation, options.max_z_score);
    if (!reason.empty()) continue;
    kept.push_back(usable[i]);
    average.is_kept[usable_index[i]] = true;
  }
  if (kept.empty()) return average;

  const MeanAndDepartures about = AboutTheMean(kept);
  average.T_camera_lidar = about.T_mean;
  average.spread = StandardDeviation(about.departures);
  average.num_kept = static_cast<int>(kept.size());
  return average;
}

}  // namespace voqcal
