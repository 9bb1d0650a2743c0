#include "calibrate_lens/rig_with_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
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

constexpr char kSeveral[] =
    "cameras:  # two\n"
    "  left:\n"
    "    camera:\n"
    "      fx_px: 1\n"
    "    # ours\n"
    "    channels: {camera_image: LEFT}\n"
    "\n"
    "  right:  # new\n"
    "    camera_driver: {source: video}\n"
    "lidars:\n"
    "  left_one:\n"
    "    camera: 3";  // no end of the line

constexpr char kValues[] =
    "      lens_model: equidistant\n"
    "      width_px: 640\n"
    "      height_px: 400\n"
    "      fy_px: 425\n"
    "      cx_px: 322\n"
    "      cy_px: 197\n"
    "      distortion: [-0.05, -0.08, 0.09, -0.05]\n";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(RigWithCamera, PutsACameraIntoItsOwnSectionAndKeepsEveryOtherByte) {
  EXPECT_EQ(RigWithCamera(kSeveral, kCamera, "left"),
            Replaced(kSeveral, "      fx_px: 1\n", std::string(kValues) + "      fx_px: 420\n"));
  const std::string added = Replaced(kValues, "      fy_px", "      fx_px: 420\n      fy_px");
  EXPECT_EQ(RigWithCamera(kSeveral, kCamera, "right"),
            Replaced(kSeveral, "  right:  # new\n", "  right:  # new\n    camera:\n" + added));
}

TEST(RigWithCamera, EndsLinesAsTheFileDoes) {
  EXPECT_EQ(RigWithCamera("rig: r\r\n"
                          "camera:\r\n"
                          "  lens_model: plumb_bob\r\n"
                          "  width_px: 1  # px\r\n"
                          "  height_px: 2\r\n"
                          "  fx_px: 1\r\n"
                          "  fy_px: 1\r\n"
                          "  cx_px: 1\r\n"
                          "\r\n"
                          "lidar_driver: {source: folder}\r\n",
                          kCamera),
            "rig: r\r\n"
            "camera:\r\n"
            "  cy_px: 197\r\n"
            "  distortion: [-0.05, -0.08, 0.09, -0.05]\r\n"
            "  lens_model: equidistant\r\n"
            "  width_px: 640  # px\r\n"
            "  height_px: 400\r\n"
            "  fx_px: 420\r\n"
            "  fy_px: 425\r\n"
            "  cx_px: 322\r\n"
            "\r\n"
            "lidar_driver: {source: folder}\r\n");
}

TEST(RigWithCamera, RefusesWhatLinesDoNotTell) {
  for (const char* text : {"camera: {width_px: 640}\n",
                           "camera:\n  distortion: [0, 0,\n    0, 0]\n",
                           "camera:\n  distortion:\n    - 0\n"}) {
    EXPECT_THAT(test::ErrorOf([&] { RigWithCamera(text, kCamera); }), HasSubstr("yourself"))
        << text;
  }
  for (const char* text :
       {"cameras: {left: {}}\n", "cameras:\n  left: {camera: {}}\n", "rig: r\n"}) {
    EXPECT_THAT(test::ErrorOf([&] { RigWithCamera(text, kCamera, "left"); }),
                AllOf(HasSubstr("section cameras"), HasSubstr("yourself")))
        << text;
  }
}

}  // namespace
}  // namespace voqcal
