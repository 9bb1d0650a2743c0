#include "rig/rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/sha256.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr char kHead[] = "rig: small\n";
constexpr char kBoard[] =
    "board: {width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 4, num_corners_y: 6}\n";
constexpr char kCamera[] =
    "camera: {lens_model: plumb_bob, width_px: 640, height_px: 480, fx_px: 500, fy_px: 501,\n"
    "  cx_px: 320, cy_px: 240, distortion: [0.1, 0.2, 0, 0, 0.3]}\n";

std::string Minimal() { return std::string(kHead) + kBoard + kCamera; }  // 4 lines

Rig Load(const std::string& text) {
  const test::TemporaryFolder folder;
  return LoadRig(folder.Write("rig.yaml", text));
}

/// The error without the folder of the file.
std::string LoadError(const std::string& text) {
  const test::TemporaryFolder folder;
  const auto path = folder.Write("rig.yaml", text);
  std::string error = test::ErrorOf([&] { LoadRig(path); });
  const std::string prefix = folder.path().string() + "/";
  for (std::size_t at = 0; (at = error.find(prefix, at)) != std::string::npos;) {
    error.erase(at, prefix.size());
  }
  return error;
}

TEST(LoadRig, NeedsOnlyNameBoardAndCamera) {
  const Rig rig = Load(Minimal());
  EXPECT_EQ(rig.name, "small");
  EXPECT_EQ(rig.sha256, Sha256OfBytes(Minimal()));
  EXPECT_EQ(rig.lcm_url, kDefaultLcmUrl);
  EXPECT_EQ(rig.board.num_corners_y, 6);
  EXPECT_EQ(rig.camera.lens, LensModel::kPlumbBob);
  EXPECT_EQ(rig.camera.fy_px, 501);
  EXPECT_EQ(rig.camera.distortion, (std::array<double, 8>{0.1, 0.2, 0, 0, 0.3, 0, 0, 0}));
  EXPECT_EQ(rig.channels.calib_samples, "CALIB_SAMPLES");
  EXPECT_EQ(rig.voq_selector.num_sets, SelectionOptions().num_sets);
  // Exactly: a default in radians is not sent through degrees and back.
  EXPECT_EQ(rig.consistency.max_angle_rad, ConsistencyOptions().max_angle_rad);
}

// Rig files of sessions that were recorded long ago are read as ever.
TEST(LoadRig, NamesKeysThatAreNoLongerUsedAndWhatReplacesThem) {
  EXPECT_TRUE(Load(Minimal()).remarks.empty());
  const Rig rig = Load(Minimal() +
                       "assessor:\n"
                       "  scene_check: {turn_tolerance_deg: 0.2, tolerance_deg: 0.5}\n"
                       "  diagnosis:\n"
                       "    min_focal_scale: 0.001\n");
  ASSERT_EQ(rig.remarks.size(), 2U);
  EXPECT_THAT(rig.remarks[0],
              EndsWith("rig.yaml:6: assessor.scene_check.tolerance_deg is no longer used, see "
                       "assessor.scene_check.turn_tolerance_deg"));
  EXPECT_THAT(rig.remarks[1],
              EndsWith("rig.yaml:8: assessor.diagnosis.min_focal_scale is no longer used, see "
                       "assessor.diagnosis.min_moved_intervals"));
}

TEST(LoadRig, ConvertsDegreesAndPutsThePrefixBeforeEachChannel) {
  const Rig rig = Load(Minimal() +
                       "lcm: {channel_prefix: LEFT_}\nchannels: {lidar_points: SWEEPS}\n"
                       "voq_selector: {consistency: {max_angle_deg: 18}}\n");
  EXPECT_EQ(rig.channels.lidar_points, "LEFT_SWEEPS");
  EXPECT_EQ(rig.channels.module_status, "LEFT_MODULE_STATUS");
  EXPECT_DOUBLE_EQ(rig.consistency.max_angle_rad, 0.1 * M_PI);
}

