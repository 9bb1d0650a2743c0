#include "import/camera_file.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/camera/named_lens.hpp"
#include "files/atomic_file.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {
namespace {

/// Where a file has what a lens is made of.
struct LensKeys {
  std::string model;
  std::string coefficients;
};

void SetLens(const std::string& model,
             const std::vector<double>& coefficients,
             const LensKeys& keys,
             YamlSection* section,
             CameraModel* camera) {
  const auto lens = LensByName(model, coefficients);
  if (!lens) {
    const auto& [is_of_coefficients, rule] = lens.error();
    return section->AddError(is_of_coefficients ? keys.coefficients : keys.model, rule);
  }
  camera->lens = lens->lens;
  camera->distortion = lens->distortion;
}

/// A list of so many numbers; zeros, with an error of the file, if it is another.
std::vector<double> Numbers(const std::string& key, std::size_t num, YamlSection* section) {
  std::vector<double> values;
  section->ReadRequired(key, &values);
  if (!values.empty() && values.size() != num) {
    section->AddError(key, "must be a list of " + std::to_string(num));
  }
  values.resize(num);
  return values;
}

CameraModel ReadKalibr(YamlSection* section) {
  CameraModel camera;
  std::string projection = "pinhole";
  section->Read("camera_model", &projection);
  if (projection != "pinhole") {
    section->AddError("camera_model",
                      "must be pinhole (calibrate again by --models pinhole-radtan, or "
                      "pinhole-equi for a fisheye)");
    return camera;
  }
  std::string model = "none";
  std::vector<double> coefficients;
  section->Read("distortion_model", &model);
  section->Read("distortion_coeffs", &coefficients);
  if (model == "none") coefficients.clear();  // Kalibr writes zeros
  SetLens(model, coefficients, {"distortion_model", "distortion_coeffs"}, section, &camera);
  const std::vector<double> focus = Numbers("intrinsics", 4, section);
  camera.fx_px = focus[0];
  camera.fy_px = focus[1];
  camera.cx_px = focus[2];
  camera.cy_px = focus[3];
  const std::vector<double> size = Numbers("resolution", 2, section);
  camera.width_px = static_cast<int>(size[0]);
  camera.height_px = static_cast<int>(size[1]);
  return camera;
}

void SetMatrix(const std::vector<double>& k, CameraModel* camera) {
  camera->fx_px = k[0];
  camera->fy_px = k[4];
  camera->cx_px = k[2];
  camera->cy_px = k[5];
}

CameraModel ReadRos(YamlSection* top) {
  CameraModel camera;
  top->ReadRequired("image_width", &camera.width_px);
  top->ReadRequired("image_height", &camera.height_px);
  std::string model = "plumb_bob";  // OpenCV's own files do not say
  top->Read("distortion_model", &model);
  YamlSection distortion = top->RequiredSection("distortion_coefficients");
  std::vector<double> coefficients;
  distortion.ReadRequired("data", &coefficients);
  if (distortion.IsComplete() && top->IsComplete()) {
    SetLens(model, coefficients, {"distortion_model", "distortion_coefficients"}, top, &camera);
  }
  YamlSection matrix = top->RequiredSection("camera_matrix");
  SetMatrix(Numbers("data", 9, &matrix), &camera);
  return camera;
}

CameraModel ReadCamLidarCalibration(YamlSection* top) {
  CameraModel camera;
  top->ReadRequired("width", &camera.width_px);
  top->ReadRequired("height", &camera.height_px);
  std::string model = "plumb_bob";
  std::vector<double> coefficients;
  top->Read("distortion_model", &model);
  top->ReadRequired("D", &coefficients);
  SetMatrix(Numbers("K", 9, top), &camera);
  if (top->IsComplete()) SetLens(model, coefficients, {"distortion_model", "D"}, top, &camera);
  return camera;
}

CameraModel ReadRigCamera(YamlSection* section) {
  CameraModel camera;
  section->ReadRequired("width_px", &camera.width_px);
  section->ReadRequired("height_px", &camera.height_px);
  section->ReadRequired("fx_px", &camera.fx_px);
  section->ReadRequired("fy_px", &camera.fy_px);
  section->ReadRequired("cx_px", &camera.cx_px);
  section->ReadRequired("cy_px", &camera.cy_px);
  std::string model = "none";
  std::vector<double> coefficients;
  section->Read("lens_model", &model);
  section->Read("distortion", &coefficients);
  SetLens(model, coefficients, {"lens_model", "distortion"}, section, &camera);
  return camera;
}

// Who wrote a file shows by the name that it gives the matrix.
CameraModel ReadCamera(YamlSection* top, const std::string& name) {
  if (top->Has("camera_matrix")) return ReadRos(top);
  if (top->Has("K")) return ReadCamLidarCalibration(top);
  if (top->Has("fx_px")) return ReadRigCamera(top);
  if (name.empty() && top->Has("camera")) {
    YamlSection section = top->Section("camera");
    return ReadRigCamera(&section);
  }
  YamlSection section = top->RequiredSection(name.empty() ? "cam0" : name);
  return ReadKalibr(&section);
}

// OpenCV's files begin with a line that YAML 1.2 does not know ("%YAML:1.0").
std::string WithoutDirectives(std::string text) {
  while (!text.empty() && text.front() == '%') {
    text.erase(0, std::min(text.find('\n'), text.size() - 1) + 1);
  }
  return text;
}

}  // namespace

CameraModel ReadCameraFile(const std::filesystem::path& path, const std::string& name) {
  YamlDocument document(path.string(), WithoutDirectives(ReadWholeFile(path)));
  YamlSection top(&document);
  const CameraModel camera = ReadCamera(&top, name);
  document.ThrowIfWrong();
  top.AddProblems(camera.Problems());
  document.ThrowIfWrong();
  return camera;
}

}  // namespace voqcal
