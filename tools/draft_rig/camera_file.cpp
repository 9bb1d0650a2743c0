#include "draft_rig/camera_file.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/atomic_file.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {
namespace {

// The keys of one kind of file.
struct FileKeys {
  const char* width;
  const char* height;
  const char* matrix;
  const char* distortion;
  bool has_data;  ///< Lists are sections {rows, cols, data}.
};

constexpr FileKeys kRos = {
    "image_width", "image_height", "camera_matrix", "distortion_coefficients", true};
constexpr FileKeys kCamLidarCalibration = {"width", "height", "K", "D", false};

std::vector<double> ReadList(YamlSection* file, const char* key, bool has_data) {
  std::vector<double> numbers;
  if (has_data) {
    YamlSection section = file->RequiredSection(key);
    section.ReadRequired("data", &numbers);
  } else {
    file->ReadRequired(key, &numbers);
  }
  return numbers;
}

void ReadLensModel(YamlSection* file, CameraModel* camera) {
  std::string name = "plumb_bob";
  file->Read("distortion_model", &name);
  if (name == "non-fisheye") name = "plumb_bob";  // cam_lidar_calibration's word
  if (const auto lens = LensModelFromString(name)) {
    camera->lens = *lens;
  } else {
    file->AddError("distortion_model", "must be plumb_bob, rational_polynomial or equidistant");
  }
}

// Trailing zeros of longer lists say nothing; shorter ones leave the rest zero.
void TakeDistortion(const std::vector<double>& numbers,
                    const char* key,
                    YamlSection* file,
                    CameraModel* camera) {
  const auto num_known = static_cast<std::size_t>(NumDistortion(camera->lens));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i < num_known) {
      camera->distortion[i] = numbers[i];
    } else if (numbers[i] != 0.0) {
      return file->AddError(key, "has more coefficients than " + ToString(camera->lens) + " takes");
    }
  }
}

CameraModel ReadOther(YamlSection* file, const FileKeys& keys) {
  CameraModel camera;
  ReadLensModel(file, &camera);
  file->ReadRequired(keys.width, &camera.width_px);
  file->ReadRequired(keys.height, &camera.height_px);
  const std::vector<double> matrix = ReadList(file, keys.matrix, keys.has_data);
  if (matrix.size() == 9) {
    camera.fx_px = matrix[0];
    camera.cx_px = matrix[2];
    camera.fy_px = matrix[4];
    camera.cy_px = matrix[5];
  } else if (file->Has(keys.matrix)) {
    file->AddError(keys.matrix, "must have 9 numbers, row by row");
  }
  TakeDistortion(ReadList(file, keys.distortion, keys.has_data), keys.distortion, file, &camera);
  return camera;
}

CameraModel ReadRigCamera(YamlSection* section) {
  CameraModel camera;
  std::string lens = ToString(camera.lens);
  section->Read("lens_model", &lens);
  if (const auto known = LensModelFromString(lens)) {
    camera.lens = *known;
  } else {
    section->AddError("lens_model", "must be plumb_bob, rational or equidistant");
  }
  section->ReadRequired("width_px", &camera.width_px);
  section->ReadRequired("height_px", &camera.height_px);
  section->ReadRequired("fx_px", &camera.fx_px);
  section->ReadRequired("fy_px", &camera.fy_px);
  section->ReadRequired("cx_px", &camera.cx_px);
  section->ReadRequired("cy_px", &camera.cy_px);
  std::vector<double> distortion;
  section->Read("distortion", &distortion);
  TakeDistortion(distortion, "distortion", section, &camera);
  return camera;
}

// OpenCV's files begin with a line that YAML 1.2 does not know ("%YAML:1.0").
std::string WithoutDirectives(std::string text) {
  while (!text.empty() && text.front() == '%') {
    text.erase(0, std::min(text.find('\n'), text.size() - 1) + 1);
  }
  return text;
}

}  // namespace

CameraModel ReadCameraFile(const std::filesystem::path& path) {
  YamlDocument document(path.string(), WithoutDirectives(ReadWholeFile(path)));
  YamlSection file(&document);
  CameraModel camera;
  if (file.Has(kRos.matrix)) {
    camera = ReadOther(&file, kRos);
  } else if (file.Has(kCamLidarCalibration.matrix)) {
    camera = ReadOther(&file, kCamLidarCalibration);
  } else if (file.Has("camera")) {
    YamlSection section = file.Section("camera");
    camera = ReadRigCamera(&section);
  } else {
    camera = ReadRigCamera(&file);
  }
  document.ThrowIfWrong();
  for (const std::string& problem : camera.Problems()) {
    throw std::runtime_error(path.string() + ": " + problem);
  }
  return camera;
}

std::optional<std::filesystem::path> FindCameraFile(const std::filesystem::path& session) {
  for (const char* name : {"camera.yaml", "camera_info.yaml", "ost.yaml"}) {
    if (std::filesystem::is_regular_file(session / name)) return session / name;
  }
  return {};
}

}  // namespace voqcal