TEST(LoadRig, ResolvesFoldersFromItsOwn) {
  const test::TemporaryFolder folder;
  const auto path = folder.Write(
      "rig.yaml",
      Minimal() + "lidar_driver: {folder: ../clouds}\ncamera_driver: {folder: /data/images}\n");
  const Rig rig = LoadRig(path);
  EXPECT_EQ(rig.lidar_driver.folder, folder.path().parent_path() / "clouds");
  EXPECT_EQ(rig.camera_driver.folder, "/data/images");
}

TEST(LoadRig, ReadsByWhatFramesPair) {
  EXPECT_FALSE(Load(Minimal()).lidar_driver.is_by_order);
  EXPECT_TRUE(Load(Minimal() + "lidar_driver: {frames_by: order}\n").lidar_driver.is_by_order);
  EXPECT_EQ(LoadError(Minimal() + "camera_driver: {frames_by: time}\n"),
            "rig.yaml:5: camera_driver.frames_by must be names or order, is \"time\"");
}

TEST(LoadRig, ReadsABoxAndATransform) {
  const Rig rig = Load(Minimal() +
                       "lidar_board_detector: {region_of_interest: {min_lidar_m: [1, -2, -3], "
                       "max_lidar_m: [4, 5, 6]}}\n"
                       "simulation: {T_camera_lidar: {quaternion_xyzw: [0, 0, 0.7071, 0.7071], "
                       "translation_m: [0.1, 0.2, 0.3]}}\n");
  ASSERT_TRUE(rig.lidar_board_detector.region_of_interest);
  EXPECT_EQ(rig.lidar_board_detector.region_of_interest->max_lidar_m, Eigen::Vector3d(4, 5, 6));
  // A quarter turn about z, made exact though its file rounds it.
  const Eigen::Vector3d p = rig.simulation.T_camera_lidar * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(p.isApprox(Eigen::Vector3d(0.1, 1.2, 0.3), 1e-15)) << p.transpose();
}

TEST(LoadRig, ReadsTheScanPatternByName) {
  const Rig rig = Load(Minimal() + "simulation: {pattern: raster, dense_to_deg: 9}\n");
  EXPECT_EQ(rig.simulation.scan.pattern, ScanPattern::kRaster);
  EXPECT_DOUBLE_EQ(rig.simulation.scan.dense_to_rad, 9 * M_PI / 180);
  EXPECT_EQ(LoadError(Minimal() + "simulation: {pattern: spiral}\n"),
            "rig.yaml:5: simulation.pattern must be vlp16, spinning_64, spinning_128, raster or "
            "rosette, is \"spiral\"");
}

TEST(LoadRig, ReadsALidarOfTheNetworkOrACapture) {
  const test::TemporaryFolder folder;
  const Rig rig = LoadRig(folder.Write(
      "rig.yaml",
      Minimal() + "lidar_driver:\n  source: vlp16\n  sensor: {pcap: drive.pcap, returns: last, "
                  "split_azimuth_deg: 90, bias_from: old/extrinsic.yaml,\n    elevations_deg: "
                  "[-15, -13, -11, -9, -7, -5, -3, -1, 1, 3, 5, 7, 9, 11, 13, 15]}\n"));
  EXPECT_EQ(rig.lidar_driver.source, LidarDriverOptions::Source::kSensor);
  EXPECT_EQ(rig.lidar_sensor.pcap, folder.path() / "drive.pcap");
  EXPECT_EQ(rig.lidar_sensor.bias_from, folder.path() / "old/extrinsic.yaml");
  EXPECT_EQ(rig.lidar_sensor.packets.returns, ReturnChoice::kLast);
  EXPECT_DOUBLE_EQ(rig.lidar_sensor.packets.split_azimuth_rad, M_PI / 2);
  EXPECT_DOUBLE_EQ(rig.lidar_sensor.packets.unit.elevations_rad.at(15), 15 * M_PI / 180);
  EXPECT_EQ(rig.lidar_sensor.Port(), 2368);
  const Rig baraja = Load(Minimal() + "lidar_driver: {source: spectrum_scan}\n");
  EXPECT_EQ(baraja.lidar_sensor.packets.protocol->name, "baraja_spectrum_scan");
  EXPECT_EQ(baraja.lidar_sensor.Port(), 5044);
  EXPECT_EQ(baraja.lidar_sensor.address, "127.0.0.1");  // nothing from beyond this host by default
}

