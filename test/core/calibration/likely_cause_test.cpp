#include "core/calibration/likely_cause.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/assessment/given_session.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

GivenSession CleanSession(const CameraModel& camera) {
  test::SyntheticSamplesOptions options;
  options.num_samples = 18;
  options.lidar_centre_noise_m = 0.003;
  GivenSession session{test::TestBoard(), camera, test::SynthesizeSamples(options)};
  for (BoardSample& sample : session.samples) {
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    sample.camera.corners_px.clear();
    for (const Eigen::Vector3d& corner_board_m : session.board.InnerCornersBoardM()) {
      const Eigen::Vector3d corner_camera_m = T_camera_board * corner_board_m;
      sample.camera.corners_px.push_back(session.camera.Project(corner_camera_m));
    }
  }
  return session;
}

GivenSession CleanSession() { return CleanSession(test::TestCamera()); }

std::string CauseOf(const GivenSession& session) {
  CalibrationTask task;
  task.board = session.board;
  task.camera = session.camera;
  const auto likely = LikelyCause(session.samples, task);
  return likely ? likely->cause + ": " + likely->text : "";
}

TEST(LikelyCause, SaysNothingWhereSamplesAgree) { EXPECT_THAT(CauseOf(CleanSession()), IsEmpty()); }

TEST(LikelyCause, FindsPairsThatAreShifted) {
  for (const int by : {1, -1}) {
    GivenSession session = CleanSession();
    ShiftPairs(by, &session);
    EXPECT_THAT(CauseOf(session), HasSubstr("shifted pairs")) << by;
  }
}

TEST(LikelyCause, FindsAMirroredSensor) {
  GivenSession session = CleanSession();
  MirrorLidar(&session);
  EXPECT_THAT(CauseOf(session), HasSubstr("mirrored sensor"));
}

TEST(LikelyCause, FindsIntrinsicsOfAnotherImageSize) {
  CameraModel straight = test::TestCamera();  // a fisheye of half the size folds over
  straight.lens = LensModel::kPlumbBob;
  straight.distortion = {};
  GivenSession session = CleanSession(straight);
  CameraModel& camera = session.camera;
  for (double* number : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    *number *= 0.5;
  SeeBoardsAgain(&session);
  EXPECT_THAT(CauseOf(session), HasSubstr("image size"));
}

TEST(LikelyCause, FindsTheDecimalPointOfTheSquares) {
  GivenSession session = CleanSession();
  session.board.square_m *= 0.1;
  SeeBoardsAgain(&session);
  EXPECT_THAT(CauseOf(session), HasSubstr("board.square_m: "));
}

TEST(LikelyCause, FindsSquaresOfAnotherSize) {
  for (const double scale : {0.85, 1.18}) {
    GivenSession session = CleanSession();
    session.board.square_m *= scale;
    SeeBoardsAgain(&session);
    EXPECT_THAT(CauseOf(session), HasSubstr("board's squares")) << scale;
  }
}

TEST(LikelyCause, FindsAFocalLengthByTheLensThatTheImagesAskFor) {
  GivenSession session = CleanSession();
  session.camera.fx_px *= 1.15;
  SeeBoardsAgain(&session);
  EXPECT_THAT(CauseOf(session), HasSubstr("focal length fx"));
}

TEST(LikelyCause, BlamesNothingForPairsInDisorder) {
  GivenSession session = CleanSession();
  for (std::size_t i = 0; i < session.samples.size() / 2; ++i) {
    std::swap(session.samples[i].lidar, session.samples[session.samples.size() - 1 - i].lidar);
  }
  EXPECT_THAT(CauseOf(session), IsEmpty());
}

}  // namespace
}  // namespace voqcal
