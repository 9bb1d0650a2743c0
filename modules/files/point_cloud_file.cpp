#include "files/point_cloud_file.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "core/lidar/cloud_fields.hpp"
#include "files/atomic_file.hpp"
#include "files/point_cloud_table.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

/// A column by any of its usual names; empty if the file does not have it.
std::vector<double> Column(const CloudTable& table, const char* field) {
  const auto column = FindField(table.names, field);
  if (!column) return {};
  std::vector<double> values(table.num_points);
  for (std::size_t i = 0; i < table.num_points; ++i) {
    values[i] = table.values[i * table.names.size() + *column];
  }
  return values;
}

PointCloud Convert(const CloudTable& table, const fs::path& path) {
  const std::vector<double> x = Column(table, "x");
  const std::vector<double> y = Column(table, "y");
  const std::vector<double> z = Column(table, "z");
  if (x.empty() || y.empty() || z.empty()) Fail(path, "must have the fields x, y and z");
  const std::vector<double> intensity = Column(table, "intensity");

  PointCloud cloud;
  cloud.has_intensity = !intensity.empty();
  cloud.points.resize(table.num_points);
  for (std::size_t i = 0; i < table.num_points; ++i) {
    cloud.points[i].position_m = Eigen::Vector3d(x[i], y[i], z[i]).cast<float>();
    if (cloud.has_intensity) cloud.points[i].intensity = static_cast<float>(intensity[i]);
  }
  const std::vector<double> rings = Column(table, "ring");
  if (!rings.empty()) SetRings(rings, &cloud);
  const std::vector<double> return_numbers = Column(table, "return_number");
  if (!return_numbers.empty()) SetReturnNumbers(return_numbers, &cloud);
  const std::vector<double> times = Column(table, "time");
  if (!times.empty()) SetTimes(times, &cloud);
  return cloud;
}

}  // namespace

PointCloud ReadPointCloud(const fs::path& path) {
  const std::string extension = path.extension().string();
  const bool is_ply = extension == ".ply" || extension == ".PLY";
  if (!is_ply && extension != ".pcd" && extension != ".PCD") {
    Fail(path, "must be a .pcd or .ply file");
  }
  const std::string contents = ReadWholeFile(path);
  return Convert(is_ply ? ReadPly(path, contents) : ReadPcd(path, contents), path);
}

}  // namespace voqcal
