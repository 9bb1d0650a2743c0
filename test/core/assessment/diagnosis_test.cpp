#include "core/assessment/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/assessment/suspects.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/estimation/refine.hpp"
#include "core/geometry/rigid.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// A session of 30 poses with a VLP-16's noise; what was given may differ from what is true.
class Session {
 public:
  Session() : samples_(test::SynthesizeSamples(Noisy())) {}
  explicit Session(const test::SyntheticSamplesOptions& options)
      : samples_(test::SynthesizeSamples(options)) {}

  static test::SyntheticSamplesOptions Noisy() {
    test::SyntheticSamplesOptions options;
    options.lidar_rotation_noise_rad = 0.005;
    options.lidar_centre_noise_m = 0.003;
    options.edge_noise_m = 0.005;
    return options;
  }

  /// The diagnosis of what a calibration with the given board and camera makes of the true ones.
  Diagnosis Run() {
    test::Random random(7);
    for (BoardSample& sample : samples_) SeeByCamera(&sample, &random);
    const auto samples = test::Pointers(samples_);
    const RefinedExtrinsic refined =
        RefineExtrinsic(samples, given_camera, test::TestExtrinsic(), {});
    EXPECT_TRUE(refined.IsUsable());
    return Diagnose(samples,
                    num_inconsistent,
                    given_board,
                    given_camera,
                    refined.T_camera_lidar,
                    covariance_scale * refined.covariance,
                    range_offset,
                    {});
  }

  /// Every range reads too long by this.
  void OffsetRanges(double offset_m) {
    for (BoardSample& sample : samples_) {
      BoardPose& pose = sample.lidar.pose;
      pose.centre_m *= 1 + offset_m / pose.centre_m.norm();
      for (Eigen::Vector3d& corner : pose.corners_m) corner *= 1 + offset_m / corner.norm();
      for (double& length_m : sample.lidar.edge_lengths_m) {
        length_m *= 1 + offset_m / pose.centre_m.norm();
      }
    }
  }
  std::vector<BoardSample>& samples() { return samples_; }

  BoardSpec true_board = test::TestBoard();
  BoardSpec given_board = test::TestBoard();
  CameraModel true_camera = test::TestCamera();
  CameraModel given_camera = test::TestCamera();
  int num_inconsistent = 0;
  double covariance_scale = 1.0;  ///< Of what the result says of itself.
  std::size_t num_hidden = 0;     ///< Corners of each board that the camera does not see.
  BiasEstimate range_offset;      ///< Taken out.

 private:
  void SeeByCamera(BoardSample* sample, test::Random* random) const {
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample->camera.pose);
    sample->camera.corners_px.clear();
    for (const Eigen::Vector3d& corner : true_board.InnerCornersBoardM()) {
      const Eigen::Vector3d corner_camera_m = T_camera_board * corner;
      const Eigen::Vector2d noise_px(random->Normal(), random->Normal());
      sample->camera.corners_px.push_back(true_camera.Project(corner_camera_m) + 0.1 * noise_px);
    }
    const auto fit =
        FitPlanarPose(given_camera, given_board.InnerCornersBoardM(), sample->camera.corners_px);
    ASSERT_TRUE(fit);
    sample->camera.pose = PoseFromTransform(fit->T_camera_board, given_board);
    for (std::size_t k = 0; k < num_hidden; ++k) {
      sample->camera.corners_px[k].setConstant(std::nan(""));
    }
  }

  std::vector<BoardSample> samples_;
};

std::string FirstCause(const Diagnosis& diagnosis) {
  return diagnosis.findings.empty() ? "none" : diagnosis.findings[0].cause;
}

TEST(Diagnose, FindsNothingInACleanSession) {
  VOQCAL_LEAVE_TO_RELEASE();
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    test::SyntheticSamplesOptions options = Session::Noisy();
    options.seed = seed;
    const Diagnosis diagnosis = Session(options).Run();
    EXPECT_THAT(diagnosis.findings, IsEmpty()) << seed << ": " << diagnosis.findings[0].text;
  }
}

