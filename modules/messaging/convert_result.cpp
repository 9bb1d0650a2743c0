#include "messaging/convert_result.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "messaging/convert_board.hpp"
#include "messaging/message_error.hpp"

namespace voqcal {
namespace {

/// Unit length and w >= 0: one of the two quaternions of a rotation.
Eigen::Quaterniond QuaternionOf(const Eigen::Isometry3d& T_target_source) {
  Eigen::Quaterniond q(T_target_source.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

SetStatus StatusFromString(const std::string& text) {
  for (const SetStatus status :
       {SetStatus::kConverged, SetStatus::kNotConverged, SetStatus::kDegenerate}) {
    if (ToString(status) == text) return status;
  }
  throw MessageError("set extrinsic message: unknown status '" + text + "'");
}

}  // namespace

transform_t ToMessage(const Eigen::Isometry3d& T_target_source) {
  transform_t message{};
  // Eigen stores a quaternion's coefficients as x y z w.
  Eigen::Map<Eigen::Vector4d>(message.quaternion_xyzw) = QuaternionOf(T_target_source).coeffs();
  Eigen::Map<Eigen::Vector3d>(message.translation_m) = T_target_source.translation();
  return message;
}

Eigen::Isometry3d FromMessage(const transform_t& message) {
  const Eigen::Quaterniond q(Eigen::Map<const Eigen::Vector4d>(message.quaternion_xyzw));
  const Eigen::Map<const Eigen::Vector3d> t_m(message.translation_m);
  constexpr double kMaxDeparture = 1e-6;  // what a sender in single precision rounds away
  if (!(std::abs(q.norm() - 1.0) <= kMaxDeparture)) {
    throw MessageError("transform message: quaternion of length " + std::to_string(q.norm()));
  }
  if (!t_m.allFinite()) throw MessageError("transform message: translation is not finite");
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  T_target_source.linear() = q.normalized().toRotationMatrix();
  T_target_source.translation() = t_m;
  return T_target_source;
}

rigid_transform_t RigidTransformMessage(const Eigen::Isometry3d& T_target_source,
                                        std::int64_t utime) {
  const Eigen::Quaterniond q = QuaternionOf(T_target_source);
  rigid_transform_t message{};
  message.utime = utime;
  Eigen::Map<Eigen::Vector3d>(message.trans) = T_target_source.translation();
  Eigen::Map<Eigen::Vector4d>(message.quat) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  return message;
}

voq_set_t ToMessage(const VoqSet& set, const std::vector<std::int64_t>& sample_ids) {
  voq_set_t message{};
  for (const int sample : set.samples) {
    message.sample_ids.push_back(sample_ids.at(static_cast<std::size_t>(sample)));
  }
  message.num_samples = static_cast<std::int32_t>(message.sample_ids.size());
  message.kappa_lidar = set.kappa_lidar;
  message.kappa_camera = set.kappa_camera;
  message.e_be_mm = set.board_error_mm;
  message.voq = set.voq;
  return message;
}

VoqSet FromMessage(const voq_set_t& message, const std::vector<std::int64_t>& sample_ids) {
  VoqSet set;
  for (const std::int64_t id : message.sample_ids) {
    const auto found = std::find(sample_ids.begin(), sample_ids.end(), id);
    if (found == sample_ids.end()) {
      throw MessageError("VOQ set message: no sample " + std::to_string(id));
    }
    set.samples.push_back(static_cast<int>(found - sample_ids.begin()));
  }
  set.kappa_lidar = message.kappa_lidar;
  set.kappa_camera = message.kappa_camera;
  set.board_error_mm = message.e_be_mm;
  set.voq = message.voq;
  return set;
}

chosen_candidate_t ToMessage(const ExchangedSample& exchanged) {
  chosen_candidate_t message{};
  message.sample_id = exchanged.id;
  message.candidate = exchanged.candidate;
  message.reason = exchanged.reason;
  return message;
}

void TakeChosen(const std::vector<chosen_candidate_t>& chosen, std::vector<BoardSample>* samples) {
  for (const chosen_candidate_t& each : chosen) {
    const auto sample = std::find_if(samples->begin(), samples->end(), [&](const BoardSample& s) {
      return s.id == each.sample_id;
    });
    const int num_runners_up =
        sample == samples->end() ? 0 : static_cast<int>(sample->runners_up.size());
    if (each.candidate < 1 || each.candidate > num_runners_up) {
      throw MessageError("sample " + std::to_string(each.sample_id) + " has no candidate " +
                         std::to_string(each.candidate));
    }
    TakeCandidate(each.candidate, &*sample);
  }
}

std::vector<BoardSample> SamplesAsChosen(const samples_t& message,
                                         const std::vector<chosen_candidate_t>& chosen) {
  std::vector<BoardSample> samples = FromMessage(message);
  TakeChosen(chosen, &samples);
  return samples;
}

set_extrinsic_t ToMessage(const SetExtrinsic& extrinsic,
                          const voq_set_t& set,
                          bool is_kept,
                          const std::string& reason) {
  set_extrinsic_t message{};
  message.set = set;
  message.T_camera_lidar = ToMessage(extrinsic.T_camera_lidar);
  message.cost = extrinsic.cost;
  message.status = ToString(extrinsic.status);
  message.is_kept = is_kept ? 1 : 0;
  message.reason = reason;
  return message;
}

SetExtrinsic FromMessage(const set_extrinsic_t& message) {
  SetExtrinsic extrinsic;
  extrinsic.T_camera_lidar = FromMessage(message.T_camera_lidar);
  extrinsic.cost = message.cost;
  extrinsic.status = StatusFromString(message.status);
  return extrinsic;
}

extrinsic_averaged_t ToMessage(const AveragedExtrinsic& average,
                               const std::vector<voq_set_t>& sets,
                               const std::vector<SetExtrinsic>& extrinsics) {
  extrinsic_averaged_t message{};
  message.T_camera_lidar = ToMessage(average.T_camera_lidar);
  Eigen::Map<Vector6d>(message.spread) = average.spread;
  for (std::size_t i = 0; i < extrinsics.size(); ++i) {
    message.sets.push_back(
        ToMessage(extrinsics[i], sets.at(i), average.is_kept.at(i), average.reasons.at(i)));
  }
  message.num_sets = static_cast<std::int32_t>(message.sets.size());
  return message;
}

AveragedExtrinsic FromMessage(const extrinsic_averaged_t& message) {
  AveragedExtrinsic average;
  average.T_camera_lidar = FromMessage(message.T_camera_lidar);
  average.spread = Eigen::Map<const Vector6d>(message.spread);
  for (const set_extrinsic_t& set : message.sets) {
    average.is_kept.push_back(set.is_kept != 0);
    average.reasons.push_back(set.reason);
    average.num_kept += set.is_kept != 0 ? 1 : 0;
  }
  return average;
}

spread_t ToMessage(const Spread& spread) {
  spread_t message{};
  message.mean = spread.mean;
  message.std = spread.std;
  message.max = spread.max;
  return message;
}

Spread FromMessage(const spread_t& message) {
  Spread spread;
  spread.mean = message.mean;
  spread.std = message.std;
  spread.max = message.max;
  return spread;
}

scene_score_t ToMessage(const SceneScore& score) {
  scene_score_t message{};
  message.centre_px = ToMessage(score.centre_px);
  message.centre_mm = ToMessage(score.centre_mm);
  message.corner_mm = ToMessage(score.corner_mm);
  message.normal_deg = ToMessage(score.normal_deg);
  return message;
}

SceneScore FromMessage(const scene_score_t& message) {
  SceneScore score;
  score.centre_px = FromMessage(message.centre_px);
  score.centre_mm = FromMessage(message.centre_mm);
  score.corner_mm = FromMessage(message.corner_mm);
  score.normal_deg = FromMessage(message.normal_deg);
  return score;
}

}  // namespace voqcal
