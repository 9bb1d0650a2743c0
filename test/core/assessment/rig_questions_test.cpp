#include "core/assessment/rig_questions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/assessment/diagnosis.hpp"
#include "core/estimation/refine.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

/// 30 poses with a VLP-16's noise, of a board and a camera that are as they are said to be.
GivenSession CleanSession(const BoardSpec& board, const CameraModel& camera) {
  test::SyntheticSamplesOptions options;
  options.lidar_rotation_noise_rad = 0.005;
  options.lidar_centre_noise_m = 0.003;
  options.edge_noise_m = 0.005;
  GivenSession session{board, camera, test::SynthesizeSamples(options)};
  test::Random random(7);
  for (BoardSample& sample : session.samples) {
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    sample.camera.corners_px.clear();
    for (const Eigen::Vector3d& corner_board_m : board.InnerCornersBoardM()) {
      const Eigen::Vector3d corner_camera_m = T_camera_board * corner_board_m;
      sample.camera.corners_px.push_back(camera.Project(corner_camera_m) +
                                         0.1 * random.NormalVector().head<2>());
    }
  }
  SeeBoardsAgain(&session);
  return session;
}

GivenSession CleanSession() { return CleanSession(test::TestBoard(), test::TestCamera()); }

/// Of what a calibration with the given board and camera makes of the samples.
Diagnosis DiagnosisOf(const GivenSession& session) {
  const auto samples = test::Pointers(session.samples);
  const RefinedExtrinsic refined =
      RefineExtrinsic(samples, session.camera, AnalyticExtrinsic(samples), {});
  return Diagnose(samples,
                  0,
                  session.board,
                  session.camera,
                  refined.T_camera_lidar,
                  refined.covariance,
                  {},
                  {});
}

void ExpectFirst(const GivenSession& session, const char* cause, const char* remedy) {
  const Diagnosis diagnosis = DiagnosisOf(session);
  ASSERT_FALSE(diagnosis.findings.empty()) << cause;
  EXPECT_EQ(diagnosis.findings[0].cause, cause) << diagnosis.findings[0].text;
  EXPECT_THAT(diagnosis.findings[0].text, HasSubstr(remedy));
  EXPECT_TRUE(diagnosis.findings[0].must_be_mended);
}

TEST(Diagnose, AsksNothingOfACleanSession) {
  EXPECT_TRUE(DiagnosisOf(CleanSession()).findings.empty());
}

TEST(Diagnose, FindsOneWrongFocalLength) {
  GivenSession session = CleanSession();
  session.camera.fx_px *= 1.02;
  SeeBoardsAgain(&session);
  ExpectFirst(session, "focal length fx", "camera.fx_px: ");
}

TEST(Diagnose, FindsAWrongCoefficientOfTheLens) {
  GivenSession session = CleanSession();
  session.camera.distortion[0] += 0.05;
  SeeBoardsAgain(&session);
  ExpectFirst(session, "distortion", "camera.distortion: [-0.05");
}

TEST(Diagnose, FindsAPatternThatIsElsewhereOnThePlate) {
  GivenSession session = CleanSession();
  session.board.pattern_offset_x_m += 0.02;
  SeeBoardsAgain(&session);
  ExpectFirst(session, "pattern offset", "board.pattern_offset_x_m: ");
}

TEST(Diagnose, FindsTheSignOfAPatternOffset) {
  BoardSpec board = test::TestBoard();
  board.pattern_offset_x_m = 0.04;
  board.pattern_offset_y_m = 0.03;
  GivenSession session = CleanSession(board, test::TestCamera());
  session.board.pattern_offset_y_m = -0.03;
  SeeBoardsAgain(&session);
  ExpectFirst(session, "sign of the pattern offset", "pattern_offset_y_m: 0.03");
}

TEST(Diagnose, FindsAPatternThatLiesAcross) {
  GivenSession session = CleanSession();
  LayPatternAcross(&session);
  ExpectFirst(session, "pattern across the plate", "num_corners_x and num_corners_y");
}

TEST(Diagnose, FindsImagesThatAreRectified) {
  CameraModel straight = test::TestCamera();
  straight.lens = LensModel::kPlumbBob;
  straight.distortion = {};
  GivenSession session = CleanSession(test::TestBoard(), straight);
  session.camera.distortion = {-0.1, 0.05};
  SeeBoardsAgain(&session);
  ExpectFirst(session, "rectified images", "camera.distortion: [0, 0, 0, 0, 0]");
}

TEST(Diagnose, FindsTheOtherLensModel) {
  CameraModel fisheye = test::TestCamera();
  GivenSession session = CleanSession(test::TestBoard(), fisheye);
  session.camera.lens = LensModel::kPlumbBob;
  SeeBoardsAgain(&session);
  ExpectFirst(session, "lens model", "camera.lens_model: equidistant");
}

TEST(Diagnose, FindsAMirroredSensor) {
  GivenSession session = CleanSession();
  MirrorLidar(&session);
  ExpectFirst(session, "mirrored sensor", "right-handed");
}

TEST(Diagnose, FindsPairsThatAreShifted) {
  GivenSession session = CleanSession();
  ShiftPairs(1, &session);
  ExpectFirst(session, "shifted pairs", "the pair after it");
}

TEST(Diagnose, FindsAWidthThatWasMisMeasured) {
  GivenSession session = CleanSession();
  session.board.width_m += 0.02;
  ExpectFirst(session, "board's width", "board.width_m: ");
}

TEST(QuestionsAbout, TakesIntrinsicsOfAnotherImageSizeBack) {
  CameraModel half = test::TestCamera();
  for (double* number : {&half.fx_px, &half.fy_px, &half.cx_px, &half.cy_px}) *number *= 0.5;
  for (const RigQuestion& question : QuestionsAbout(test::TestBoard(), half)) {
    if (question.cause != "image size") continue;
    GivenSession session{test::TestBoard(), half, {}};
    question.undo(&session);
    EXPECT_NEAR(session.camera.fx_px, test::TestCamera().fx_px, 1e-9);
    return;
  }
  FAIL() << "not asked";
}

}  // namespace
}  // namespace voqcal
