#include "rig/camera_section.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "core/camera/named_lens.hpp"
#include "files/transform_yaml.hpp"

namespace voqcal {
namespace {

constexpr char kLensRemedy[] =
    " (calibrate_lens finds the camera's numbers from a recording of the board)";
constexpr const char* kPixelKeys[] = {"width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"};

void ReadLens(YamlSection* section, CameraModel* camera) {
  std::string lens_model;
  std::vector<double> distortion;
  section->ReadRequired("lens_model", &lens_model);
  section->ReadRequired("distortion", &distortion);
  if (!section->IsComplete()) return;
  const auto lens = LensByName(lens_model, distortion);
  if (!lens) {
    const auto& [is_of_coefficients, rule] = lens.error();
    return section->AddError(is_of_coefficients ? "distortion" : "lens_model", rule);
  }
  camera->lens = lens->lens;
  camera->distortion = lens->distortion;
}

void ReadIntrinsics(YamlSection* section, CameraModel* camera) {
  ReadLens(section, camera);
  section->ReadRequired("width_px", &camera->width_px);
  section->ReadRequired("height_px", &camera->height_px);
  section->ReadRequired("fx_px", &camera->fx_px, kLensRemedy);
  section->ReadRequired("fy_px", &camera->fy_px);
  section->ReadRequired("cx_px", &camera->cx_px);
  section->ReadRequired("cy_px", &camera->cy_px);
  if (section->IsComplete()) section->AddProblems(camera->Problems());
}

bool HasWholeLens(const YamlSection& section) {
  return section.Has("lens_model") && section.Has("distortion") &&
         std::all_of(std::begin(kPixelKeys), std::end(kPixelKeys), [&](const char* key) {
           return section.Has(key);
         });
}

// What is left of the keys of a camera whose lens is to be found: sizes and model hold, the rest is
// as good as not given.
void ReadPartOfLens(YamlSection* section, CameraModel* camera, LensInRig* lens) {
  std::string model = "automatic";
  std::vector<double> distortion;
  section->Read("lens_model", &model);
  section->Read("distortion", &distortion);
  section->Read("width_px", &camera->width_px);
  section->Read("height_px", &camera->height_px);
  for (const char* key : {"fx_px", "fy_px", "cx_px", "cy_px"}) {
    double ignored = 0;
    section->Read(key, &ignored);
  }
  if (model == "automatic") return;
  if (const auto known = LensModelByName(model)) {
    lens->model = *known;
  } else {
    section->AddError("lens_model", "(unless automatic) " + known.error().rule);
  }
}

}  // namespace

void ReadCamera(YamlSection* top,
                CameraModel* camera,
                std::optional<Eigen::Isometry3d>* T_camera_lidar_guess,
                LensInRig* lens) {
  YamlSection section =
      lens != nullptr ? top->Section("camera") : top->RequiredSection("camera", kLensRemedy);
  if (!top->Has("camera")) return;
  if (lens == nullptr || HasWholeLens(section)) {
    ReadIntrinsics(&section, camera);
    if (lens != nullptr) *lens = {camera->lens, *camera};
  } else {
    ReadPartOfLens(&section, camera, lens);
  }
  YamlSection guess = section.Section("T_camera_lidar_guess");
  if (section.Has("T_camera_lidar_guess")) {
    T_camera_lidar_guess->emplace(Eigen::Isometry3d::Identity());
    ReadTransform(&guess, &**T_camera_lidar_guess);
  }
  guess.RefuseUnknownKeys();
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
