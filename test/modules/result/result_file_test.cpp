#include "result/result_file.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "result/lidar_bias_yaml.hpp"
#include "rig/rig.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

CalibrationResult SomeResult() {
  CalibrationResult result;
  result.T_camera_lidar = Eigen::Translation3d(0.1, -1.0 / 3, 1e-17) *
                          Eigen::AngleAxisd(3.0, Eigen::Vector3d(1, -2, 3).normalized());
  result.covariance = Matrix6d::Identity() * 1e-6;
  result.covariance(0, 5) = result.covariance(5, 0) = 1.0 / 7;
  result.covariance_given_rig = 0.1 * result.covariance;
  result.averaged.T_camera_lidar = Eigen::Translation3d(1, 2, 3) * Eigen::Quaterniond::Identity();
  result.averaged.spread << 1, 2, 3, 4, 5, 6;
  result.averaged.num_sets = 50;
  result.averaged.num_kept = 41;
  result.held_out.centre_mm = {3.5, 1.25, 9};
  result.method = RefineMethod::kReprojection;
  result.trials = {{RefineMethod::kLikelihood, "no points", {}}};
  result.used_ids = {1, 3, 4};
  result.rejected = {{2, "disagrees with \"all\" others:\n26 deg \\ 80 mm"}};
  result.exchanged = {{4, 1, "disagrees with 3 of 3"}};
  result.made_from = {"aa", "bb", "0.1.0"};
  return result;
}

TEST(ToYaml, IsReadBackExactly) {
  const CalibrationResult result = SomeResult();
  const YAML::Node yaml = YAML::Load(ToYaml(result));
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_EQ(yaml["T_camera_lidar"]["matrix"][i][j].as<double>(),
                result.T_camera_lidar.matrix()(i, j));
      EXPECT_EQ(yaml["T_lidar_camera"]["matrix"][i][j].as<double>(),
                result.T_camera_lidar.inverse().matrix()(i, j));
    }
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(yaml["covariance"][i][5].as<double>(), result.covariance(i, 5));
    EXPECT_EQ(yaml["covariance_given_rig"][i][5].as<double>(), result.covariance_given_rig(i, 5));
    EXPECT_EQ(yaml["averaged"]["spread"][i].as<double>(), i + 1);
  }
  EXPECT_EQ(yaml["averaged"]["num_sets_kept"].as<int>(), 41);
  EXPECT_EQ(yaml["lidar_bias"]["status"].as<std::string>(), "not estimated");
  EXPECT_EQ(yaml["method"].as<std::string>(), "reprojection");
  EXPECT_EQ(yaml["methods"][0]["problem"].as<std::string>(), "no points");
  EXPECT_EQ(yaml["scores"]["held_out"]["centre_mm"]["std"].as<double>(), 1.25);
  EXPECT_TRUE(std::isnan(yaml["scores"]["in_sample"]["normal_deg"]["max"].as<double>()));
  EXPECT_EQ(yaml["samples"]["used"].as<std::vector<int>>(), (std::vector<int>{1, 3, 4}));
  EXPECT_EQ(yaml["samples"]["rejected"][0]["id"].as<int>(), 2);
  EXPECT_EQ(yaml["samples"]["exchanged"][0]["id"].as<int>(), 4);
  EXPECT_EQ(yaml["samples"]["exchanged"][0]["candidate"].as<int>(), 1);
  EXPECT_EQ(yaml["samples"]["exchanged"][0]["reason"].as<std::string>(), "disagrees with 3 of 3");
  EXPECT_EQ(yaml["samples"]["rejected"][0]["reason"].as<std::string>(),
            "disagrees with \"all\" others: 26 deg \\ 80 mm");
  EXPECT_EQ(yaml["made_from"]["rig_sha256"].as<std::string>(), "bb");
}

