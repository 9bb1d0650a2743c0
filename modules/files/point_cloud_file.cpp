#include "files/point_cloud_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "files/atomic_file.hpp"
#include "files/point_cloud_table.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

std::optional<std::size_t> ColumnOf(const CloudTable& table, const char* name) {
  const auto found = std::find(table.names.begin(), table.names.end(), name);
  if (found == table.names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.names.begin());
}

std::uint16_t RingOf(double ring, std::size_t point_index, const fs::path& path) {
  constexpr double kMaxRing = 65535;
  if (!(ring >= 0 && ring <= kMaxRing && ring == std::floor(ring))) {
    Fail(path,
         "the ring of point " + std::to_string(point_index) +
             " must be a whole number from 0 to 65535, is " + std::to_string(ring));
  }
  return static_cast<std::uint16_t>(ring);
}

PointCloud Convert(const CloudTable& table, const fs::path& path) {
  const auto x = ColumnOf(table, "x");
  const auto y = ColumnOf(table, "y");
  const auto z = ColumnOf(table, "z");
  const auto intensity = ColumnOf(table, "intensity");
  const auto ring = ColumnOf(table, "ring");
  const auto time = ColumnOf(table, "time");
  if (!x || !y || !z) Fail(path, "must have the fields x, y and z");

  PointCloud cloud;
  cloud.has_intensity = intensity.has_value();
  cloud.has_ring = ring.has_value();
  cloud.has_time = time.has_value();
  cloud.points.resize(table.num_points);
  for (std::size_t i = 0; i < table.num_points; ++i) {
    const double* values = table.values.data() + i * table.names.size();
    LidarPoint& point = cloud.points[i];
    point.position_m = Eigen::Vector3d(values[*x], values[*y], values[*z]).cast<float>();
    if (intensity) point.intensity = static_cast<float>(values[*intensity]);
    if (ring) point.ring = RingOf(values[*ring], i, path);
    if (time) point.time_s = static_cast<float>(values[*time]);
  }
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
