#include "extrinsic_monitor/extrinsic_monitor_node.hpp"

#include <stdexcept>

#include <spdlog/spdlog.h>

#include "core/scene/scene_check.hpp"
#include "messaging/convert_assessment.hpp"
#include "messaging/convert_result.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

Eigen::Isometry3d ExtrinsicToWatch(const std::filesystem::path& extrinsic) try {
  return ReadExtrinsic(extrinsic);
} catch (const std::runtime_error& error) {
  throw std::runtime_error(error.what() +
                           std::string("; calibrate first, or name a result by --session DIR or by "
                                       "extrinsic_monitor: extrinsic in the rig file"));
}

}  // namespace

ExtrinsicMonitorNode::ExtrinsicMonitorNode(const Rig& rig,
                                           Bus* bus,
                                           const std::filesystem::path& extrinsic)
    : rig_(rig),
      bus_(*bus),
      extrinsic_(extrinsic),
      T_camera_lidar_(ExtrinsicToWatch(extrinsic)),
      window_(rig_.camera,
              rig_.scene_check.view,
              rig_.extrinsic_monitor.window,
              [this](const std::string& reason) { Count(reason); }) {
  bus_.Subscribe<pointcloud2_t>(rig_.channels.lidar_points,
                                Queue::kEvery,
                                [this](const pointcloud2_t& sweep) { window_.Add(sweep); });
  bus_.Subscribe<image_t>(rig_.channels.camera_image, Queue::kEvery, [this](const image_t& image) {
    window_.Add(image);
  });
}

std::string ExtrinsicMonitorNode::State() const {
  if (window_.IsWithoutPairs()) {
    return "trouble: no image is near a sweep in time; check both clocks, or extrinsic_monitor: "
           "max_apart_s";
  }
  if (!newest_) return "waiting: the first stretch is not yet full";
  if (newest_->check.verdict != ToString(Agreement::kDisagrees)) return "running";
  return "trouble: the scene disagrees with " + extrinsic_.string() + ": " + newest_->check.reason +
         "; calibrate again";
}

bool ExtrinsicMonitorNode::Step() {
  if (!window_.IsFull()) return false;
  const SceneCheck check =
      CheckScene(window_.views(), rig_.camera, T_camera_lidar_, rig_.scene_check);
  extrinsic_check_t message{};
  message.seq = seq_++;
  message.first_utime = window_.first_utime();
  message.last_utime = window_.last_utime();
  message.extrinsic = extrinsic_.string();
  message.check = ToMessage(check);
  message.T_camera_lidar = ToMessage(PerturbLeft(T_camera_lidar_, check.asked));
  newest_ = message;
  Count(message.check.verdict);
  spdlog::info("{}: {}", message.check.verdict, message.check.reason);
  window_.Clear();
  Republish();
  return true;
}

void ExtrinsicMonitorNode::Republish() {
  if (newest_) bus_.Publish(rig_.channels.extrinsic_check, *newest_);
}

}  // namespace voqcal