TEST(ToYaml, SaysWhatTheAssessmentFound) {
  CalibrationResult result = SomeResult();
  ScoreBin bin{"top left", {}};
  bin.score.centre_mm.mean = 2.5;
  bin.score.poses.resize(3);
  result.held_out_by_cell = {bin};
  result.predicted = {{10, 1.5, 12, 2.5, 14}};
  result.scene_check.verdict = Agreement::kDisagrees;
  result.scene_check.reason = "its edges fit best elsewhere";
  result.scene_check.score = 0.75;
  result.scene_check.asked[1] = M_PI / 180;
  result.scene_check.asked[5] = 0.25;
  result.scene_check.axes[1] = Agreement::kDisagrees;
  SceneProbe probe;
  probe.delta[2] = 0.5;
  probe.score = 0.625;
  result.scene_check.probes = {probe};
  Finding finding;
  finding.cause = "focal length";
  finding.text = "given 2 % too \"long\"";
  finding.value = -2;
  finding.unit = "%";
  result.diagnosis.findings = {finding};
  result.diagnosis.not_judged = {"time offset: at rest"};
  const YAML::Node yaml = YAML::Load(ToYaml(result));
  EXPECT_EQ(yaml["scores"]["held_out_by_image_cell"][0]["where"].as<std::string>(), "top left");
  EXPECT_EQ(yaml["scores"]["held_out_by_image_cell"][0]["samples"].as<int>(), 3);
  EXPECT_EQ(yaml["scores"]["held_out_by_image_cell"][0]["centre_mm"].as<double>(), 2.5);
  EXPECT_EQ(yaml["scores"]["held_out_by_range"].size(), 0U);
  EXPECT_EQ(yaml["predicted_errors"][0]["corner_px"].as<double>(), 2.5);
  EXPECT_EQ(yaml["scene_check"]["verdict"].as<std::string>(), "disagrees");
  EXPECT_EQ(yaml["scene_check"]["score"]["refined"].as<double>(), 0.75);
  EXPECT_NEAR(yaml["scene_check"]["turn_y_deg"]["asked"].as<double>(), 1, 1e-12);
  EXPECT_EQ(yaml["scene_check"]["turn_y_deg"]["verdict"].as<std::string>(), "disagrees");
  EXPECT_NEAR(yaml["scene_check"]["shift_z_mm"]["asked"].as<double>(), 250, 1e-9);
  EXPECT_EQ(yaml["scene_check"]["perturbed"][0]["delta"][2].as<double>(), 0.5);
  EXPECT_EQ(yaml["diagnosis"][0]["cause"].as<std::string>(), "focal length");
  EXPECT_EQ(yaml["diagnosis"][0]["text"].as<std::string>(), "given 2 % too \"long\"");
  EXPECT_FALSE(yaml["diagnosis"][0]["explained"]);  // does not apply
  EXPECT_EQ(yaml["not_judged"][0].as<std::string>(), "time offset: at rest");
  EXPECT_EQ(YAML::Load(ToYaml(SomeResult()))["diagnosis"].size(), 0U);
}

TEST(ToYaml, GivesTheCorrectedCameraAsARigFileHasIt) {
  CalibrationResult result = SomeResult();
  LensCorrection& lens = result.lens_correction;
  lens.problem = "";
  lens.camera.lens = LensModel::kEquidistant;
  lens.camera.width_px = 1920;
  lens.camera.height_px = 1208;
  lens.camera.fx_px = 1180.0 + 1.0 / 3;
  lens.camera.fy_px = 1181;
  lens.camera.cx_px = 960;
  lens.camera.cy_px = 600;
  lens.camera.distortion = {-0.05, 0.01};
  lens.errors.errors[kPrincipalPointX] = 1e-3;
  lens.errors.standard_errors.setConstant(5e-4);
  lens.errors.is_observable[kPrincipalPointX] = true;
  lens.T_camera_lidar.translation() = Eigen::Vector3d(0.25, 0, 0);
  lens.held_out.corner_mm.mean = 5.25;
  const YAML::Node yaml = YAML::Load(ToYaml(result))["lens_correction"];
  EXPECT_EQ(yaml["status"].as<std::string>(), "estimated");
  EXPECT_THAT(yaml["which_to_take"].as<std::string>(), HasSubstr("with the intrinsics of the rig"));
  EXPECT_DOUBLE_EQ(yaml["errors"]["principal_point_x_px"]["value"].as<double>(), 0.96);
  EXPECT_DOUBLE_EQ(yaml["errors"]["radial_2_px"]["standard_error"].as<double>(), 0.48);
  EXPECT_EQ(yaml["errors"]["radial_2_px"]["status"].as<std::string>(), "unobservable");
  EXPECT_EQ(yaml["T_camera_lidar"]["matrix"][0][3].as<double>(), 0.25);
  EXPECT_EQ(yaml["held_out"]["corner_mm"]["mean"].as<double>(), 5.25);
  YAML::Node rig;
  rig["rig"] = "corrected";
  rig["board"]["width_m"] = 0.61;
  rig["board"]["height_m"] = 0.85;
  rig["board"]["square_m"] = 0.1;
  rig["board"]["num_corners_x"] = 5;
  rig["board"]["num_corners_y"] = 7;
  rig["camera"] = yaml["camera"];
  YAML::Emitter text;
  text << rig;
  const test::TemporaryFolder folder;
  const Rig loaded = LoadRig(folder.Write("rig.yaml", text.c_str()));
  EXPECT_EQ(loaded.camera.fx_px, lens.camera.fx_px);
  EXPECT_EQ(loaded.camera.distortion, lens.camera.distortion);
}