TEST(LoadRig, RefusesALidarThatCannotBe) {
  const auto error = [](const std::string& sensor) {
    return LoadError(Minimal() + "lidar_driver: {source: vlp16, sensor: {" + sensor + "}}\n");
  };
  EXPECT_EQ(error("address: lidar.local"),
            "rig.yaml:5: lidar_driver.sensor: address must be an IPv4 address of this host, is "
            "\"lidar.local\"");
  EXPECT_EQ(error("port: 70000"),
            "rig.yaml:5: lidar_driver.sensor: port must be 0 to 65535, is 70000");
  EXPECT_EQ(error("returns: first"),
            "rig.yaml:5: lidar_driver.sensor.returns must be strongest, last or both, is "
            "\"first\"");
  EXPECT_THAT(error("elevations_deg: [1, 2]"), HasSubstr("elevations_deg must have 16 entries"));
  EXPECT_THAT(error("split_azimuth_deg: 360"), HasSubstr("split_azimuth_deg must be from 0"));
}

TEST(LoadRig, TakesASectionWhoseOptionsAreAllCommentedOut) {
  EXPECT_EQ(LoadError(Minimal() + "sample_collector:\n  # num_still_frames: 1\n"), "");
}

TEST(LoadRig, NamesFileLineKeyRuleAndValue) {
  const std::string text = Minimal();
  EXPECT_EQ(LoadError(text + "extrinsic_refiner: {huber_px: soft}\n"),
            "rig.yaml:5: extrinsic_refiner.huber_px must be a number, is \"soft\"");
  EXPECT_EQ(LoadError(text + "extrinsic_refiner: {huber_px: \"3\"}\n"),
            "rig.yaml:5: extrinsic_refiner.huber_px must be a number, is \"3\"");
  EXPECT_EQ(LoadError(text + "extrinsic_refiner: {huber_px: }\n"),
            "rig.yaml:5: extrinsic_refiner.huber_px must be a number, is empty");
  EXPECT_EQ(LoadError(text + "extrinsic_refiner: {max_iterations: 2.5}\n"),
            "rig.yaml:5: extrinsic_refiner.max_iterations must be a whole number, is \"2.5\"");
  EXPECT_EQ(LoadError(text + "lidar_driver: {is_repeating: maybe}\n"),
            "rig.yaml:5: lidar_driver.is_repeating must be true or false, is \"maybe\"");
  EXPECT_EQ(LoadError(text + "simulation: {seed: -1}\n"),
            "rig.yaml:5: simulation.seed must be a whole number from 0 to 4294967295, is \"-1\"");
  EXPECT_EQ(LoadError(text + "lcm: loopback\n"),
            "rig.yaml:5: lcm must be a section, is \"loopback\"");
  EXPECT_EQ(LoadError(text + "lidar_driver: {source: tape}\n"),
            "rig.yaml:5: lidar_driver.source must be folder, simulator or a lidar: " +
                LidarProtocolNames() + ", is \"tape\"");
}

TEST(LoadRig, RefusesWhatIsNotFinite) {
  for (const char* value : {".nan", ".inf", "-.inf", "nan", "1e999"}) {
    EXPECT_THAT(
        LoadError(Minimal() + "voq_selector:\n  consistency:\n    max_distance_m: " + value),
        AllOf(StartsWith("rig.yaml:7: voq_selector.consistency.max_distance_m must be "),
              HasSubstr(value)));
  }
}

