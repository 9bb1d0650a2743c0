#include "result/poses_csv.hpp"

#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "files/atomic_file.hpp"
#include "files/number_text.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kLinesPerPose = 19;
constexpr const char* kLineNames[kLinesPerPose] = {"camera centre",
                                                   "camera normal",
                                                   "camera corner 1",
                                                   "camera corner 2",
                                                   "camera corner 3",
                                                   "camera corner 4",
                                                   "lidar centre",
                                                   "lidar normal",
                                                   "lidar corner 1",
                                                   "lidar corner 2",
                                                   "lidar corner 3",
                                                   "lidar corner 4",
                                                   "angles",
                                                   "angles",
                                                   "widths",
                                                   "heights",
                                                   "distance",
                                                   "metres per pixel",
                                                   "pose number"};
constexpr double kMPerMm = 1e-3;

using Lines = std::vector<Eigen::Vector3d>;
using Remarks = std::map<std::string, int>;

class Table {
 public:
  Table(const std::filesystem::path& path, const std::string& text) : path_(path.string()) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines_.push_back(ParseLine(line));
    if (lines_.empty()) throw std::runtime_error(path_ + ": has no pose, is empty");
    const std::size_t num_over = lines_.size() % kLinesPerPose;
    if (num_over != 0) Fail(lines_.size(), NameOf(lines_.size()), "the end of the file");
  }

  std::size_t num_poses() const { return lines_.size() / kLinesPerPose; }
  const Eigen::Vector3d& line(std::size_t pose, std::size_t i) const {
    return lines_[pose * kLinesPerPose + i];
  }

  /// Names the line of pose `pose` (both from 0).
  [[noreturn]] void FailAt(std::size_t pose, std::size_t i, const std::string& wanted) const {
    const Eigen::Vector3d& v = line(pose, i);
    Fail(pose * kLinesPerPose + i,
         kLineNames[i] + (", " + wanted),
         NumberText(v.x()) + "," + NumberText(v.y()) + "," + NumberText(v.z()));
  }

 private:
  static std::string NameOf(std::size_t line_index) {
    return kLineNames[line_index % kLinesPerPose] + std::string(", three numbers");
  }

  [[noreturn]] void Fail(std::size_t line_index,
                         const std::string& wanted,
                         const std::string& there) const {
    throw std::runtime_error(path_ + ":" + std::to_string(line_index + 1) + ": wanted the " +
                             wanted + ", there is " + there);
  }

  Eigen::Vector3d ParseLine(std::string text) const {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    Eigen::Vector3d values;
    std::istringstream fields(text);
    bool is_good = true;
    for (int i = 0; i < 3; ++i) {
      std::string field;
      is_good = is_good && std::getline(fields, field, ',') &&
                ParseNumber(Trimmed(field), &values[i]) && std::isfinite(values[i]);
    }
    std::string rest;
    if (!is_good || std::getline(fields, rest)) {
      Fail(lines_.size(), NameOf(lines_.size()), '"' + text.substr(0, 60) + '"');
    }
    return values;
  }

  static std::string Trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
  }

  std::string path_;
  Lines lines_;
};

std::array<double, 4> EdgeLengthsM(const std::array<Eigen::Vector3d, 4>& corners_m) {
  std::array<double, 4> lengths_m{};
  for (std::size_t i = 0; i < 4; ++i) {
    lengths_m[i] = (corners_m[(i + 1) % 4] - corners_m[i]).norm();
  }
  return lengths_m;
}

/// Puts the corners into BoardSpec's order: counter-clockwise about the normal, the first edge
/// along the width. Says what it had to turn.
void OrderCorners(const BoardSpec& board,
                  const std::string& sensor,
                  BoardPose* pose,
                  Remarks* remarks) {
  auto& corners = pose->corners_m;
  const Eigen::Vector3d area_vector = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
  if (area_vector.dot(pose->normal) < 0) {
    ++(*remarks)["the " + sensor + "'s corners ran clockwise"];
    std::swap(corners[0], corners[1]);
    std::swap(corners[2], corners[3]);
  }
  const auto lengths_m = EdgeLengthsM(corners);
  const double first_m = lengths_m[0] + lengths_m[2];
  const double second_m = lengths_m[1] + lengths_m[3];
  if ((first_m > second_m) != (board.width_m > board.height_m)) {
    ++(*remarks)["the " + sensor + "'s corners began along the height"];
    corners = {corners[1], corners[2], corners[3], corners[0]};
  }
}

/// One sensor's pose from its centre, normal and 4 corners, which begin at line `begin`.
BoardPose ReadPose(const Table& table,
                   std::size_t pose_index,
                   std::size_t begin,
                   const std::string& sensor,
                   const BoardSpec& board,
                   Remarks* remarks) {
  constexpr double kMaxLengthError = 1e-2;  // Written with 5 digits; anything worse is no normal.
  constexpr double kMinAreaM2 = 1e-6;
  BoardPose pose;
  pose.centre_m = table.line(pose_index, begin) * kMPerMm;
  pose.normal = table.line(pose_index, begin + 1);
  if (std::abs(pose.normal.norm() - 1) > kMaxLengthError) {
    table.FailAt(pose_index, begin + 1, "a direction of length 1");
  }
  pose.normal.normalize();
  for (std::size_t i = 0; i < 4; ++i) {
    pose.corners_m[i] = table.line(pose_index, begin + 2 + i) * kMPerMm;
  }
  const auto& c = pose.corners_m;
  if ((c[2] - c[0]).cross(c[3] - c[1]).norm() < kMinAreaM2) {
    table.FailAt(pose_index, begin + 2, "the first of four corners with an area between them");
  }
  if (pose.normal.dot(pose.centre_m) > 0) {
    pose.normal = -pose.normal;
    ++(*remarks)["the " + sensor + "'s normal pointed away from it"];
  }
  OrderCorners(board, sensor, &pose, remarks);
  return pose;
}

/// The pose number, a whole one that no earlier pose has.
std::int64_t ReadId(const Table& table, std::size_t pose_index, std::set<std::int64_t>* taken) {
  constexpr std::size_t kLine = 18;
  constexpr double kMaxNumber = 1e9;
  const double number = table.line(pose_index, kLine).x();
  if (number != std::floor(number) || number < 1 || number > kMaxNumber) {
    table.FailAt(pose_index, kLine, "a whole number from 1");
  }
  const auto id = static_cast<std::int64_t>(number);
  if (!taken->insert(id).second) table.FailAt(pose_index, kLine, "one that is not given twice");
  return id;
}

}  // namespace

PosesCsv ReadPosesCsv(const std::filesystem::path& path, const BoardSpec& board) {
  const Table table(path, ReadWholeFile(path));
  PosesCsv poses;
  Remarks remarks;
  std::set<std::int64_t> ids;
  for (std::size_t i = 0; i < table.num_poses(); ++i) {
    BoardSample sample;
    sample.id = ReadId(table, i, &ids);
    sample.utime = sample.id * 1'000'000;
    sample.camera.pose = ReadPose(table, i, 0, "camera", board, &remarks);
    sample.lidar.pose = ReadPose(table, i, 6, "lidar", board, &remarks);
    sample.lidar.edge_lengths_m = EdgeLengthsM(sample.lidar.pose.corners_m);
    poses.samples.push_back(sample);
    poses.metres_per_pixel.push_back(table.line(i, 17).x());
  }
  for (const auto& [what, count] : remarks) {
    poses.remarks.push_back(std::to_string(count) + " poses: " + what);
  }
  return poses;
}

}  // namespace voqcal
