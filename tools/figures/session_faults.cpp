#include "figures/session_faults.hpp"

#include <utility>

namespace voqcal {
namespace {

using Inject = std::function<void(double size, GivenSession* session)>;

// The rig file says something else of board or camera.
Inject SaysOfRig(const std::function<void(double, BoardSpec*, CameraModel*)>& change) {
  return [change](double size, GivenSession* session) {
    change(size, &session->board, &session->camera);
    SeeBoardsAgain(session);
  };
}

Inject SaysOfCamera(double CameraModel::*number, bool is_relative) {
  return SaysOfRig([=](double size, BoardSpec*, CameraModel* camera) {
    camera->*number += is_relative ? size * (camera->*number) : size;
  });
}

Inject SaysOfLens(std::size_t coefficient) {
  return SaysOfRig([=](double size, BoardSpec*, CameraModel* camera) {
    camera->distortion[coefficient] += size;
  });
}

Inject SaysOfBoard(double BoardSpec::*number, bool is_relative) {
  return SaysOfRig([=](double size, BoardSpec* board, CameraModel*) {
    board->*number += is_relative ? size * (board->*number) : size;
  });
}

void ScaleImage(double scale, CameraModel* camera) {
  camera->fx_px *= scale;
  camera->fy_px *= scale;
  camera->cx_px *= scale;
  camera->cy_px *= scale;
}

void OffsetRanges(double offset_m, GivenSession* session) {
  const auto move = [offset_m](Eigen::Vector3d* point_m) {
    *point_m *= 1.0 + offset_m / point_m->norm();
  };
  for (BoardSample& sample : session->samples) {
    for (double& length_m : sample.lidar.edge_lengths_m)
      length_m *= 1.0 + offset_m / sample.lidar.pose.centre_m.norm();
    move(&sample.lidar.pose.centre_m);
    for (Eigen::Vector3d& corner_m : sample.lidar.pose.corners_m) move(&corner_m);
    for (LidarPoint& point : sample.lidar.points_lidar_m.points) {
      Eigen::Vector3d point_m = point.position_m.cast<double>();
      move(&point_m);
      point.position_m = point_m.cast<float>();
    }
  }
}

// The lidar's edges stay as they were measured; the known size completes the outline.
void GrowOutline(double width_m, double height_m, GivenSession* session) {
  session->board.width_m += width_m;
  session->board.height_m += height_m;
  for (BoardSample& sample : session->samples) {
    for (BoardPose* pose : {&sample.lidar.pose, &sample.camera.pose}) {
      const Matrix6d covariance = pose->covariance;
      *pose = PoseFromTransform(TransformFromPose(*pose), session->board);
      pose->covariance = covariance;
    }
  }
}

std::vector<SessionFault> MakeFaults() {
  const std::vector<std::string> focal = {"focal length", "focal length fx", "focal length fy"};
  const std::vector<std::string> principal = {"principal point"};
  const std::vector<std::string> lens = {"distortion", "rectified images", "lens model"};
  const std::vector<std::string> offset = {"pattern offset", "sign of the pattern offset"};
  const std::vector<std::string> outline = {"board's outline", "board's width", "board's height"};
  return {
      {"focal length",
       focal,
       0.01,
       0.2,
       SaysOfRig([](double size, BoardSpec*, CameraModel* camera) {
         camera->fx_px *= 1 + size;
         camera->fy_px *= 1 + size;
       })},
      {"fx alone", focal, 0.01, 0.2, SaysOfCamera(&CameraModel::fx_px, true)},
      {"fy alone", focal, 0.01, 0.2, SaysOfCamera(&CameraModel::fy_px, true)},
      {"cx", principal, 5, 100, SaysOfCamera(&CameraModel::cx_px, false)},
      {"cy", principal, 5, 100, SaysOfCamera(&CameraModel::cy_px, false)},
      {"distortion 1", lens, 0.02, 0.5, SaysOfLens(0)},
      {"distortion 2", lens, 0.02, 0.5, SaysOfLens(1)},
      {"distortion 3", lens, 0.002, 0.1, SaysOfLens(2)},
      {"distortion 4", lens, 0.002, 0.1, SaysOfLens(3)},
      {"squares", {"board's squares"}, 0.01, 0.2, SaysOfBoard(&BoardSpec::square_m, true)},
      {"pattern offset x", offset, 0.01, 0.2, SaysOfBoard(&BoardSpec::pattern_offset_x_m, false)},
      {"pattern offset y", offset, 0.01, 0.2, SaysOfBoard(&BoardSpec::pattern_offset_y_m, false)},
      {"ranges", {"lidar range offset"}, 0.02, 0.2, OffsetRanges},
      {"width",
       outline,
       0,
       0,
       [](double, GivenSession* session) { GrowOutline(0.03, 0, session); }},
      {"height",
       outline,
       0,
       0,
       [](double, GivenSession* session) { GrowOutline(0, 0.03, session); }},
      {"distortion = 0", lens, 0, 0, SaysOfRig([](double, BoardSpec*, CameraModel* camera) {
         camera->distortion = {};
       })},
      {"coefficients' order", lens, 0, 0, SaysOfRig([](double, BoardSpec*, CameraModel* camera) {
         auto& d = camera->distortion;
         if (camera->lens == LensModel::kEquidistant) {
           std::swap(d[0], d[1]);
         } else {
           d = {d[0], d[1], d[4], d[2], d[3]};  // k1 k2 k3 p1 p2
         }
       })},
      {"other lens model", lens, 0, 0, SaysOfRig([](double, BoardSpec*, CameraModel* camera) {
         camera->lens = camera->lens == LensModel::kEquidistant ? LensModel::kPlumbBob
                                                                : LensModel::kEquidistant;
         camera->distortion[4] = 0;
       })},
      {"half the image's size",
       {"image size"},
       0,
       0,
       SaysOfRig([](double, BoardSpec*, CameraModel* camera) { ScaleImage(0.5, camera); })},
      {"pattern across",
       {"pattern across the plate"},
       0,
       0,
       [](double, GivenSession* session) { LayPatternAcross(session); }},
      {"mirrored lidar",
       {"mirrored sensor"},
       0,
       0,
       [](double, GivenSession* session) { MirrorLidar(session); }},
      {"pairs shifted",
       {"shifted pairs"},
       0,
       0,
       [](double, GivenSession* session) { ShiftPairs(1, session); }},
  };
}

}  // namespace

const std::vector<SessionFault>& SessionFaults() {
  static const std::vector<SessionFault> kFaults = MakeFaults();
  return kFaults;
}

}  // namespace voqcal
