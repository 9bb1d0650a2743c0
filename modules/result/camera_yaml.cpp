#include "result/camera_yaml.hpp"

#include <cstddef>

#include "files/number_text.hpp"

namespace voqcal {

std::string CameraYaml(const CameraModel& camera, const std::string& indent) {
  std::string distortion;
  for (int i = 0; i < NumDistortion(camera.lens); ++i) {
    distortion += (i == 0 ? "" : ", ") + NumberText(camera.distortion[static_cast<std::size_t>(i)]);
  }
  const auto line = [&indent](const char* key, const std::string& value) {
    return indent + key + ": " + value + '\n';
  };
  return line("lens_model", ToString(camera.lens)) +
         line("width_px", std::to_string(camera.width_px)) +
         line("height_px", std::to_string(camera.height_px)) +
         line("fx_px", NumberText(camera.fx_px)) + line("fy_px", NumberText(camera.fy_px)) +
         line("cx_px", NumberText(camera.cx_px)) + line("cy_px", NumberText(camera.cy_px)) +
         line("distortion", '[' + distortion + ']');
}

}  // namespace voqcal
