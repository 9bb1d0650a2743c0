// Stands for genicam_source.cpp where Aravis was not there when voqcal was built.
#include <memory>
#include <stdexcept>

#include "camera_driver/genicam_source.hpp"

namespace voqcal {

std::unique_ptr<CameraSource> MakeGenicamSource(const Rig& rig) {
  throw std::runtime_error(
      rig.path.string() +
      ": camera_driver.source is genicam, for which voqcal was built without Aravis: apt install "
      "libaravis-dev, then tools/build");
}

}  // namespace voqcal