TEST(ToYaml, SaysWhyThereIsNoLensCorrection) {
  CalibrationResult result = SomeResult();
  result.lens_correction.problem = "the samples do not tell it";
  result.e_dim_mm = 19.5;
  const YAML::Node yaml = YAML::Load(ToYaml(result));
  EXPECT_EQ(yaml["lens_correction"]["reason"].as<std::string>(), "the samples do not tell it");
  EXPECT_EQ(yaml["samples"]["e_dim_mm"].as<double>(), 19.5);
}

TEST(ReadLidarBias, ReadsWhatToYamlWrites) {
  CalibrationResult result = SomeResult();
  result.lidar_bias.common = {0.02, 0.001, true};
  result.lidar_bias.dark_step = {-1.0 / 3, 0.1, true};
  result.lidar_bias.rings = {{0.0, 0.015, false}, {-0.01, 0.002, true}};
  result.lidar_bias.outline_rise = {1e-5, 1e-6, true};
  result.lidar_bias.shades = {3.0, 40.0};
  result.chessboard_turn = {{1.0 / 300, -0.01}, {0.001, 0.002}};
  const std::string text = ToYaml(result);
  EXPECT_EQ(YAML::Load(text)["lidar_bias"]["ring_m"]["status"][0].as<std::string>(),
            "unobservable");
  EXPECT_EQ(YAML::Load(text)["lidar_bias"]["common_m"]["standard_error"].as<double>(), 0.001);
  const test::TemporaryFolder folder;
  const LidarBias bias = ReadLidarBias(folder.Write("extrinsic.yaml", text));
  EXPECT_EQ(bias.common.value_m, 0.02);
  EXPECT_TRUE(bias.IsObservable());
  EXPECT_EQ(bias.dark_step.value_m, -1.0 / 3);
  ASSERT_EQ(bias.rings.size(), 2U);
  EXPECT_EQ(bias.rings[1].value_m, -0.01);
  EXPECT_FALSE(bias.outline_lift.is_observable);
  EXPECT_EQ(bias.outline_rise.value_m, 1e-5);
  EXPECT_EQ(bias.shades.bright_intensity, 40.0);
  EXPECT_EQ(ReadChessboardTurn(folder.path() / "extrinsic.yaml"), result.chessboard_turn.value_rad);
  EXPECT_EQ(YAML::Load(text)["chessboard_turn_standard_error_rad"][1].as<double>(), 0.002);
}

TEST(ReadLidarBias, IsNoneWhereNoneWasEstimated) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(ReadLidarBias(folder.Write("a.yaml", ToYaml(SomeResult()))).IsObservable());
  EXPECT_FALSE(ReadLidarBias(folder.Write("b.yaml", "T_camera_lidar: {}\n")).IsObservable());
  EXPECT_TRUE(ReadChessboardTurn(folder.path() / "b.yaml").isZero());
}

TEST(ToYaml, SaysWhereTheTransformLeads) {
  EXPECT_THAT(ToYaml(SomeResult()),
              HasSubstr("T_camera_lidar:  # p_camera = T_camera_lidar * p_lidar, metres"));
}

TEST(ToYaml, GivesAQuaternionOfTheSameRotationWithPositiveW) {
  const YAML::Node yaml = YAML::Load(ToYaml(SomeResult()));
  const auto q = yaml["T_camera_lidar"]["quaternion_xyzw"].as<std::vector<double>>();
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  EXPECT_GE(q[3], 0);
  EXPECT_TRUE(R.isApprox(SomeResult().T_camera_lidar.linear(), 1e-14));
}

TEST(ToYaml, GivesTheSameBytesEachTime) { EXPECT_EQ(ToYaml(SomeResult()), ToYaml(SomeResult())); }

TEST(ReadExtrinsic, TakesTheFolderOfAResult) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::ErrorOf([&] { ReadExtrinsic(folder.path()); }),
              HasSubstr("extrinsic.yaml: cannot be read"));
  const std::filesystem::path file = folder.Write("extrinsic.yaml", ToYaml(SomeResult()));
  EXPECT_EQ(ReadExtrinsic(folder.path()).matrix(), ReadExtrinsic(file).matrix());
  EXPECT_NO_THROW(ReadLidarBias(folder.path()));
}

