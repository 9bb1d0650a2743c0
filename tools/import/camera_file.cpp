#include "import/camera_file.hpp"

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

CameraModel ReadRos(YamlSection* top) {
  CameraModel camera;
  top->ReadRequired("image_width", &camera.width_px);
  top->ReadRequired("image_height", &camera.height_px);
  std::string model;
  top->ReadRequired("distortion_model", &model);
  YamlSection distortion = top->RequiredSection("distortion_coefficients");
  std::vector<double> coefficients;
  distortion.ReadRequired("data", &coefficients);
  if (distortion.IsComplete() && top->IsComplete()) {
    SetLens(model, coefficients, {"distortion_model", "distortion_coefficients"}, top, &camera);
  }
  YamlSection matrix = top->RequiredSection("camera_matrix");
  const std::vector<double> k = Numbers("data", 9, &matrix);
  camera.fx_px = k[0];
  camera.fy_px = k[4];
  camera.cx_px = k[2];
  camera.cy_px = k[5];
  return camera;
}

}  // namespace

CameraModel ReadCameraFile(const std::filesystem::path& path, const std::string& name) {
  YamlDocument document(path.string(), ReadWholeFile(path));
  YamlSection top(&document);
  CameraModel camera;
  if (top.Has("camera_matrix")) {
    camera = ReadRos(&top);
  } else {
    YamlSection section = top.RequiredSection(name.empty() ? "cam0" : name);
    camera = ReadKalibr(&section);
  }
  document.ThrowIfWrong();
  top.AddProblems(camera.Problems());
  document.ThrowIfWrong();
  return camera;
}

}  // namespace voqcal