TEST(LoadRig, RefusesUnknownAndRepeatedKeys) {
  EXPECT_EQ(LoadError(Minimal() + "lidar_board_detector:\n  min_rnage_m: 1\n"),
            "rig.yaml:6: lidar_board_detector.min_rnage_m is not a known key: did you mean "
            "min_range_m?");
  EXPECT_EQ(LoadError(Minimal() + "chanels: {}\n"),
            "rig.yaml:5: chanels is not a known key: did you mean channels?");
  EXPECT_EQ(LoadError(Minimal() + "sensor: {}\n"), "rig.yaml:5: sensor is not a known key");
  EXPECT_EQ(LoadError(Minimal() + "lidar_driver: {jpeg_quality: 9}\n"),
            "rig.yaml:5: lidar_driver.jpeg_quality is not a known key");
  EXPECT_EQ(LoadError(Minimal() + "voq_selector:\n  num_sets: 5\n  num_sets: 6\n"),
            "rig.yaml:7: voq_selector.num_sets is given twice, first on line 6");
}

TEST(LoadRig, NamesWhatIsMissing) {
  EXPECT_EQ(LoadError(std::string(kHead) + kCamera), "rig.yaml:1: board is missing");
  EXPECT_THAT(LoadError(std::string(kHead) + kBoard),
              AllOf(StartsWith("rig.yaml:1: camera is missing"), HasSubstr("calibrate_lens")));
  EXPECT_EQ(LoadError(std::string(kBoard) + kCamera), "rig.yaml:1: rig is missing");
  EXPECT_EQ(LoadError(std::string(kHead) + kCamera +
                      "board: {width_m: 1, square_m: 0.1, num_corners_x: 4, num_corners_y: 4}\n"),
            "rig.yaml:4: board.height_m is missing");
}

constexpr char kPlateless[] = "board: {square_m: 0.1, num_corners_x: 4, num_corners_y: 6}\n";

TEST(LoadRig, NamesWhatMeasuresAMissingPlate) {
  const std::string text = std::string(kHead) + kPlateless + kCamera;
  EXPECT_THAT(LoadError(text),
              AllOf(HasSubstr("board.width_m is missing"), HasSubstr("board.height_m is missing")));
  const test::TemporaryFolder folder;
  const Rig rig = LoadRig(folder.Write("rig.yaml", text), PlateInRig::kMayBeMissing);
  EXPECT_FALSE(rig.is_plate_given);
  EXPECT_DOUBLE_EQ(rig.board.width_m, 0.4);  // three squares between corners, half of one beside
  EXPECT_DOUBLE_EQ(rig.board.height_m, 0.6);
  EXPECT_TRUE(
      LoadRig(folder.Write("rig.yaml", Minimal()), PlateInRig::kMayBeMissing).is_plate_given);
}

TEST(LoadRig, NamesWhatFindsAMissingLens) {
  std::string text = Minimal();
  text.replace(text.find("fx_px: 500, "), 12, "");
  EXPECT_EQ(LoadError(text),
            "rig.yaml:3: camera.fx_px is missing (calibrate_lens finds the camera's numbers from a "
            "recording of the board)");
}

LensInRig LensOf(const std::string& text, CameraModel* camera) {
  const test::TemporaryFolder folder;
  LensInRig lens;
  *camera = LoadRig(folder.Write("rig.yaml", text), &lens).camera;
  return lens;
}

TEST(LoadRig, TakesACameraWhoseLensIsToBeFound) {
  CameraModel camera;
  const std::string board = std::string(kHead) + kBoard;
  EXPECT_FALSE(LensOf(board, &camera).model);
  const LensInRig part =
      LensOf(board + "camera: {lens_model: rational_polynomial, width_px: 640}\n", &camera);
  EXPECT_EQ(part.model, LensModel::kRational);
  EXPECT_FALSE(part.camera);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 0);
  EXPECT_FALSE(LensOf(board + "camera: {lens_model: automatic}\n", &camera).model);
  EXPECT_EQ(LensOf(board + "camera: {lens_model: radtan}\n", &camera).model, LensModel::kPlumbBob);
  const LensInRig whole = LensOf(Minimal(), &camera);
  EXPECT_EQ(whole.model, LensModel::kPlumbBob);
  ASSERT_TRUE(whole.camera);
  EXPECT_EQ(whole.camera->fy_px, 501);

  const auto error = [&](const std::string& lines) {
    return test::ErrorOf([&] { LensOf(board + lines, &camera); });
  };
  EXPECT_THAT(
      error("camera: {lens_model: round}\n"),
      HasSubstr("lens_model (unless automatic) must be equidistant, plumb_bob or rational"));
  EXPECT_THAT(error("camera: {fx: 3}\n"), HasSubstr("camera.fx is not a known key"));
  EXPECT_THAT(error("camera: {width_px: wide}\n"), HasSubstr("camera.width_px"));
}

