#include "messaging/convert_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/lidar/cloud_fields.hpp"
#include "core/lidar/repeated_points.hpp"
#include "messaging/message_error.hpp"

namespace voqcal {
namespace {

// Of pointfield_t::datatype.
enum Datatype : std::int8_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8,
};

/// Bytes of one element; 0 for an unknown type.
int NumBytesOf(std::int8_t datatype) {
  switch (datatype) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kFloat32:
      return 4;
    case kFloat64:
      return 8;
    default:
      return 0;
  }
}

// ---- Writing.

void AddField(const std::string& name, Datatype datatype, pointcloud2_t* message) {
  pointfield_t field{};
  field.name = name;
  field.offset = message->point_step;
  field.datatype = datatype;
  field.count = 1;
  message->fields.push_back(field);
  message->nfields = static_cast<std::int32_t>(message->fields.size());
  message->point_step += NumBytesOf(datatype);
}

/// Writes one number at `*end` and moves it on.
template <typename T>
void Put(T value, std::uint8_t** end) {
  std::memcpy(*end, &value, sizeof(T));  // little-endian host, as x86-64 and arm64 are
  *end += sizeof(T);
}

// ---- Reading.

[[noreturn]] void Fail(const std::string& cause) {
  throw MessageError("point cloud message: " + cause);
}

/// A field by any of its usual names.
const pointfield_t* FieldOf(const pointcloud2_t& message, const char* name) {
  std::vector<std::string> names;
  for (const pointfield_t& field : message.fields) names.push_back(field.name);
  const auto found = FindField(names, name);
  return found ? &message.fields[*found] : nullptr;
}

/// One field of each point as a double, which holds every type that occurs.
class FieldReader {
 public:
  FieldReader(const pointcloud2_t& message, const pointfield_t& field)
      : datatype_(field.datatype), is_big_endian_(message.is_bigendian != 0) {
    const int num_bytes = NumBytesOf(field.datatype);
    if (num_bytes == 0) {
      Fail("field '" + field.name + "' has unknown datatype " + std::to_string(field.datatype));
    }
    if (field.offset < 0 || std::int64_t{field.offset} + num_bytes > message.point_step) {
      Fail("field '" + field.name + "' at offset " + std::to_string(field.offset) +
           " does not fit a point of " + std::to_string(message.point_step) + " bytes");
    }
    offset_ = static_cast<std::size_t>(field.offset);
    num_bytes_ = static_cast<std::size_t>(num_bytes);
  }

  double Read(const std::uint8_t* point) const {
    // Nearly all numbers of nearly all drivers, and at 2.6 million points a second they count.
    if (datatype_ == kFloat32 && !is_big_endian_) {
      float value = 0;
      std::memcpy(&value, point + offset_, sizeof(value));
      return value;
    }
    const std::uint64_t bits = Bits(point + offset_);
    switch (datatype_) {
      case kInt8:
        return static_cast<std::int8_t>(bits);
      case kInt16:
        return static_cast<std::int16_t>(bits);
      case kInt32:
        return static_cast<std::int32_t>(bits);
      case kFloat32:
        return As<float>(static_cast<std::uint32_t>(bits));
      case kFloat64:
        return As<double>(bits);
      default:
        return static_cast<double>(bits);  // unsigned
    }
  }

  bool IsInteger() const { return datatype_ < kFloat32; }

 private:
  std::uint64_t Bits(const std::uint8_t* bytes) const {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < num_bytes_; ++i) {
      const std::size_t place = is_big_endian_ ? num_bytes_ - 1 - i : i;
      bits |= std::uint64_t{bytes[i]} << (8 * place);
    }
    return bits;
  }

  template <typename T, typename Bits>
  static T As(Bits bits) {
    static_assert(sizeof(T) == sizeof(Bits));
    T value;
    std::memcpy(&value, &bits, sizeof(T));
    return value;
  }

  std::int8_t datatype_;
  bool is_big_endian_;
  std::size_t offset_ = 0;
  std::size_t num_bytes_ = 0;
};

std::optional<FieldReader> Reader(const pointcloud2_t& message, const char* name) {
  const pointfield_t* field = FieldOf(message, name);
  if (field == nullptr) return std::nullopt;
  return FieldReader(message, *field);
}

FieldReader RequiredReader(const pointcloud2_t& message, const char* name) {
  const auto reader = Reader(message, name);
  if (!reader) Fail("no field '" + std::string(name) + "'");
  return *reader;
}

/// Bytes from one row to the next. Some drivers leave row_step 0.
std::int64_t CheckedRowStep(const pointcloud2_t& message) {
  if (message.height < 0 || message.width < 0) {
    Fail(std::to_string(message.width) + " x " + std::to_string(message.height) + " points");
  }
  if (message.data_nbytes < 0 ||
      static_cast<std::size_t>(message.data_nbytes) != message.data.size()) {
    Fail("data_nbytes is " + std::to_string(message.data_nbytes) + " but there are " +
         std::to_string(message.data.size()) + " bytes");
  }
  if (message.width == 0 || message.height == 0) return 0;
  if (message.point_step <= 0) Fail("point_step is " + std::to_string(message.point_step));
  const std::int64_t row_bytes = std::int64_t{message.width} * message.point_step;
  const std::int64_t row_step = message.row_step == 0 ? row_bytes : message.row_step;
  if (row_step < row_bytes) {
    Fail("row_step is " + std::to_string(row_step) + " but a row has " + std::to_string(row_bytes) +
         " bytes");
  }
  const std::int64_t num_needed = (message.height - std::int64_t{1}) * row_step + row_bytes;
  if (num_needed > message.data_nbytes) {
    Fail(std::to_string(message.width) + " x " + std::to_string(message.height) + " points need " +
         std::to_string(num_needed) + " bytes but there are " +
         std::to_string(message.data_nbytes));
  }
  return row_step;
}

