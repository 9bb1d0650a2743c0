#include "result/tree_text.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "result/extrinsic_text.hpp"

namespace voqcal {
namespace {

using Cameras = std::map<std::string, CameraModel>;

const char* KindOf(const SensorTree::Sensor& sensor) {
  return sensor.is_lidar ? "a lidar" : "a camera's optical frame: x right, y down, z forward";
}

/// From the reference to each other sensor.
std::vector<ExportedExtrinsic> EdgesOf(const SensorTree& tree, const Cameras& cameras) {
  std::vector<ExportedExtrinsic> edges;
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    if (sensor.name == tree.reference) continue;
    ExportedExtrinsic edge;
    edge.T_child_parent = sensor.T_reference_sensor.inverse();
    edge.parent = tree.reference;
    edge.parent_kind = KindOf(tree.sensors.front());
    edge.child = sensor.name;
    edge.child_kind = KindOf(sensor);
    const auto camera = cameras.find(sensor.name);
    if (camera != cameras.end()) edge.camera = camera->second;
    edges.push_back(edge);
  }
  return edges;
}

std::string Indented(const std::string& text) {
  std::string indented = text.empty() ? "" : "  ";
  for (std::size_t i = 0; i < text.size(); ++i) {
    indented += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) indented += "  ";
  }
  return indented;
}

std::string CommandsText(const std::string& format, const std::vector<ExportedExtrinsic>& edges) {
  std::string text;
  for (const ExportedExtrinsic& edge : edges) text += ExtrinsicText(format, edge);
  return text;
}

std::string RobotText(const SensorTree& tree, const std::vector<ExportedExtrinsic>& edges) {
  std::string name;  // as an XML attribute takes it
  for (const char c : tree.rig) name += std::string("<>&\"").find(c) == std::string::npos ? c : '_';
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + name + "\">\n";
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    text += "  <link name=\"" + sensor.name + "\"/>\n";
  }
  for (const ExportedExtrinsic& edge : edges) text += Indented(ExtrinsicText("urdf", edge));
  return text + "</robot>\n";
}

std::string FramesText(const SensorTree& tree, const std::vector<ExportedExtrinsic>& edges) {
  std::string text =
      "# Each transform takes coordinates of its frame to those of the frame that it is relative "
      "to. "
      "Metres;\n# quat is w x y z.\ncoordinate_frames {\n  root_frame = \"" +
      tree.reference + "\";\n";
  for (const ExportedExtrinsic& edge : edges) text += BotFrame(edge);
  return text + "}\n";
}

std::string CamchainText(const SensorTree& tree, const Cameras& cameras) {
  const auto lidar = std::find_if(
      tree.sensors.begin(), tree.sensors.end(), [](const auto& sensor) { return sensor.is_lidar; });
  std::string names;
  std::string chain;
  const SensorTree::Sensor* before = nullptr;
  int num = 0;
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    if (sensor.is_lidar) continue;
    const Eigen::Isometry3d T_sensor_reference = sensor.T_reference_sensor.inverse();
    names += "# cam" + std::to_string(num) + ": " + sensor.name + "\n";
    chain += "cam" + std::to_string(num++) + ":\n";
    if (lidar != tree.sensors.end()) {
      chain += "  T_cam_lidar:\n" +
               ExactRows((T_sensor_reference * lidar->T_reference_sensor).matrix(), "  ");
    }
    if (before != nullptr) {
      chain += "  T_cn_cnm1:\n" +
               ExactRows((T_sensor_reference * before->T_reference_sensor).matrix(), "  ");
    }
    const auto camera = cameras.find(sensor.name);
    if (camera != cameras.end()) chain += KalibrLens(camera->second);
    before = &sensor;
  }
  const std::string of_lidar =
      lidar == tree.sensors.end() ? "" : "; T_cam_lidar those of the lidar " + lidar->name;
  return names + "# T_cn_cnm1 takes coordinates of the camera before to the camera's" + of_lidar +
         ". Metres.\n" + chain;
}

using Json = nlohmann::ordered_json;

Json JsonOf(const CameraModel& camera) {
  const auto distortion_end = camera.distortion.begin() + NumDistortion(camera.lens);
  return {{"lens_model", ToString(camera.lens)},
          {"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},
          {"cx_px", camera.cx_px},
          {"cy_px", camera.cy_px},
          {"distortion", std::vector<double>(camera.distortion.begin(), distortion_end)}};
}

Json JsonOf(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d& t = T.translation();
  return {{"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"translation_m", {t.x(), t.y(), t.z()}}};
}

std::string JsonText(const SensorTree& tree, const Cameras& cameras) {
  Json sensors = Json::object();
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    Json entry = {{"kind", sensor.is_lidar ? "lidar" : "camera"},
                  {"T_reference_sensor", JsonOf(sensor.T_reference_sensor)}};
    const auto camera = cameras.find(sensor.name);
    if (camera != cameras.end()) entry["camera"] = JsonOf(camera->second);
    sensors[sensor.name] = entry;
  }
  const Json json = {{"rig", tree.rig}, {"reference", tree.reference}, {"sensors", sensors}};
  return json.dump(2) + "\n";
}

}  // namespace

const std::vector<std::string>& TreeFormats() {
  static const std::vector<std::string> kNames = {
      "ros", "ros1", "ros2", "urdf", "bot_frames", "kalibr", "json"};
  return kNames;
}

std::string TreeText(const std::string& format, const SensorTree& tree, const Cameras& cameras) {
  const std::vector<ExportedExtrinsic> edges = EdgesOf(tree, cameras);
  if (format == "ros" || format == "ros1" || format == "ros2") return CommandsText(format, edges);
  if (format == "urdf") return RobotText(tree, edges);
  if (format == "bot_frames") return FramesText(tree, edges);
  if (format == "kalibr") return CamchainText(tree, cameras);
  if (format == "json") return JsonText(tree, cameras);
  std::string known;
  for (const std::string& name : TreeFormats()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("no format '" + format + "' of a whole rig; there are: " + known +
                              " (each pair's own folder can be exported too)");
}

std::vector<std::string> CamerasWithoutKalibrLens(const SensorTree& tree, const Cameras& cameras) {
  std::vector<std::string> names;
  for (const SensorTree::Sensor& sensor : tree.sensors) {
    if (sensor.is_lidar) continue;
    const auto camera = cameras.find(sensor.name);
    if (camera == cameras.end() || KalibrLens(camera->second).empty()) names.push_back(sensor.name);
  }
  return names;
}

}  // namespace voqcal