TEST(Diagnose, SaysOfEachGroupOnceWhatCouldHide) {
  Session session;
  session.covariance_scale = 1e-3;  // so sure that anything moves it by more
  const Diagnosis diagnosis = session.Run();
  EXPECT_THAT(diagnosis.not_judged, Contains(StartsWith("principal point: an error of ")));
  EXPECT_THAT(diagnosis.not_judged, Not(Contains(HasSubstr("leave it open"))));
  const auto num_of = [&diagnosis](const std::string& group) {
    return std::count_if(diagnosis.not_judged.begin(),
                         diagnosis.not_judged.end(),
                         [&group](const auto& text) { return text.rfind(group, 0) == 0; });
  };
  EXPECT_EQ(num_of("focal length"), 1);
  EXPECT_EQ(num_of("distortion"), 1);
}

// From one place, where the plate ends is not seen: an offset could be as large as the plate.
TEST(Diagnose, WhatCouldBeLargerThanPossibleIsOpen) {
  test::SyntheticSamplesOptions options = Session::Noisy();
  options.num_samples = 5;
  options.max_tilt_rad = 0.02;
  const Diagnosis diagnosis = Session(options).Run();
  EXPECT_THAT(diagnosis.not_judged,
              Contains(AllOf(HasSubstr("pattern offset"), HasSubstr("leave it open"))));
  EXPECT_THAT(diagnosis.not_judged, Not(Contains(StartsWith("pattern offset: an error"))));
}

TEST(Diagnose, FindsAWrongFocalLength) {
  Session session;
  session.given_camera.fx_px *= 1.02;
  session.given_camera.fy_px *= 1.02;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "focal length");
  const Finding& finding = diagnosis.findings[0];
  // True = given * (1 + value): 1 / 1.02 - 1. The fit is linear about it: a tenth of it is left.
  EXPECT_NEAR(finding.value, -1.96, 3 * finding.standard_error + 0.1);
  EXPECT_THAT(finding.text, AllOf(HasSubstr("too long"), HasSubstr("held out, it falls from")));
  EXPECT_GT(finding.explained, 0.1);
  // What is left is noise: 3 mm an axis, 4.8 mm in space, and a little for the parameters.
  EXPECT_THAT(diagnosis.not_judged, Each(Not(HasSubstr("focal length"))));  // it is a finding
  EXPECT_LT(finding.held_out_after_mm, 6);
  EXPECT_GT(finding.held_out_before_mm, 8);
}

TEST(Diagnose, FindsAWrongFocalLengthByBoardsThatAreSeenInPart) {
  Session session;
  session.num_hidden = 8;
  session.given_camera.fx_px *= 1.02;
  session.given_camera.fy_px *= 1.02;
  EXPECT_EQ(FirstCause(session.Run()), "focal length");
}

TEST(Diagnose, FindsAWrongPrincipalPoint) {
  Session session;
  session.given_camera.cx_px -= 60;
  session.given_camera.cy_px += 30;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "principal point");
  const Finding& finding = diagnosis.findings[0];
  EXPECT_NEAR(finding.value, 67, 3 * finding.standard_error + 2);
}

// The rotation makes it good: where the centres are seems to be right, and normals tell.
TEST(Diagnose, FindsAPrincipalPointThatTheCentresDoNotShow) {
  Session session;
  session.given_camera.cx_px -= 12;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "principal point");
  const Finding& finding = diagnosis.findings[0];
  EXPECT_NEAR(finding.value, 12, 3 * finding.standard_error + 2);
  EXPECT_GT(finding.held_out_after_mm, 0.9 * finding.held_out_before_mm);
}

TEST(Diagnose, WhatMayMoveTheResultBeyondItsIntervalMustBeMended) {
  VOQCAL_LEAVE_TO_RELEASE();
  const auto with_covariance = [](double scale) {
    Session session;
    session.covariance_scale = scale;
    session.given_camera.fx_px *= 1.02;
    session.given_camera.fy_px *= 1.02;
    return session.Run();
  };
  const double moved = with_covariance(1.0).findings.at(0).moved_intervals;
  const Diagnosis nearly = with_covariance(std::pow(moved / 0.97, 2));
  ASSERT_EQ(FirstCause(nearly), "focal length");
  EXPECT_NEAR(nearly.findings[0].moved_intervals, 0.97, 1e-3);
  EXPECT_TRUE(nearly.findings[0].must_be_mended);
  EXPECT_EQ(FirstCause(with_covariance(std::pow(moved / 0.5, 2))), "none");
}

