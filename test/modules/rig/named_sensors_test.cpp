// Rig files that have their sensors by name.
#include <algorithm>
#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "rig/rig.hpp"
#include "support/matchers.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kHead[] =  // 3 lines
    "rig: truck\n"
    "board: {width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 4, num_corners_y: 6}\n"
    "\n";
constexpr char kLens[] =
    "{lens_model: plumb_bob, width_px: 640, height_px: 480, fx_px: 500, fy_px: 501, cx_px: 320, "
    "cy_px: 240, distortion: [0.1, 0.2, 0, 0, 0.3]}";
constexpr char kSmallLens[] =
    "{lens_model: plumb_bob, width_px: 320, height_px: 240, fx_px: 250, fy_px: 251, cx_px: 160, "
    "cy_px: 120, distortion: [0, 0, 0, 0, 0]}";

// Lines 4 to 7, then 8 to 10.
constexpr char kLidars[] =
    "lidars:\n"
    "  front:\n"
    "    lidar_driver: {rate_hz: 20}\n"
    "  rear: {lidar_board_detector: {max_range_m: 20}}\n";
std::string Cameras() {
  return std::string("cameras:\n") + "  left: {camera: " + kLens + "}\n" +
         "  right: {camera: " + kSmallLens + ", channels: {camera_image: RIGHT}}\n";
}
std::string Truck() { return kHead + std::string(kLidars) + Cameras(); }

/// What LoadRig says of the file, without its folder.
std::string ErrorOf(const std::string& text, const std::string& place) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", text);
  std::string error = test::ErrorOf([&] { LoadRig(path + place); });
  const std::string prefix = folder.path().string() + "/";
  for (std::size_t at = 0; (at = error.find(prefix, at)) != std::string::npos;) {
    error.erase(at, prefix.size());
  }
  return error;
}

Rig Load(const std::string& text, const std::string& place) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", text);
  return LoadRig(path + place);
}

TEST(NamedSensors, APairIsAnOrdinaryRig) {
  const Rig rig = Load(Truck(), "#front,left");
  EXPECT_EQ(rig.name, "truck_front_left");
  EXPECT_EQ(rig.lidar_name, "front");
  EXPECT_EQ(rig.camera_name, "left");
  EXPECT_EQ(rig.lidar_driver.rate_hz, 20);
  EXPECT_EQ(rig.camera.fx_px, 500);
  EXPECT_EQ(rig.channels.lidar_points, "LIDAR_POINTS_front");
  EXPECT_EQ(rig.channels.camera_image, "CAMERA_IMAGE_left");
  EXPECT_EQ(rig.channels.camera_info, "CAMERA_INFO_left");
  EXPECT_EQ(rig.channels.lidar_board, "LIDAR_BOARD_front");
  EXPECT_EQ(rig.channels.calib_samples, "CALIB_SAMPLES_front_left");
  EXPECT_EQ(rig.channels.calib_command, "CALIB_COMMAND");  // the operator's, of all
}

TEST(NamedSensors, TheOrderOfThePairsNamesIsFree) {
  const Rig rig = Load(Truck(), "#right,rear");
  EXPECT_EQ(rig.lidar_name, "rear");
  EXPECT_EQ(rig.channels.camera_image, "RIGHT");
  EXPECT_EQ(rig.channels.camera_board, "CAMERA_BOARD_right");
}

TEST(NamedSensors, OptionsOfADetectorAreTheSensorsOwnOrElseShared) {
  const std::string text = Truck() + "lidar_board_detector: {max_range_m: 7}\n";
  EXPECT_EQ(Load(text, "#front,left").lidar_board_detector.max_range_m, 7);
  EXPECT_EQ(Load(text, "#rear,left").lidar_board_detector.max_range_m, 20);
}

TEST(NamedSensors, PrefixAndSharedNamesComeBeforeTheSensorsName) {
  const std::string text =
      Truck() + "lcm: {channel_prefix: A_}\nchannels: {lidar_points: SWEEPS, voq_sets: SETS}\n";
  const Rig rig = Load(text, "#front,right");
  EXPECT_EQ(rig.channels.lidar_points, "A_SWEEPS_front");
  EXPECT_EQ(rig.channels.camera_image, "A_RIGHT");
  EXPECT_EQ(rig.channels.voq_sets, "A_SETS_front_right");
}