TEST(LoadRig, ReadsTheLinesOfKalibrsFileAsTheyAre) {
  const std::string kalibr =
      "board:\n  width_m: 0.9\n  height_m: 0.9\n"
      "  target_type: 'aprilgrid' #gridtype\n"
      "  tagCols: 6               #number of apriltags\n"
      "  tagRows: 5               #number of apriltags\n"
      "  tagSize: 0.088           #size of apriltag, edge to edge [m]\n"
      "  tagSpacing: 0.3          #ratio of space between tags to tagSize\n";
  const Rig rig = Load(kHead + kalibr + kCamera);
  EXPECT_EQ(rig.board.pattern, "aprilgrid");
  EXPECT_EQ(rig.board.num_corners_x, 12);
  EXPECT_EQ(rig.board.num_corners_y, 10);
  EXPECT_EQ(rig.board.square_m, 0.088);
  EXPECT_EQ(rig.board.gap_squares, 0.3);

  std::string other = kalibr;
  other.replace(other.find("'aprilgrid'"), 11, "circlegrid ");
  EXPECT_THAT(LoadError(kHead + other + kCamera),
              HasSubstr("rig.yaml:5: board.target_type must be one of chessboard, charuco, "
                        "aprilgrid, is \"circlegrid\""));
}

TEST(LoadRig, WantsTheLensModelsOwnNumberOfCoefficients) {
  std::string text = Minimal();
  text.replace(text.find("plumb_bob"), 9, "equidistant");
  EXPECT_EQ(LoadError(text),
            "rig.yaml:4: camera.distortion must be a list of 4 coefficients for lens_model "
            "equidistant, is a list of 5");
  text.replace(text.find("equidistant"), 11, "double_sphere");
  EXPECT_EQ(
      LoadError(text),
      "rig.yaml:3: camera.lens_model must be equidistant, plumb_bob or rational (another lens: "
      "calibrate it as one of these, with Kalibr by --models pinhole-radtan or pinhole-equi, or "
      "rectify the images), is \"double_sphere\"");
}

TEST(LoadRig, ReportsEveryProblemOfEachPart) {
  const std::string error = LoadError(Minimal() +
                                      "lidar_driver: {rate_hz: 0}\n"
                                      "voq_selector: {num_sets: 0}\n"
                                      "sample_collector:\n  num_still_frames: 0\n"
                                      "  min_new_angle_deg: -1\n");
  EXPECT_THAT(error, HasSubstr("rig.yaml:5: lidar_driver: rate_hz must be positive, is 0"));
  EXPECT_THAT(error, HasSubstr("rig.yaml:6: voq_selector: num_sets"));
  EXPECT_THAT(error, HasSubstr("rig.yaml:8: sample_collector: num_still_frames"));
  EXPECT_THAT(error,
              HasSubstr("rig.yaml:9: sample_collector: min_new_angle_deg must not be negative, "
                        "is -1"));
}

TEST(LoadRig, NamesAnglesAsTheFileDoes) {
  const std::string error = LoadError(Minimal() +
                                      "simulation: {dense_from_deg: 5, dense_to_deg: -5}\n"
                                      "pose_guide:\n"
                                      "  sensors: {min_elevation_deg: 20, max_elevation_deg: 10}\n"
                                      "camera_board_detector: {max_edge_width_deg: -2}\n");
  EXPECT_THAT(error, Not(HasSubstr("_rad"))) << error;
  EXPECT_THAT(error, HasSubstr("max_edge_width_deg must be positive and finite, is -2"));
}

