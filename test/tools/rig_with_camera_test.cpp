#include "calibrate_lens/rig_with_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

const CameraModel kCamera = test::SmallCamera(LensModel::kEquidistant);

TEST(RigWithCamera, ReplacesValuesAndKeepsTheRest) {
  EXPECT_EQ(RigWithCamera("rig: r  # mine\n"
                          "\n"
                          "camera:                # ours\n"
                          "    # of the front\n"
                          "    fx_px: 1           # not known\n"
                          "    T_camera_lidar_guess:\n"
                          "        translation_m: [0, 0, 0]\n"
                          "    distortion: [0, 0]\n"
                          "\n"
                          "# the lidar\n"
                          "lidar_driver: {source: folder}\n",
                          kCamera),
            "rig: r  # mine\n"
            "\n"
            "camera:                # ours\n"
            "    lens_model: equidistant\n"
            "    width_px: 640\n"
            "    height_px: 400\n"
            "    fy_px: 425\n"
            "    cx_px: 322\n"
            "    cy_px: 197\n"
            "    # of the front\n"
            "    fx_px: 420           # not known\n"
            "    T_camera_lidar_guess:\n"
            "        translation_m: [0, 0, 0]\n"
            "    distortion: [-0.05, -0.08, 0.09, -0.05]\n"
            "\n"
            "# the lidar\n"
            "lidar_driver: {source: folder}\n");
}

TEST(RigWithCamera, AddsTheSectionWhereThereIsNone) {
  EXPECT_EQ(RigWithCamera("rig: r\n", kCamera),
            "rig: r\n"
            "camera:\n"
            "  lens_model: equidistant\n"
            "  width_px: 640\n"
            "  height_px: 400\n"
            "  fx_px: 420\n"
            "  fy_px: 425\n"
            "  cx_px: 322\n"
            "  cy_px: 197\n"
            "  distortion: [-0.05, -0.08, 0.09, -0.05]\n");
}

TEST(RigWithCamera, RefusesWhatLinesDoNotTell) {
  for (const char* text : {"camera: {width_px: 640}\n",
                           "camera:\n  distortion: [0, 0,\n    0, 0]\n",
                           "camera:\n  distortion:\n    - 0\n"}) {
    EXPECT_THAT(test::ErrorOf([&] { RigWithCamera(text, kCamera); }), HasSubstr("yourself"))
        << text;
  }
}

}  // namespace
}  // namespace voqcal