TEST(NamedSensors, TheOnlyOnesNeedNoName) {
  const std::string text =
      std::string(kHead) + "lidars: {top: }\ncameras: {eye: {camera: " + kLens + "}}\n";
  const Rig rig = Load(text, "");
  EXPECT_EQ(rig.name, "truck");
  EXPECT_EQ(rig.channels.lidar_points, "LIDAR_POINTS_top");
  const std::string two_cameras = std::string(kHead) + "lidars: {top: }\n" + Cameras();
  EXPECT_EQ(Load(two_cameras, "#right").lidar_name, "top");
}

TEST(NamedSensors, WhereTheyAreOnTheRigTellsWhereTheyAreToEachOther) {
  const std::string text =
      std::string(kHead) +
      "lidars: {top: {T_rig_lidar_guess: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [1, 0, "
      "2]}}}"
      "\ncameras: {eye: {T_rig_camera_guess: {quaternion_xyzw: [0, 0, 1, 0], translation_m: [0, 0, "
      "1]}, camera: " +
      kLens + "}}\n";
  const auto guess = Load(text, "").T_camera_lidar_guess;
  ASSERT_TRUE(guess);
  // The camera is turned by half a turn about the rig's z.
  EXPECT_TRUE(guess->translation().isApprox(Eigen::Vector3d(-1, 0, 1)));
}

TEST(NamedSensors, AGuessWithoutThatOfTheOtherIsRemarkedUpon) {
  const std::string guess =
      "{quaternion_xyzw: [0, 0, 0, 1], translation_m: [1, 0, 2]}, lidar_driver: {rate_hz: 20}";
  std::string text = Truck();
  text.replace(
      text.find("\n    lidar_driver: {rate_hz: 20}"), 32, " {T_rig_lidar_guess: " + guess + "}");
  const Rig rig = Load(text, "#front,left");
  EXPECT_FALSE(rig.T_camera_lidar_guess);
  ASSERT_EQ(rig.remarks.size(), 1U);
  EXPECT_THAT(rig.remarks[0],
              HasSubstr("rig.yaml:5: lidars.front.T_rig_lidar_guess is not used with left, which "
                        "has no T_rig_camera_guess"));
  EXPECT_TRUE(Load(text, "#rear,left").remarks.empty());
}

TEST(NamedSensors, SharedOptionsAreCheckedThoughASensorHasItsOwn) {
  EXPECT_THAT(ErrorOf(Truck() + "lidar_board_detector: {max_rnage_m: 7}\n", "#rear,left"),
              HasSubstr("rig.yaml:11: lidar_board_detector.max_rnage_m is not a known key"));
}

TEST(NamedSensors, ALensMayStillHaveToBeFoundWhicheverLidarIsBesideIt) {
  const test::TemporaryFolder folder;
  const std::string path =
      folder.Write("rig.yaml",
                   std::string(kHead) + kLidars +
                       "cameras: {left: {camera: {width_px: 640, height_px: 480}}}\n");
  LensInRig lens;
  const Rig rig = LoadRig(path, &lens);
  EXPECT_FALSE(lens.camera);
  EXPECT_EQ(rig.camera.width_px, 640);
  EXPECT_EQ(rig.channels.camera_image, "CAMERA_IMAGE_left");
}

TEST(NamedSensors, EveryPairIsListedOrThoseOfTheSensorsThatAreNamed) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", Truck());
  const auto names = [&path](const std::string& place) {
    std::vector<std::string> found;
    for (const Rig& rig : LoadPairs(path + place)) found.push_back(rig.name);
    return found;
  };
  EXPECT_THAT(
      names(""),
      ElementsAre("truck_front_left", "truck_front_right", "truck_rear_left", "truck_rear_right"));
  EXPECT_THAT(names("#right"), ElementsAre("truck_front_right", "truck_rear_right"));
  EXPECT_THAT(names("#front,rear,left"), ElementsAre("truck_front_left", "truck_rear_left"));
  EXPECT_EQ(PairsOfRig(path)[3], path + "#rear,right");
}

TEST(NamedSensors, AFileOfOneOfEachHasOnePair) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", std::string(kHead) + "camera: " + kLens + "\n");
  const std::vector<Rig> rigs = LoadPairs(path);
  ASSERT_EQ(rigs.size(), 1U);
  EXPECT_EQ(rigs[0].name, "truck");
  EXPECT_EQ(rigs[0].lidar_name, "lidar");
  EXPECT_EQ(rigs[0].channels.lidar_points, "LIDAR_POINTS");
}

