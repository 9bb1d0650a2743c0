#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Geometry>

#include "core/calibration/calibration.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Names in a session's folder: the result, what it is for programs and for a browser, and the page
/// of what was seen where there is no result.
inline constexpr char kResultName[] = "extrinsic.yaml";
inline constexpr char kResultJsonName[] = "result.json";
inline constexpr char kReportName[] = "report.html";
inline constexpr char kNoResultName[] = "no_result.html";

/// Which bytes the result is made from. No wall-clock time: the file is the same each run.
struct MadeFrom {
  std::string log_sha256;  ///< Of the session's samples.lcm.
  std::string rig_sha256;
  std::string version;  ///< Of voqcal.
};

/// Everything that extrinsic.yaml says.
struct CalibrationResult : Calibration {
  MadeFrom made_from;
  CameraModel camera;  ///< The rig file's, with which T_camera_lidar goes.
};

/// The text of extrinsic.yaml. The same result gives the same bytes; numbers read back exactly.
std::string ToYaml(const CalibrationResult& result);

/// `path`; in a folder, which is then a result's, the file in it.
std::filesystem::path ResultFileAt(const std::filesystem::path& path);

/// T_camera_lidar of such a file (ResultFileAt), or of any YAML file with
///     T_camera_lidar: {matrix: 4 rows of 4} or {quaternion_xyzw, translation_m}
/// Other keys are not looked at. Rotations that were rounded (by up to 1e-3) are made exact.
///
/// @throws std::runtime_error naming file, line, key, rule and value: no such key, not a rigid
///     transform, or a matrix and a quaternion that contradict each other.
Eigen::Isometry3d ReadExtrinsic(const std::filesystem::path& path);

/// The same of a text that errors call `name`.
Eigen::Isometry3d ExtrinsicOf(const std::string& text, const std::string& name);

/// made_from.log_sha256 of such a text: of which samples it is.
/// @throws std::runtime_error if it has none.
std::string LogSha256Of(const std::string& text, const std::string& name);

/// Whether such a text says that it is not to be used (verdict.grade bad). False if it has none.
bool IsToBeMended(const std::string& text, const std::string& name);

}  // namespace voqcal
