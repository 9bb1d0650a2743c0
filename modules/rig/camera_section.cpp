#include "rig/camera_section.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "core/camera/named_lens.hpp"

namespace voqcal {
namespace {

constexpr char kLensRemedy[] =
    " (calibrate_lens finds the camera's numbers from a recording of the board)";
constexpr char kMeaning[] =
    "its lens; calibrate_lens finds these numbers from a recording of the board";
constexpr const char* kPixelKeys[] = {"width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"};

void ReadLens(OptionSection* section, CameraModel* camera) {
  std::string lens_model;
  std::vector<double> distortion;
  section->ReadRequired("lens_model", &lens_model, "equidistant (fisheye), plumb_bob or rational");
  section->ReadRequired("distortion",
                        &distortion,
                        "equidistant: k1 k2 k3 k4; plumb_bob: k1 k2 p1 p2 k3; rational: k1 k2 p1 "
                        "p2 k3 k4 k5 k6 (OpenCV's orders)");
  if (!section->IsComplete()) return;
  const auto lens = LensByName(lens_model, distortion);
  if (!lens) {
    const auto& [is_of_coefficients, rule] = lens.error();
    return section->AddError(is_of_coefficients ? "distortion" : "lens_model", rule);
  }
  camera->lens = lens->lens;
  camera->distortion = lens->distortion;
}

void ReadIntrinsics(OptionSection* section, CameraModel* camera) {
  ReadLens(section, camera);
  section->ReadRequired("width_px", &camera->width_px, "of the whole image");
  section->ReadRequired("height_px", &camera->height_px, "the same");
  section->ReadRequired("fx_px", &camera->fx_px, "focal length", kLensRemedy);
  section->ReadRequired("fy_px", &camera->fy_px, "the same along y");
  section->ReadRequired(
      "cx_px", &camera->cx_px, "principal point; pixel (0, 0) is the centre of the top-left pixel");
  section->ReadRequired("cy_px", &camera->cy_px, "the same along y");
  if (section->IsComplete()) section->AddProblems(camera->Problems());
}

bool HasWholeLens(const YamlSection& section) {
  return section.Has("lens_model") && section.Has("distortion") &&
         std::all_of(std::begin(kPixelKeys), std::end(kPixelKeys), [&](const char* key) {
           return section.Has(key);
         });
}

// What is left of the keys of a camera whose lens is to be found: sizes and model hold, the rest is
// as good as not given. ReadIntrinsics says what each means.
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

void ReadCamera(OptionSection* top,
                CameraModel* camera,
                std::optional<Eigen::Isometry3d>* T_camera_lidar_guess,
                LensInRig* lens) {
  OptionSection section = lens != nullptr ? top->Section("camera", kMeaning)
                                          : top->RequiredSection("camera", kMeaning, kLensRemedy);
  if (!top->Has("camera")) return;
  if (lens == nullptr || HasWholeLens(section)) {
    ReadIntrinsics(&section, camera);
    if (lens != nullptr) *lens = {camera->lens, *camera};
  } else {
    ReadPartOfLens(&section, camera, lens);
  }
  *T_camera_lidar_guess = section.ReadTransform(
      "T_camera_lidar_guess",
      "where the lidar is, seen by the camera, within some 5 degrees and 0.2 m, if you know: it "
      "tells where to look for boards that the lidar alone is unsure of. Without it, the first "
      "sure ones tell. A camera that looks where the lidar's x points has quaternion_xyzw: [0.5, "
      "-0.5, 0.5, 0.5]");
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