TEST(NamedSensors, AFileWhoseNameHasAHashIsThatFile) {
  const test::TemporaryFolder folder;
  const std::string path =
      folder.Write("rig#1.yaml", std::string(kHead) + "camera: " + kLens + "\n");
  EXPECT_EQ(LoadRig(path).name, "truck");
  EXPECT_TRUE(PlaceOfRig(path).names.empty());
}

TEST(NamedSensors, OneOfSeveralPairsMustBeNamed) {
  EXPECT_EQ(ErrorOf(Truck(), ""),
            "rig.yaml: has lidars front, rear; cameras left, right: name a pair of them, as in "
            "rig.yaml#front,left (tools/up, calibrate_rig and check_rig take them all)");
  EXPECT_THAT(ErrorOf(Truck(), "#rear"), HasSubstr("name a pair of them"));
  EXPECT_EQ(ErrorOf(Truck(), "#front,rear"),
            "rig.yaml: front and rear are both lidars: a pair is a lidar and a camera");
}

TEST(NamedSensors, TheFileItselfMayNameThePair) {
  const std::string text = Truck() + "pair: rear,left\n";
  EXPECT_EQ(Load(text, "").name, "truck_rear_left");
  EXPECT_EQ(Load(text, "#front,right").name, "truck_front_right");
  EXPECT_THAT(ErrorOf(Truck() + "pair: rear,lef\n", ""), HasSubstr("has no sensor 'lef'"));
}

TEST(NamedSensors, NamesOfNoneAreToldWithThoseThatThereAre) {
  EXPECT_EQ(ErrorOf(Truck(), "#frnt,left"),
            "rig.yaml: has no sensor 'frnt' (did you mean front?); it has lidars front, rear; "
            "cameras left, right");
  const std::string one = std::string(kHead) + "camera: " + kLens + "\n";
  EXPECT_EQ(ErrorOf(one, "#front,left"),
            "rig.yaml: has no sensor 'front'; it has one lidar and one camera, neither by name: "
            "leave out what follows #");
}

TEST(NamedSensors, TwoSensorsOnOneChannelAreRefusedWhicheverPairIsRead) {
  const std::string text = kHead + std::string(kLidars) + "cameras:\n  left: {camera: " + kLens +
                           ", channels: {camera_image: EYE}}\n  right: {camera: " + kLens +
                           ",\n    channels: {camera_image: EYE}}\n";
  for (const char* pair : {"#front,left", "#rear,right"}) {
    EXPECT_EQ(ErrorOf(text, pair),
              "rig.yaml:11: cameras.right.channels.camera_image must differ from other channels, "
              "is \"EYE\"");
  }
}

TEST(NamedSensors, BothFormsAtOnceAreRefused) {
  EXPECT_EQ(
      ErrorOf(Truck() + "camera: " + kLens + "\nlidar_driver: {rate_hz: 5}\n", "#front,left"),
      "rig.yaml:11: camera must be in a sensor's own section, cameras.NAME, beside lidars and "
      "cameras, is a section\n"
      "rig.yaml:12: lidar_driver must be in a sensor's own section, lidars.NAME, beside "
      "lidars and cameras, is a section");
}

TEST(NamedSensors, BothKindsMustBeGivenByUniqueNames) {
  EXPECT_EQ(ErrorOf(kHead + std::string(kLidars), ""),
            "rig.yaml:1: cameras must have a section for each, under its name, is not given");
  EXPECT_EQ(ErrorOf(kHead + std::string("lidars: {a b: , c: }\ncameras: {c: }\n"), ""),
            "rig.yaml:4: lidars.a b must be named by a letter, then letters, digits and _ alone, "
            "is empty\n"
            "rig.yaml:5: cameras.c must be named unlike every other sensor, is empty");
}

TEST(NamedSensors, NamesThatYamlReadsAsSomethingElseAreRefused) {
  for (const char* word : {"no", "Off", "TRUE", "y"}) {
    EXPECT_THAT(ErrorOf(kHead + std::string("lidars: {") + word + ": }\ncameras: {c: }\n", ""),
                HasSubstr(std::string("rig.yaml:4: lidars.") + word +
                          " must be named otherwise: YAML has a meaning for that word"));
  }
  for (const char* word : {"1e3", "_a", "0x1"}) {
    EXPECT_THAT(ErrorOf(kHead + std::string("lidars: {") + word + ": }\ncameras: {c: }\n", ""),
                HasSubstr(std::string("lidars.") + word + " must be named by a letter"));
  }
}

