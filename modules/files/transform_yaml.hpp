#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "files/number_text.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {

/// A transform as {quaternion_xyzw, translation_m}, the quaternion of unit length to 1e-3.
void ReadTransform(YamlSection* section, Eigen::Isometry3d* T);

/// Its matrix, quaternion_xyzw (w >= 0) and translation_m, whole lines of that indent.
std::string TransformYaml(const Eigen::Isometry3d& T, const std::string& indent);

/// [1, 2, 3]
template <typename Vector>
std::string ListYaml(const Vector& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + NumberText(value);
  return "[" + text + "]";
}

/// One "- [1, 2, 3]" a row.
template <typename Matrix>
std::string RowsYaml(const Matrix& matrix, const std::string& indent) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    std::vector<double> row;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    text += indent + "- " + ListYaml(row) + "\n";
  }
  return text;
}

}  // namespace voqcal
