#include "dashboard/page_state.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/selection/voq.hpp"
#include "messaging/convert_board.hpp"
#include "modules/nodes/node_test.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::json;

BoardSample FacingSample(const Eigen::Vector3d& normal_camera) {
  BoardSample sample = test::SynthesizeSamples({})[0];
  sample.id = 7;
  sample.camera.pose.normal = normal_camera;
  return sample;
}

Json OneSample(const BoardSample& sample,
               const extrinsic_averaged_t* averaged = nullptr,
               const assessment_t* assessment = nullptr) {
  const samples_t message = ToMessage({sample}, 3, true, "hash");
  const Json json =
      Json::parse(SamplesJson(message, {sample}, averaged, assessment, test::TestRig()));
  EXPECT_EQ(json["revision"], 3);
  EXPECT_EQ(json["is_finished"], true);
  return json["samples"].at(0);
}

TEST(RigJson, TellsWhereTheCameraLooks) {
  const Rig rig = test::TestRig();
  const Json border = Json::parse(RigJson(rig))["camera"]["border"];
  ASSERT_EQ(border.size(), 24U);
  // The first of each side is a corner of the image: from the top left on, clockwise.
  const double right = rig.camera.width_px - 1;
  const double bottom = rig.camera.height_px - 1;
  const Eigen::Vector2d corners[] = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
  for (std::size_t side = 0; side < 4; ++side) {
    const Json& ray = border[6 * side];
    const Eigen::Vector3d direction(ray[0], ray[1], ray[2]);
    EXPECT_LT((rig.camera.Project(direction) - corners[side]).norm(), 1e-6);
  }
}

TEST(SamplesJson, SaysWhichWayTheBoardFaces) {
  const double angle = 0.3;
  // Camera: x right, y down, z forward; a normal points from the board to the camera.
  const Json right = OneSample(FacingSample({std::sin(angle), 0, -std::cos(angle)}));
  EXPECT_NEAR(right["faces_right_deg"], 17.19, 0.01);
  EXPECT_NEAR(right["faces_up_deg"], 0, 1e-9);
  const Json up = OneSample(FacingSample({0, -std::sin(angle), -std::cos(angle)}));
  EXPECT_NEAR(up["faces_up_deg"], 17.19, 0.01);
}

TEST(SamplesJson, SaysWhatWasMeasured) {
  const BoardSample sample = FacingSample({0, 0, -1});
  const Json json = OneSample(sample);
  EXPECT_EQ(json["id"], 7);
  EXPECT_NEAR(json["distance_m"], sample.camera.pose.centre_m.norm(), 1e-12);
  EXPECT_NEAR(json["e_dim_mm"],
              BoardDimensionErrorMm(sample.lidar.edge_lengths_m, test::TestRig().board),
              1e-9);
  EXPECT_EQ(json["corners_lidar_m"].size(), 4U);
  EXPECT_EQ(json["outline_px"].size(), 4U);
  EXPECT_FALSE(json.contains("left_out"));
  EXPECT_FALSE(json.contains("held_out_mm"));
}

TEST(SamplesJson, SaysWhatBecameOfIt) {
  extrinsic_averaged_t averaged{};
  averaged.inconsistent_ids = {7};
  averaged.inconsistent_reasons = {"its distances do not fit"};
  EXPECT_EQ(OneSample(FacingSample({0, 0, -1}), &averaged)["left_out"], "its distances do not fit");
  assessment_t assessment{};
  assessment.sample_ids = {6, 7};
  assessment.held_out_centre_mm = {1.0, 2.5};
  EXPECT_EQ(OneSample(FacingSample({0, 0, -1}), nullptr, &assessment)["held_out_mm"], 2.5);
}

TEST(ResultJson, HasSigmasInTheOrderOfTheCovariance) {
  extrinsic_refined_t refined{};
  for (int i = 0; i < 6; ++i) {
    refined.covariance_given_rig[i][i] = std::pow(1e-3 * (i + 1), 2);
    refined.covariance[i][i] = std::pow(1e-2 * (i + 1), 2);
  }
  refined.T_camera_lidar.quaternion_xyzw[3] = 1;
  assessment_t assessment{};
  assessment.verdict_grade = "bad";
  const Json json = Json::parse(ResultJson(refined, assessment, true, "", {"extrinsic.yaml"}));
  EXPECT_NEAR(json["sigma_deg"][0], 1e-3 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(json["sigma_mm"][2], 6.0, 1e-9);
  EXPECT_NEAR(json["place_sigma_deg"][0], 1e-2 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(json["place_sigma_mm"][2], 60.0, 1e-9);
  EXPECT_EQ(json["exports"], Json({"extrinsic.yaml"}));
  EXPECT_EQ(json["verdict"]["grade"], "bad");
}

TEST(CameraBoardJson, TakesCornersOnlyWhereThereIsABoard) {
  camera_board_t message{};
  message.miss = "no board";
  message.detail = "of 12 corners";
  const Json miss = Json::parse(CameraBoardJson(message, test::TestCamera()));
  EXPECT_EQ(miss["miss"], "no board");
  EXPECT_FALSE(miss.contains("corners_px"));

  const BoardSample sample = FacingSample({0, 0, -1});
  CameraBoard board = sample.camera;
  board.corners_px = {{10, 20}, {std::nan(""), std::nan("")}};
  message = CameraBoardMessage(board, "", "", 5, 1);
  const Json found = Json::parse(CameraBoardJson(message, test::TestCamera()));
  EXPECT_EQ(found["corners_px"], Json({{10.0, 20.0}}));  // the one not seen is left out
}

TEST(GuidanceJson, HasTheGhostWhereThereIsAdvice) {
  next_pose_t message{};
  message.problem = "no samples";
  EXPECT_FALSE(Json::parse(GuidanceJson(message, {})).contains("corners_px"));
  message.problem = "";
  message.worst_error = std::numeric_limits<double>::infinity();
  const Json json = Json::parse(GuidanceJson(message, {}));
  EXPECT_EQ(json["corners_px"].size(), 4U);
  EXPECT_FALSE(json.contains("corners_lidar_m"));  // no extrinsic is known yet
  EXPECT_TRUE(json["worst_error"].is_null());
}

TEST(EventsJson, SurvivesTextThatIsNoUtf8) {
  event_t event{};
  event.kind = "rejected";
  event.reason = "\xff\xfe";
  EXPECT_EQ(Json::parse(EventsJson({{event, 4}}))["events"][0]["count"], 4);
}

}  // namespace
}  // namespace voqcal