TEST(NamedSensors, TwoPairsOfOneNameAreRefused) {
  EXPECT_EQ(ErrorOf(kHead + std::string("lidars: {a: , a_b: }\ncameras: {b_c: , c: }\n"), "#a,c"),
            "rig.yaml:5: cameras must not make pairs of one name: a with b_c and a_b with c are "
            "both a_b_c, is a section");
}

TEST(NamedSensors, WhatASensorLacksIsToldAtItsEntry) {
  const std::string no_size = kHead + std::string(kLidars) +
                              "cameras:\n  left:\n    camera: {lens_model: plumb_bob, fx_px: 500, "
                              "fy_px: 501,\n      cx_px: "
                              "320, cy_px: 240, distortion: [0.1, 0.2, 0, 0, 0.3]}\n";
  EXPECT_EQ(ErrorOf(no_size, "#front"),
            "rig.yaml:10: cameras.left.camera.width_px is missing\n"
            "rig.yaml:10: cameras.left.camera.height_px is missing");
  EXPECT_THAT(
      ErrorOf(kHead + std::string(kLidars) + "cameras: {left: {camra: " + kLens + "}}\n", "#front"),
      HasSubstr("rig.yaml:8: cameras.left.camra is not a known key: did you mean camera?"));
}

TEST(NamedSensors, AGuessOfOnePairIsRefused) {
  const std::string guess =
      ", T_camera_lidar_guess: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}}";
  std::string text = Truck();
  text.insert(text.find("}}\n  right"), guess.substr(0, guess.size() - 1));
  EXPECT_THAT(ErrorOf(text, "#front,left"),
              HasSubstr("cameras.left.camera.T_camera_lidar_guess is of one lidar: give "
                        "lidars.front.T_rig_lidar_guess and cameras.left.T_rig_camera_guess"));
}

TEST(NamedSensors, AProgramOfOneSensorIsGivenThatAlone) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", Truck());
  const Rig lidar = LoadRig(path + "#rear", SensorChoice::kLidar);
  EXPECT_EQ(lidar.channels.lidar_points, "LIDAR_POINTS_rear");
  EXPECT_EQ(lidar.lidar_board_detector.max_range_m, 20);
  EXPECT_EQ(LoadRig(path + "#right", SensorChoice::kCamera).channels.camera_image, "RIGHT");
  const std::string error = test::ErrorOf([&] { LoadRig(path, SensorChoice::kCamera); });
  EXPECT_THAT(error, HasSubstr("cameras left, right: name a camera, as in " + path + "#left"));
}

TEST(NamedSensors, TheFileItselfMayNameThoseThatAreMeant) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", Truck() + "sensors: rear,left,right\n");
  EXPECT_THAT(SensorsOfRig(path).lidars, ElementsAre("rear"));
  EXPECT_THAT(PairsOfRig(path), ElementsAre(path + "#rear,left", path + "#rear,right"));
  EXPECT_THAT(PairsOfRig(path + "#front,left"), ElementsAre(path + "#front,left"));
}

TEST(NamedSensors, APairLineIsASessionsAndDoesNotNarrowTheRig) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("rig.yaml", Truck() + "pair: rear,left\n");
  EXPECT_THAT(PairsOfRig(path), ElementsAre(path + "#rear,left"));
  EXPECT_THAT(PairsOfRig(path, PairLine::kIsIgnored), ::testing::SizeIs(4));
  EXPECT_EQ(LoadRig(path).lidar_name, "rear");
  const std::string both =
      folder.Write("both.yaml", Truck() + "pair: rear,left\nsensors: rear,left,right\n");
  for (const PairLine line : {PairLine::kChooses, PairLine::kIsIgnored}) {
    EXPECT_THAT(test::ErrorOf([&] { PairsOfRig(both, line); }),
                HasSubstr("pair must not stand beside sensors"));
  }
}

