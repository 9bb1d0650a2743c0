#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/verdict.hpp"
#include "core/sensor_network/sensor_network.hpp"

namespace voqcal {

/// Name of a rig's result in its folder.
inline constexpr char kRigResultName[] = "rig_extrinsics.yaml";

/// Two sensors of a rig, as they were calibrated by themselves: a lidar and a camera, or two
/// cameras by the boards that both saw.
struct CalibratedPair {
  SensorPair extrinsic;
  std::string folder;   ///< Of its own session, within the rig's; two cameras have none.
  Verdict verdict;      ///< That session's.
  int num_samples = 0;  ///< Poses of the board that it was made from.
  std::string samples_sha256;
  /// Why there is no extrinsic of it, in one line; empty if there is one.
  std::string problem;

  bool HasSession() const { return !folder.empty(); }
  std::string Name() const { return PairName(extrinsic.from, extrinsic.to); }
};

/// Everything that rig_extrinsics.yaml says.
struct RigExtrinsics {
  std::string rig;  ///< Its name.
  std::vector<std::string> lidars;
  std::vector<std::string> cameras;
  std::vector<CalibratedPair> pairs;
  SensorNetwork network;  ///< Of the pairs without a problem, in their order.
  std::string rig_sha256;
  std::string version;  ///< Of voqcal.
};

/// Whether the tree is good: its pairs, and what the loops say of them.
Verdict VerdictOf(const RigExtrinsics& result);

/// The text of rig_extrinsics.yaml. The same result gives the same bytes; numbers read back
/// exactly.
std::string ToYaml(const RigExtrinsics& result);

/// As a few lines for a terminal, its verdict first.
std::string Summary(const RigExtrinsics& result);

/// What other programs take of it.
struct SensorTree {
  struct Sensor {
    std::string name;
    bool is_lidar = false;
    /// p_reference = T_reference_sensor * p_sensor, metres.
    Eigen::Isometry3d T_reference_sensor = Eigen::Isometry3d::Identity();
  };
  std::string rig;
  std::string reference;
  std::vector<Sensor> sensors;   ///< The reference first.
  bool is_to_be_mended = false;  ///< The verdict is: do not use it.
};

/// The file, or the one in a folder; nothing if it is no result of a rig.
std::optional<std::filesystem::path> RigResultFileAt(const std::filesystem::path& path);

/// @throws std::runtime_error naming file, line, key, rule and value.
SensorTree ReadSensorTree(const std::filesystem::path& file);

}  // namespace voqcal
