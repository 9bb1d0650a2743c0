#include "rig/transform_yaml.hpp"

#include <cmath>
#include <vector>

namespace voqcal {

void ReadTransform(YamlSection* section, Eigen::Isometry3d* T) {
  constexpr double kMaxLengthError = 1e-3;  // People round quaternions to three or four digits.
  std::vector<double> xyzw = {0, 0, 0, 1};
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  section->Read("quaternion_xyzw", &xyzw);
  section->Read("translation_m", &translation_m);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  if (xyzw.size() == 4) q.coeffs() = Eigen::Map<const Eigen::Vector4d>(xyzw.data());
  if (xyzw.size() != 4 || std::abs(q.norm() - 1) > kMaxLengthError) {
    return section->AddError("quaternion_xyzw", "must be 4 numbers of length 1");
  }
  *T = Eigen::Translation3d(translation_m) * q.normalized();
}

}  // namespace voqcal
