// print_camera: the intrinsics that another tool found, as a rig file's section.

#include <filesystem>
#include <iostream>
#include <string>

#include "common/tool_main.hpp"
#include "import/camera_file.hpp"
#include "result/camera_yaml.hpp"

int main(int argc, char** argv) {
  CLI::App app(
      "Prints a camera's intrinsics as the camera section of a rig file, from Kalibr's "
      "camchain.yaml or ROS' camera_info YAML. (tools/import_ros RECORDING --print-camera does it "
      "from a recording's CameraInfo.)",
      "print_camera");
  std::filesystem::path file;
  std::string camera;
  app.add_option("file", file, "The file (YAML)")->required();
  app.add_option("--camera", camera, "Which camera of a camchain: cam0 unless told");
  return voqcal::RunTool(&app, argc, argv, [&] {
    const voqcal::CameraModel read = voqcal::ReadCameraFile(file, camera);
    std::cout << "camera:\n" << voqcal::CameraYaml(read, "  ");
  });
}
