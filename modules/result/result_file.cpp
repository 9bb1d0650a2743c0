#include "result/result_file.hpp"

#include <cmath>
#include <sstream>

#include "files/atomic_file.hpp"
#include "files/number_text.hpp"
#include "files/transform_yaml.hpp"
#include "files/yaml_reader.hpp"
#include "result/assessment_yaml.hpp"
#include "result/camera_yaml.hpp"
#include "result/lens_correction_yaml.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "result/verdict_yaml.hpp"

namespace voqcal {
namespace {

constexpr char kMadeFromNote[] =
    "# log_sha256: of the session's samples.lcm, the log of the accepted samples. A result depends "
    "on\n"
    "# samples and rig only, so a live session and a run on its recording give the same bytes.\n";

std::string Score(const std::string& name, const std::string& note, const SceneScore& score) {
  return "  " + name + ":  # " + note + "\n" + ScoreYaml(score);
}

std::string Averaged(const AveragedPart& averaged) {
  return "averaged:  # the VOQ average that the refinement started from\n"
         "  T_camera_lidar:\n" +
         TransformYaml(averaged.T_camera_lidar, "    ") +
         "  # standard deviation of the kept sets: rotation_rad, then translation_m, left (camera) "
         "side\n"
         "  spread: " +
         ListYaml(averaged.spread) + "\n  num_sets: " + std::to_string(averaged.num_sets) +
         "\n  num_sets_kept: " + std::to_string(averaged.num_kept) + "\n";
}

std::string Methods(const CalibrationResult& result) {
  std::string text =
      "method: " + ToString(result.method) +
      "\n"
      "scene_note: " +
      QuotedYaml(result.scene_note) +
      "  # what the scenes' edges have to do with it\n"
      "methods:  # on poses held out; error_mm: geometric mean of centre and corner\n";
  if (result.trials.empty()) text = text.substr(0, text.find("methods:")) + "methods: []\n";
  for (const MethodTrial& trial : result.trials) {
    text += "  - {method: " + ToString(trial.method) +
            ", error_mm: " + NumberText(trial.ErrorMm()) +
            ", centre_mm: " + NumberText(trial.held_out.centre_mm.mean) +
            ", corner_mm: " + NumberText(trial.held_out.corner_mm.mean) +
            ", problem: " + QuotedYaml(trial.problem) + "}\n";
  }
  return text;
}

std::string Samples(const CalibrationResult& result) {
  std::string used;
  for (const std::int64_t id : result.used_ids) {
    used += (used.empty() ? "" : ", ") + std::to_string(id);
  }
  std::string rejected = result.rejected.empty() ? " []\n" : "\n";
  for (const RejectedSample& sample : result.rejected) {
    rejected += "    - {id: " + std::to_string(sample.id) +
                ", reason: " + QuotedYaml(sample.reason) + "}\n";
  }
  std::string exchanged = result.exchanged.empty() ? " []\n" : "\n";
  for (const ExchangedSample& sample : result.exchanged) {
    exchanged += "    - {id: " + std::to_string(sample.id) +
                 ", candidate: " + std::to_string(sample.candidate) +
                 ", reason: " + QuotedYaml(sample.reason) + "}\n";
  }
  return "samples:\n"
         "  # median over the accepted samples of the sum of the lidar's errors of the four edges\n"
         "  e_dim_mm: " +
         NumberText(result.e_dim_mm) + "\n  used: [" + used + "]\n  rejected:" + rejected +
         "  exchanged:" + exchanged;
}

/// The matrix form as a transform; an error of the section if it is not rigid.
void ReadMatrix(YamlSection* section, Eigen::Isometry3d* T) {
  constexpr double kMaxError = 1e-3;  // Files written by hand hold three or four digits.
  std::vector<std::vector<double>> rows;
  section->Read("matrix", &rows);
  Eigen::Matrix4d matrix;
  bool has_shape = rows.size() == 4;
  for (std::size_t i = 0; has_shape && i < 4; ++i) {
    has_shape = rows[i].size() == 4;
    if (has_shape) matrix.row(static_cast<int>(i)) = Eigen::Map<Eigen::RowVector4d>(rows[i].data());
  }
  if (!has_shape) return section->AddError("matrix", "must be 4 rows of 4 numbers");
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const double rotation_error =
      (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (rotation_error > kMaxError || R.determinant() < 0) {
    return section->AddError("matrix",
                             "must be a rigid transform: R'R is off the identity by " +
                                 NumberText(rotation_error) + ", det R is " +
                                 NumberText(R.determinant()));
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    return section->AddError("matrix", "must end with the row 0 0 0 1");
  }
  *T = Eigen::Isometry3d::Identity();
  T->linear() = NearestRotation(R);
  T->translation() = matrix.topRightCorner<3, 1>();
}

}  // namespace

std::string ToYaml(const CalibrationResult& result) {
  const MadeFrom& made_from = result.made_from;
  return "# Extrinsic calibration of a camera and a lidar, by voqcal.\n"
         "T_camera_lidar:  # p_camera = T_camera_lidar * p_lidar, metres\n" +
         TransformYaml(result.T_camera_lidar, "  ") +
         "T_lidar_camera:  # p_lidar = T_lidar_camera * p_camera, metres: the inverse\n" +
         TransformYaml(result.T_camera_lidar.inverse(), "  ") +
         "# of T_camera_lidar: rotation_rad, then translation_m, perturbed on the left (camera) "
         "side\n"
         "covariance:  # of where the lidar is, as camera and board of the rig file may be off\n" +
         RowsYaml(result.covariance, "  ") +
         "covariance_given_rig:  # if they are exactly right: where points land in the image, how "
         "results repeat\n" +
         RowsYaml(result.covariance_given_rig, "  ") +
         "camera:  # the rig file's, with which T_camera_lidar goes\n" +
         CameraYaml(result.camera, "  ") + VerdictYaml(VerdictOf(result)) + Methods(result) +
         Averaged(result.averaged) + LidarBiasYaml(result.lidar_bias) +
         "# all chessboards are seen turned by so much about the camera's x and y, against the "
         "rays\n"
         "# to their centres, as by a principal point that is given wrongly\n"
         "chessboard_turn_rad: " +
         ListYaml(result.chessboard_turn.value_rad) + "\nchessboard_turn_standard_error_rad: " +
         ListYaml(result.chessboard_turn.standard_error_rad) + "\n" +
         LensCorrectionYaml(result.lens_correction,
                            WhichToTake(result.lens_correction, result.T_camera_lidar)) +
         "# reprojection error of the board's centre in pixels, and times the metres per pixel at "
         "the\n"
         "# board; mean distance of the board's corners; angle between the normals;\n"
         "# all without the lidar's faults, as far as lidar_bias has them, and "
         "chessboard_turn_rad\n"
         "scores:\n" +
         Score("held_out", "each sample by the extrinsic refined without it", result.held_out) +
         Score("in_sample", "by the extrinsic made from these very samples", result.in_sample) +
         Score("average", "the VOQ average, all samples", result.of_average) +
         BinsYaml("held_out_by_image_cell", result.held_out_by_cell) +
         BinsYaml("held_out_by_range", result.held_out_by_range) + PredictedYaml(result.predicted) +
         SceneCheckYaml(result.scene_check) + DiagnosisYaml(result.diagnosis) + Samples(result) +
         kMadeFromNote + "made_from:\n  log_sha256: " + QuotedYaml(made_from.log_sha256) +
         "\n  rig_sha256: " + QuotedYaml(made_from.rig_sha256) +
         "\n  version: " + QuotedYaml(made_from.version) + "\n";
}

std::filesystem::path ResultFileAt(const std::filesystem::path& path) {
  std::error_code ignored;  // told by whoever reads it
  return std::filesystem::is_directory(path, ignored) ? path / kResultName : path;
}

Eigen::Isometry3d ReadExtrinsic(const std::filesystem::path& path) {
  const std::filesystem::path file = ResultFileAt(path);
  return ExtrinsicOf(ReadWholeFile(file), file.string());
}

Eigen::Isometry3d ExtrinsicOf(const std::string& text, const std::string& name) {
  constexpr double kMaxDisagreement = 1e-3;  // rad and m: what rounding explains.
  YamlDocument document(name, text);
  YamlSection top(&document);
  YamlSection section = top.RequiredSection("T_camera_lidar");
  document.ThrowIfWrong();
  const bool has_quaternion = section.Has("quaternion_xyzw") && section.Has("translation_m");
  if (!section.Has("matrix") && !has_quaternion) {
    top.AddError("T_camera_lidar", "must have matrix, or quaternion_xyzw and translation_m");
  }
  Eigen::Isometry3d from_quaternion = Eigen::Isometry3d::Identity();
  if (has_quaternion) ReadTransform(&section, &from_quaternion);
  Eigen::Isometry3d T_camera_lidar = from_quaternion;
  if (section.Has("matrix")) ReadMatrix(&section, &T_camera_lidar);
  document.ThrowIfWrong();
  if (has_quaternion && DifferenceLeft(T_camera_lidar, from_quaternion).norm() > kMaxDisagreement) {
    section.AddError("matrix", "must say the same as quaternion_xyzw and translation_m");
  }
  document.ThrowIfWrong();
  return T_camera_lidar;
}

std::string LogSha256Of(const std::string& text, const std::string& name) {
  YamlDocument document(name, text);
  YamlSection top(&document);
  YamlSection made_from = top.RequiredSection("made_from");
  document.ThrowIfWrong();
  std::string log_sha256;
  made_from.ReadRequired("log_sha256", &log_sha256);
  document.ThrowIfWrong();
  return log_sha256;
}

bool IsToBeMended(const std::string& text, const std::string& name) {
  YamlDocument document(name, text);
  YamlSection top(&document);
  std::string grade;
  top.Section("verdict").Read("grade", &grade);
  document.ThrowIfWrong();
  return grade == ToString(Grade::kBad);
}

}  // namespace voqcal