/// Lines 4 to 6, 7 to 9, and the world in line 10.
std::string SimulatedTruck() {
  const std::string place = "{quaternion_xyzw: [0, 0, 0, 1], translation_m: [1, 2, 3]}";
  const std::string lidar = "lidar_driver: {source: simulator}, simulation: {T_rig_lidar: " + place;
  const std::string camera =
      ", camera_driver: {source: simulator}, simulation: {T_rig_camera: " + place + "}}\n";
  return kHead + std::string("lidars:\n") + "  front: {" + lidar + "}}\n  rear: {" + lidar +
         ", pattern: raster}}\ncameras:\n  left: {camera: " + kLens + camera +
         "  right: {camera: " + kSmallLens + camera + "simulation: {num_poses: 7}\n";
}

TEST(NamedSensors, OneWorldIsSimulatedForAllWhicheverIsRead) {
  for (const char* place : {"#front,left", "#rear,right"}) {
    const Rig rig = Load(SimulatedTruck(), place);
    const RigSimulationOptions& world = rig.simulated_rig;
    EXPECT_EQ(world.world.num_poses, 7);
    ASSERT_EQ(world.lidars.size(), 2U);
    EXPECT_EQ(world.lidars[0].name, "front");
    EXPECT_EQ(world.lidars[0].scan.pattern, ScanPattern::kVlp16);
    EXPECT_EQ(world.lidars[1].scan.pattern, ScanPattern::kRaster);
    ASSERT_EQ(world.cameras.size(), 2U);
    EXPECT_EQ(world.cameras[0].model.fx_px, 500);
    EXPECT_EQ(world.cameras[1].model.fx_px, 250);
    EXPECT_EQ(world.lidars[1].T_rig_lidar.translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(world.cameras[1].T_camera_rig.translation(), Eigen::Vector3d(-1, -2, -3));
  }
  EXPECT_TRUE(Load(Truck(), "#front,left").simulated_rig.lidars.empty());
}

TEST(NamedSensors, TwoWorldsAreRefused) {
  std::string mixed = SimulatedTruck();
  mixed.replace(mixed.find("source: simulator"), 17, "source: velodyne_vlp16");
  EXPECT_EQ(ErrorOf(mixed, "#rear,right"),
            "rig.yaml:5: lidars.front.lidar_driver.source must be simulator, as that of other "
            "sensors is: all are of one world, is \"velodyne_vlp16\"");
  std::string own = SimulatedTruck();
  own.replace(own.find("pattern: raster"), 15, "seed: 2");
  EXPECT_THAT(ErrorOf(own, "#front,left"),
              HasSubstr("rig.yaml:6: lidars.rear.simulation.seed is not a known key"));
  std::string of_a_pair = SimulatedTruck();
  of_a_pair.replace(of_a_pair.find("num_poses: 7"), 12, "follows_guidance: true");
  EXPECT_THAT(ErrorOf(of_a_pair, "#front,left"),
              HasSubstr("rig.yaml:10: simulation.follows_guidance is of one pair"));
  std::string nowhere = SimulatedTruck();
  nowhere.replace(nowhere.find("T_rig_camera"), 12, "T_rig_camra");
  EXPECT_THAT(ErrorOf(nowhere, "#front,right"),
              HasSubstr("rig.yaml:8: cameras.left.simulation.T_rig_camera is missing"));
}

TEST(NamedSensors, EachProblemOfAllPairsIsToldOnce) {
  const test::TemporaryFolder folder;
  std::string text = Truck();
  text.replace(text.find("width_m: 0.6"), 12, "width_m: -1");
  text.replace(text.find("max_range_m: 20"), 15, "max_range_m: x");
  const std::string path = folder.Write("rig.yaml", text);
  const std::string error = test::ErrorOf([&] { LoadPairs(path); });
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_THAT(error, HasSubstr("rig.yaml:2: board: width_m"));
  EXPECT_THAT(error, HasSubstr("rig.yaml:7: lidars.rear.lidar_board_detector.max_range_m"));
}

TEST(NamedSensors, EachRemarkOnTheFileIsToldOnce) {
  const test::TemporaryFolder folder;
  const std::string path =
      folder.Write("rig.yaml", Truck() + "assessor: {scene_check: {min_contrast: 3}}\n");
  std::ostringstream told;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "told", std::make_shared<spdlog::sinks::ostream_sink_st>(told)));
  const std::vector<Rig> rigs = LoadPairs(path);
  spdlog::set_default_logger(before);
  ASSERT_EQ(rigs.size(), 4U);
  EXPECT_EQ(rigs[3].remarks.size(), 1U);
  const std::string text = told.str();
  EXPECT_THAT(text, HasSubstr("rig.yaml:11: "));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

}  // namespace
}  // namespace voqcal