// Alone, the squares are not worth a word, and the principal point would be an advice.
TEST(Diagnose, WhatIsSeenOnlyBesideAnotherFaultComesAfterIt) {
  Session session;
  session.given_camera.cy_px -= 13;
  session.given_board.square_m *= 1.0064;
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(2));
  EXPECT_EQ(diagnosis.findings[0].cause, "principal point");
  EXPECT_TRUE(diagnosis.findings[0].must_be_mended);
  EXPECT_EQ(diagnosis.findings[1].cause, "board's squares");
}

TEST(Diagnose, FindsSquaresThatWereMisMeasured) {
  Session session;
  session.given_board.square_m *= 1.02;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "board's squares");
  EXPECT_NEAR(diagnosis.findings[0].value, -1.96, 3 * diagnosis.findings[0].standard_error + 0.1);
  EXPECT_THAT(diagnosis.findings.front().text, HasSubstr("measure ten squares in a row"));
}

TEST(SuspectsOf, ALensWithoutCoefficientsIsToBeCalibrated) {
  CameraModel camera = test::TestCamera();
  const auto last_remedy = [&] { return SuspectsOf(test::TestBoard(), camera).back().remedy({}); };
  EXPECT_THAT(last_remedy(), Not(HasSubstr("calibrate_lens")));
  camera.distortion = {};
  EXPECT_THAT(last_remedy(), HasSubstr("calibrate_lens"));
}

TEST(Diagnose, FindsAnOutlineThatWasMisMeasured) {
  Session session;
  session.given_board.width_m += 0.04;
  session.given_board.height_m += 0.04;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "board's outline");
  EXPECT_NEAR(diagnosis.findings[0].value, 40, 2);  // 5 mm of noise over 120 edges
}

TEST(Diagnose, FindsARangeOffset) {
  Session session;
  session.OffsetRanges(0.05);
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "lidar range offset");
  EXPECT_NEAR(diagnosis.findings[0].value, 50, 3 * diagnosis.findings[0].standard_error + 2);
}

TEST(Diagnose, FindsTheSampleThatMoved) {
  Session session;
  for (Eigen::Vector3d* point : {&session.samples()[4].lidar.pose.centre_m,
                                 &session.samples()[4].lidar.pose.corners_m[0],
                                 &session.samples()[4].lidar.pose.corners_m[1],
                                 &session.samples()[4].lidar.pose.corners_m[2],
                                 &session.samples()[4].lidar.pose.corners_m[3]}) {
    *point += Eigen::Vector3d(0.0, 0.05, 0.0);
  }
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "moving sample");
  EXPECT_THAT(diagnosis.findings, SizeIs(1));
  EXPECT_THAT(diagnosis.findings[0].text, HasSubstr("sample 5 is"));
}

TEST(Diagnose, SaysThatSamplesContradictTheOthers) {
  Session session;
  session.num_inconsistent = 3;
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "moving sample");
  EXPECT_THAT(diagnosis.findings[0].text, HasSubstr("3 of 33 samples"));
}

TEST(Diagnose, FindsTooFewPoses) {
  test::SyntheticSamplesOptions options = Session::Noisy();
  options.num_samples = 5;
  EXPECT_EQ(FirstCause(Session(options).Run()), "too few or too similar poses");
}

TEST(Diagnose, FindsPosesThatAreTooSimilar) {
  test::SyntheticSamplesOptions options = Session::Noisy();
  options.max_tilt_rad = 0.05;
  options.spread = 0.1;
  const Diagnosis diagnosis = Session(options).Run();
  ASSERT_EQ(FirstCause(diagnosis), "too few or too similar poses");
}

TEST(Diagnose, FindsTwoFaultsAtOnce) {
  Session session;
  session.given_camera.fx_px *= 1.02;
  session.given_camera.fy_px *= 1.02;
  session.OffsetRanges(0.05);
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(2));
  EXPECT_THAT((std::vector<std::string>{diagnosis.findings[0].cause, diagnosis.findings[1].cause}),
              ::testing::UnorderedElementsAre("focal length", "lidar range offset"));
}

