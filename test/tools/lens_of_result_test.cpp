#include "calibrate/lens_of_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "result/result_file.hpp"
#include "support/synthetic_samples.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class LensDoubtTest : public ::testing::Test {
 protected:
  LensDoubtTest() {
    CalibrationResult result;
    result.camera = test::TestCamera();
    folder_.Write("extrinsic.yaml", ToYaml(result));
  }

  std::string DoubtOf(const CameraModel& camera) const { return LensDoubt(folder_.path(), camera); }

  test::TemporaryFolder folder_;
};

TEST_F(LensDoubtTest, HasNoneOfTheLensThatItWasMadeWith) {
  EXPECT_EQ(DoubtOf(test::TestCamera()), "");
}

TEST_F(LensDoubtTest, SaysHowFarAnotherLensIsFromIt) {
  CameraModel camera = test::TestCamera();
  camera.cx_px += 0.01 * camera.fx_px;  // 10 mrad in the middle of the image
  EXPECT_THAT(DoubtOf(camera),
              AllOf(HasSubstr("extrinsic.yaml was made with another lens than the rig file's"),
                    HasSubstr("rays differ by up to 1.33 deg"),
                    HasSubstr("An extrinsic goes with its lens")));
}

TEST_F(LensDoubtTest, SaysThatImagesAreOfAnotherSize) {
  CameraModel camera = test::TestCamera();
  camera.width_px /= 2;
  EXPECT_THAT(DoubtOf(camera), HasSubstr("was made with images of "));
}

TEST_F(LensDoubtTest, KnowsNothingOfOtherProgramsFiles) {
  folder_.Write("extrinsic.yaml",
                "T_camera_lidar: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}\n"
                "camera: front_left\n");
  EXPECT_EQ(DoubtOf(test::TestCamera()), "");
}

TEST_F(LensDoubtTest, NamesACameraThatIsNone) {
  folder_.Write("extrinsic.yaml", "camera: {lens_model: brown}\nmade_from: {}\n");
  EXPECT_THAT(test::ErrorOf([&] { DoubtOf(test::TestCamera()); }),
              HasSubstr("extrinsic.yaml:1: camera."));
}

}  // namespace
}  // namespace voqcal