/// A sweep tells by its range what its times count. One of a few points does not: whole numbers are
/// nanoseconds, others seconds, as drivers mostly have it.
void SetPointTimes(std::vector<double> times,
                   bool are_whole,
                   std::int64_t utime,
                   PointCloud* cloud) {
  const double stamp_s = 1e-6 * static_cast<double>(utime);
  SetTimes(times, cloud, stamp_s);
  if (cloud->has_time) return;
  constexpr double kSurelyEpochS = 1e8;
  constexpr double kLongestSweepS = 2.5;
  for (double& time : times) {
    if (are_whole) time *= 1e-9;
    if (time > kSurelyEpochS) time -= stamp_s;
    if (std::abs(time) > kLongestSweepS) return;
  }
  SetTimes(times, cloud);
}

}  // namespace

pointcloud2_t ToMessage(const PointCloud& cloud_lidar_m, std::int64_t utime, std::int32_t seq) {
  pointcloud2_t message{};
  message.utime = utime;
  message.seq = seq;
  message.frame_id = "lidar";
  for (const char* axis : {"x", "y", "z"}) AddField(axis, kFloat32, &message);
  if (cloud_lidar_m.has_intensity) AddField("intensity", kFloat32, &message);
  if (cloud_lidar_m.has_ring) AddField("ring", kUint16, &message);
  if (cloud_lidar_m.has_time) AddField("time", kFloat32, &message);
  if (cloud_lidar_m.has_return_number) AddField("return_number", kUint8, &message);

  message.data.resize(cloud_lidar_m.points.size() * static_cast<std::size_t>(message.point_step));
  std::uint8_t* end = message.data.data();
  bool is_dense = true;
  for (const LidarPoint& point : cloud_lidar_m.points) {
    for (const float coordinate : point.position_m) Put(coordinate, &end);
    if (cloud_lidar_m.has_intensity) Put(point.intensity, &end);
    if (cloud_lidar_m.has_ring) Put(point.ring, &end);
    if (cloud_lidar_m.has_time) Put(point.time_s, &end);
    if (cloud_lidar_m.has_return_number) Put(point.return_number, &end);
    is_dense = is_dense && point.position_m.allFinite();
  }
  message.height = 1;
  message.width = static_cast<std::int32_t>(cloud_lidar_m.points.size());
  message.data_nbytes = static_cast<std::int32_t>(message.data.size());
  message.row_step = message.data_nbytes;
  message.is_dense = is_dense ? 1 : 0;
  return message;
}

PointCloud FromMessage(const pointcloud2_t& message) {
  const std::int64_t row_step = CheckedRowStep(message);
  PointCloud cloud;
  if (message.width == 0 || message.height == 0) return cloud;
  const FieldReader x = RequiredReader(message, "x");
  const FieldReader y = RequiredReader(message, "y");
  const FieldReader z = RequiredReader(message, "z");
  const auto intensity = Reader(message, "intensity");
  const auto ring = Reader(message, "ring");
  const auto time = Reader(message, "time");
  const auto return_number = Reader(message, "return_number");
  cloud.has_intensity = intensity.has_value();

  cloud.points.reserve(static_cast<std::size_t>(message.width) *
                       static_cast<std::size_t>(message.height));
  std::vector<double> rings;
  std::vector<double> times;
  std::vector<double> return_numbers;
  if (ring) rings.reserve(cloud.points.capacity());
  if (time) times.reserve(cloud.points.capacity());
  if (return_number) return_numbers.reserve(cloud.points.capacity());
  for (std::int64_t row = 0; row < message.height; ++row) {
    const std::uint8_t* bytes = message.data.data() + row * row_step;
    for (std::int32_t i = 0; i < message.width; ++i, bytes += message.point_step) {
      LidarPoint point;
      point.position_m = Eigen::Vector3d(x.Read(bytes), y.Read(bytes), z.Read(bytes)).cast<float>();
      if (intensity) point.intensity = static_cast<float>(intensity->Read(bytes));
      if (ring) rings.push_back(ring->Read(bytes));
      if (time) times.push_back(time->Read(bytes));
      if (return_number) return_numbers.push_back(return_number->Read(bytes));
      cloud.points.push_back(point);
    }
  }
  if (ring) SetRings(rings, &cloud);
  if (return_number) SetReturnNumbers(return_numbers, &cloud);
  if (time) SetPointTimes(std::move(times), time->IsInteger(), message.utime, &cloud);
  DropRepeatedPoints(&cloud);
  return cloud;
}

}  // namespace voqcal
