#include "rig/point_cloud_file.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "rig/atomic_file.hpp"
#include "rig/point_cloud_header.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

/// PCL prints its complaints; ours are thrown. Its level is restored at the end of the scope.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

[[noreturn]] void Fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

pcl::PCLPointCloud2 ReadByPcl(const fs::path& path, bool is_ply) {
  const QuietPcl quiet;
  pcl::PCLPointCloud2 cloud;
  int result = -1;
  try {
    result = is_ply ? pcl::PLYReader().read(path.string(), cloud)
                    : pcl::PCDReader().read(path.string(), cloud);
  } catch (const std::exception& error) {
    Fail(path, std::string("cannot be read as a cloud: ") + error.what());
  }
  if (result < 0) Fail(path, "cannot be read as a cloud: its header or its data is damaged");
  return cloud;
}

const pcl::PCLPointField* FindField(const pcl::PCLPointCloud2& cloud, const char* name) {
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name == name && field.count <= 1) return &field;
  }
  return nullptr;
}

template <typename Value>
double ValueAt(const std::uint8_t* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

double FieldOf(const std::uint8_t* point, const pcl::PCLPointField& field) {
  const std::uint8_t* bytes = point + field.offset;
  switch (field.datatype) {
    case pcl::PCLPointField::INT8:
      return ValueAt<std::int8_t>(bytes);
    case pcl::PCLPointField::UINT8:
      return ValueAt<std::uint8_t>(bytes);
    case pcl::PCLPointField::INT16:
      return ValueAt<std::int16_t>(bytes);
    case pcl::PCLPointField::UINT16:
      return ValueAt<std::uint16_t>(bytes);
    case pcl::PCLPointField::INT32:
      return ValueAt<std::int32_t>(bytes);
    case pcl::PCLPointField::UINT32:
      return ValueAt<std::uint32_t>(bytes);
    case pcl::PCLPointField::FLOAT32:
      return ValueAt<float>(bytes);
    case pcl::PCLPointField::FLOAT64:
      return ValueAt<double>(bytes);
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
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

PointCloud Convert(const pcl::PCLPointCloud2& cloud, const fs::path& path) {
  const auto* x = FindField(cloud, "x");
  const auto* y = FindField(cloud, "y");
  const auto* z = FindField(cloud, "z");
  const auto* intensity = FindField(cloud, "intensity");
  const auto* ring = FindField(cloud, "ring");
  const auto* time = FindField(cloud, "time");
  if (x == nullptr || y == nullptr || z == nullptr) Fail(path, "must have the fields x, y and z");
  const std::size_t num_points = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.data.size() < num_points * cloud.point_step)
    Fail(path, "has fewer points than it says");

  PointCloud result;
  result.has_intensity = intensity != nullptr;
  result.has_ring = ring != nullptr;
  result.has_time = time != nullptr;
  result.points.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    const std::uint8_t* bytes = cloud.data.data() + i * cloud.point_step;
    LidarPoint& point = result.points[i];
    point.position_m =
        Eigen::Vector3d(FieldOf(bytes, *x), FieldOf(bytes, *y), FieldOf(bytes, *z)).cast<float>();
    if (intensity != nullptr) point.intensity = static_cast<float>(FieldOf(bytes, *intensity));
    if (ring != nullptr) point.ring = RingOf(FieldOf(bytes, *ring), i, path);
    if (time != nullptr) point.time_s = static_cast<float>(FieldOf(bytes, *time));
  }
  return result;
}

}  // namespace

PointCloud ReadPointCloud(const fs::path& path) {
  const std::string extension = path.extension().string();
  const bool is_ply = extension == ".ply" || extension == ".PLY";
  if (!is_ply && extension != ".pcd" && extension != ".PCD") {
    Fail(path, "must be a .pcd or .ply file");
  }
  const std::string contents = ReadWholeFile(path);
  is_ply ? CheckPly(path, contents) : CheckPcd(path, contents);
  return Convert(ReadByPcl(path, is_ply), path);
}

}  // namespace voqcal