TEST(LoadRig, ReportsProblemsOfBoardAndCamera) {
  std::string text = Minimal();
  text.replace(text.find("width_m: 0.6"), 12, "width_m: -1 ");
  text.replace(text.find("fx_px: 500"), 10, "fx_px: -50");
  EXPECT_THAT(LoadError(text),
              AllOf(HasSubstr("rig.yaml:2: board: width_m must be positive, is -1"),
                    HasSubstr("rig.yaml:3: camera: fx_px")));
}

TEST(LoadRig, RefusesChannelsThatLcmOrTheFlowCannotTellApart) {
  EXPECT_EQ(LoadError(Minimal() + "channels: {voq_sets: LIDAR_BOARD}\n"),
            "rig.yaml:5: channels.voq_sets must differ from other channels, is \"LIDAR_BOARD\"");
  EXPECT_EQ(
      LoadError(Minimal() + "channels: {lidar_points: CAMERA_IMAGE}\n"),  // the other's default
      "rig.yaml:5: channels.lidar_points must differ from other channels, is \"CAMERA_IMAGE\"");
  EXPECT_EQ(LoadError(Minimal() + "channels: {voq_sets: \"\"}\n"),
            "rig.yaml:5: channels.voq_sets must not be empty, is \"\"");
  EXPECT_THAT(LoadError(Minimal() + "lcm: {channel_prefix: " + std::string(60, 'P') + "}\n"),
              HasSubstr("must have at most 63 letters"));
}

TEST(LoadRig, RefusesAnLcmUrlThatLcmWouldNotTake) {
  EXPECT_EQ(LoadError(Minimal() + "lcm: {url: \"http://x\"}\n"),
            "rig.yaml:5: lcm.url must begin with udpm://, tcpq://, memq:// or file://, is "
            "\"http://x\"");
}

TEST(LoadRig, RefusesWhatIsNoRigFile) {
  EXPECT_EQ(LoadError(""), "rig.yaml:1: must be one mapping of keys to values, is empty");
  EXPECT_EQ(LoadError("- a\n- b\n"), "rig.yaml:1: must be one mapping of keys to values");
  EXPECT_EQ(LoadError("a: 1\n---\nb: 2\n"), "rig.yaml:1: must be one mapping of keys to values");
  EXPECT_THAT(LoadError("rig: x\nboard: [1, 2\n"), StartsWith("rig.yaml:3: is not YAML: "));
  EXPECT_EQ(LoadError("rig: x\nboard:\n\twidth_m: 0.6\n\theight_m: 0.8\n"),
            "rig.yaml:3: is indented by a tab: give spaces");
  EXPECT_EQ(LoadError("rig: x\nboard:\n  width_m:0.6\n  height_m: 0.8\n"),
            "rig.yaml:3: lacks a space after its colon");
  EXPECT_EQ(LoadError(std::string("\x89PNG\r\n\x1a\n\0\0\xff\xfe", 12)),
            "rig.yaml: is not a text file (wanted: YAML)");
  EXPECT_THAT(LoadError("rig: x\nboard:\n  width_m 0.6\n  height_m: 0.8\n"),
              HasSubstr("is a colon missing here or above"));
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::ErrorOf([&] { LoadRig(folder.path() / "none.yaml"); }),
              EndsWith("none.yaml: cannot be read: No such file or directory"));
  EXPECT_THAT(test::ErrorOf([&] { LoadRig(folder.path()); }), EndsWith("Is a directory"));
}

// One mistake, one line: what a user reads on a terminal.
TEST(LoadRig, SaysOneMistakeInOneLine) {
  EXPECT_THAT(LoadError("rig: x\nboard: [1, 2\n"), Not(HasSubstr("\n")));
  EXPECT_THAT(LoadError(std::string(kHead) + kCamera), Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace voqcal