TEST(ReadExtrinsic, ReadsWhatToYamlWrites) {
  const test::TemporaryFolder folder;
  const auto path = folder.Write("extrinsic.yaml", ToYaml(SomeResult()));
  // The rotation is projected onto SO(3) again: a few roundings.
  EXPECT_TRUE(ReadExtrinsic(path).isApprox(SomeResult().T_camera_lidar, 1e-14));
}

/// The error of a file of this text, without its folder.
std::string ReadError(const std::string& text) {
  const test::TemporaryFolder folder;
  const auto path = folder.Write("e.yaml", text);
  const std::string error = test::ErrorOf([&] { ReadExtrinsic(path); });
  const std::string prefix = folder.path().string() + "/";
  return error.rfind(prefix, 0) == 0 ? error.substr(prefix.size()) : error;
}

TEST(ReadExtrinsic, TakesEitherForm) {
  const test::TemporaryFolder folder;
  const Eigen::Isometry3d from_quaternion =
      ReadExtrinsic(folder.Write("q.yaml",
                                 "note: any\nT_camera_lidar: {quaternion_xyzw: [0, 0, 0.7071, "
                                 "0.7071], translation_m: [1, 2, 3]}\n"));
  const Eigen::Isometry3d from_matrix = ReadExtrinsic(folder.Write(
      "m.yaml",
      "T_camera_lidar:\n  matrix: [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]\n"));
  EXPECT_TRUE(from_quaternion.isApprox(from_matrix, 1e-15));
  EXPECT_EQ(from_matrix * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 3, 3));
}

TEST(ReadExtrinsic, RefusesWhatIsNotRigid) {
  const auto error_of_matrix = [](const std::string& rows) {
    return ReadError("T_camera_lidar:\n  matrix: " + rows + "\n");
  };
  EXPECT_EQ(
      error_of_matrix("[[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1]]"),
      "e.yaml:2: T_camera_lidar.matrix must be a rigid transform: R'R is off the identity by 3, "
      "det R is 2, is a list of 4");
  EXPECT_THAT(error_of_matrix("[[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, -1, 3], [0, 0, 0, 1]]"),
              HasSubstr("det R is -1"));
  EXPECT_THAT(error_of_matrix("[[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 1, 1]]"),
              HasSubstr("must end with the row 0 0 0 1"));
  EXPECT_THAT(error_of_matrix("[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"),
              HasSubstr("must be 4 rows of 4"));
  EXPECT_THAT(error_of_matrix("[[1, 0, 0, x], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]"),
              HasSubstr("must be a list of rows of finite numbers"));
  EXPECT_EQ(
      ReadError("T_camera_lidar: {quaternion_xyzw: [1, 1, 0, 0], translation_m: [0, 0, 0]}"),
      "e.yaml:1: T_camera_lidar.quaternion_xyzw must be 4 numbers of length 1, is a list of 4");
}

TEST(ReadExtrinsic, RefusesFormsThatContradictEachOther) {
  EXPECT_THAT(ReadError("T_camera_lidar:\n"
                        "  matrix: [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]\n"
                        "  quaternion_xyzw: [0, 0, 0, 1]\n  translation_m: [1, 2, 4]\n"),
              HasSubstr("e.yaml:2: T_camera_lidar.matrix must say the same as quaternion_xyzw"));
}

TEST(ReadExtrinsic, NamesWhatIsMissing) {
  EXPECT_EQ(ReadError("T_lidar_camera: {}\n"), "e.yaml:1: T_camera_lidar is missing");
  EXPECT_THAT(
      ReadError("T_camera_lidar: {translation_m: [0, 0, 0]}\n"),
      HasSubstr("e.yaml:1: T_camera_lidar must have matrix, or quaternion_xyzw and translation_m"));
  EXPECT_EQ(ReadError(""), "e.yaml:1: must be one mapping of keys to values, is empty");
  EXPECT_THAT(test::ErrorOf([] { ReadExtrinsic("/none.yaml"); }),
              EndsWith("none.yaml: cannot be read: No such file or directory"));
}

TEST(IsToBeMended, FollowsTheVerdictsGrade) {
  EXPECT_TRUE(IsToBeMended("verdict: {grade: bad}\n", "e.yaml"));
  EXPECT_FALSE(IsToBeMended("verdict: {grade: look}\n", "e.yaml"));
  EXPECT_FALSE(IsToBeMended("T_camera_lidar: {}\n", "e.yaml"));  // another program's
}

}  // namespace
}  // namespace voqcal