TEST(Diagnose, AnOffsetThatWasTakenOutIsNoFindingAndHidesNoOther) {
  Session session;
  session.given_camera.fx_px *= 1.02;
  session.given_camera.fy_px *= 1.02;
  session.OffsetRanges(0.05);
  session.range_offset = {0.05, 0.012, true};
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(1));
  EXPECT_EQ(diagnosis.findings[0].cause, "focal length");
  EXPECT_NEAR(diagnosis.findings[0].value, -2.0, 3 * diagnosis.findings[0].standard_error);
}

TEST(Diagnose, AnOffsetThatNoLidarHasIsAFinding) {
  Session session;
  session.range_offset = {-0.05, 0.004, true};
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(1));
  EXPECT_EQ(diagnosis.findings[0].cause, "lidar range offset");
  EXPECT_THAT(diagnosis.findings[0].text, HasSubstr("too large look the same"));
  session.range_offset.standard_error_m = 0.015;  // may be 20 mm
  EXPECT_THAT(session.Run().findings, IsEmpty());
}

// The result hardly moves, as it has the offset instead of the squares.
TEST(Diagnose, AnOffsetThatNoLidarHasIsThatOfWrongSquares) {
  Session session;
  session.covariance_scale = 1e3;
  session.given_board.square_m *= 1.02;
  session.range_offset = {-0.06, 0.004, true};
  const Diagnosis diagnosis = session.Run();
  ASSERT_EQ(FirstCause(diagnosis), "board's squares");
  EXPECT_NEAR(diagnosis.findings[0].value, -1.96, 3 * diagnosis.findings[0].standard_error + 0.1);
  EXPECT_TRUE(diagnosis.findings[0].must_be_mended);
  EXPECT_THAT(diagnosis.findings[0].text, HasSubstr("-60 mm were taken out"));
  EXPECT_THAT(diagnosis.findings, SizeIs(1));  // and that is the offset
}

// With the result's prior it is less than half of what the samples say.
TEST(Diagnose, RangesOfABrokenLidarAreNeitherWrongSquaresNorAWrongOutline) {
  Session session;
  session.covariance_scale = 1e3;
  session.OffsetRanges(0.2);
  session.range_offset = {0.09, 0.006, true};
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(1));
  EXPECT_EQ(diagnosis.findings[0].cause, "lidar range offset");
}

// Squares that are nearly right explain a little of it, and are not its cause.
TEST(Diagnose, AnOffsetThatSquaresExplainInPartIsTheLidars) {
  Session session;
  session.covariance_scale = 1e3;
  session.OffsetRanges(0.035);
  session.given_board.square_m *= 0.996;
  session.range_offset = {0.04, 0.004, true};
  const Diagnosis diagnosis = session.Run();
  ASSERT_THAT(diagnosis.findings, SizeIs(1));
  EXPECT_EQ(diagnosis.findings[0].cause, "lidar range offset");
}

TEST(Diagnose, SaysWhatItCannotJudgeWithoutCorners) {
  const auto samples = test::SynthesizeSamples(Session::Noisy());
  const Diagnosis diagnosis = Diagnose(test::Pointers(samples),
                                       0,
                                       test::TestBoard(),
                                       test::TestCamera(),
                                       test::TestExtrinsic(),
                                       1e-6 * Matrix6d::Identity(),
                                       {},
                                       {});
  EXPECT_THAT(diagnosis.findings, IsEmpty());
  EXPECT_THAT(diagnosis.not_judged, ::testing::Contains(HasSubstr("focal length")));
  EXPECT_THAT(diagnosis.not_judged, ::testing::Contains(HasSubstr("time offset")));
}

TEST(Diagnose, NoSamplesAreTooFewPoses) {
  EXPECT_EQ(FirstCause(Diagnose({},
                                0,
                                test::TestBoard(),
                                test::TestCamera(),
                                Eigen::Isometry3d::Identity(),
                                Matrix6d::Identity(),
                                {},
                                {})),
            "too few or too similar poses");
}

TEST(DiagnosisOptions, NamesEachProblem) {
  DiagnosisOptions options;
  options.min_moved_intervals = 0;
  options.max_outlier_factor = -1;
  EXPECT_THAT(options.Problems(),
              ::testing::ElementsAre("min_moved_intervals must be positive, is 0",
                                     "max_outlier_factor must be positive, is -1"));
}

}  // namespace
}  // namespace voqcal
