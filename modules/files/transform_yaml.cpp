#include "files/transform_yaml.hpp"

#include <cmath>
#include <vector>

namespace voqcal {
namespace {

/// x y z w, of the two quaternions of a rotation the one with w >= 0.
Eigen::Vector4d QuaternionXyzw(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  return q.w() < 0 ? -q.coeffs() : q.coeffs();
}

}  // namespace

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

std::string TransformYaml(const Eigen::Isometry3d& T, const std::string& indent) {
  const Eigen::Vector3d translation_m = T.translation();
  return indent + "matrix:\n" + RowsYaml(T.matrix(), indent + "  ") +         //
         indent + "quaternion_xyzw: " + ListYaml(QuaternionXyzw(T)) + "\n" +  //
         indent + "translation_m: " + ListYaml(translation_m) + "\n";
}

}  // namespace voqcal
