#include "rig/default_rig.hpp"

#include "files/option_section.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {
namespace {

constexpr char kNeeded[] =
    "rig: my_rig\n"
    "board: {width_m: 0.61, height_m: 0.85, square_m: 0.095, num_corners_x: 5, num_corners_y: 7}\n"
    "camera: {lens_model: equidistant, width_px: 1280, height_px: 800, fx_px: 750, fy_px: 750, "
    "cx_px: 639.5, cy_px: 399.5, distortion: [0, 0, 0, 0]}\n";

constexpr char kHead[] =
    "# Every key of a rig file, as check_rig --print-defaults prints it. Copy it, give what is\n"
    "# needed (rig, board, camera), and delete what you do not change: the values of all other "
    "keys\n"
    "# are their defaults. Of a key that is commented out it is an example, or a default that is\n"
    "# rounded here.\n"
    "# Names end with units; _deg: degrees. Files and folders are relative to the rig file.\n"
    "# Several lidars and cameras: config/rigs/several_sensors.yaml.\n";

Rig ReadExample(YamlDocument* document) {
  Rig rig;
  ReadRigSections({"", {}}, document, &rig);
  document->ThrowIfWrong();
  return rig;
}

}  // namespace

std::vector<YamlDocument::KnownKey> DefaultRigKeys() {
  YamlDocument document("the default rig", kNeeded);
  ReadExample(&document);
  return document.known_keys();
}

CameraModel ExampleCamera() {
  YamlDocument document("the default rig", kNeeded);
  return ReadExample(&document).camera;
}

std::string DefaultRigText() { return kHead + DocumentedYaml(DefaultRigKeys()); }

}  // namespace voqcal
