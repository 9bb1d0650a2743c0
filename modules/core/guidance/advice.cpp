#include "core/guidance/advice.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "core/guidance/placement.hpp"

namespace voqcal {
namespace {

constexpr double kDegreesPerRadian = 180.0 / M_PI;

// Empty for what is not worth a move.
std::string Length(double length_m) {
  constexpr double kLeastM = 0.15;
  const double size_m = std::abs(length_m);
  if (size_m < kLeastM) return {};
  const double step_m = size_m < 1.45 ? 0.1 : 0.5;
  const int decimetres = static_cast<int>(std::lround(10.0 * step_m * std::round(size_m / step_m)));
  if (decimetres == 5) return "half a metre";
  if (decimetres < 10) return std::to_string(10 * decimetres) + " cm";
  std::string text = std::to_string(decimetres / 10);
  if (decimetres % 10 != 0) text += "." + std::to_string(decimetres % 10);
  return text + " m";
}

// Empty for what nobody sees.
std::string Angle(double angle_rad) {
  const auto tens = std::lround(std::abs(angle_rad) * kDegreesPerRadian / 10.0);
  return tens == 0 ? std::string() : std::to_string(10 * tens) + " degrees";
}

std::string Joined(const std::vector<std::string>& parts, const char* last_link) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? last_link : ", ";
    text += parts[i];
  }
  return text;
}

struct Axes {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  Eigen::Vector3d away;
};

// Upright, seen from behind the camera.
Axes UprightAxes(const Eigen::Vector3d& up_camera) {
  Axes axes;
  axes.up = up_camera.normalized();
  axes.right = Eigen::Vector3d::UnitZ().cross(axes.up).normalized();
  axes.away = axes.up.cross(axes.right);
  return axes;
}

std::string MoveWords(const Eigen::Vector3d& move_camera_m, const Eigen::Vector3d& up_camera) {
  const Axes axes = UprightAxes(up_camera);
  std::vector<std::string> parts;
  const auto add = [&](double length_m, const char* forward, const char* backward) {
    const std::string length = Length(length_m);
    if (!length.empty()) parts.push_back(length + (length_m > 0.0 ? forward : backward));
  };
  add(axes.away.dot(move_camera_m), " away from the camera", " towards the camera");
  add(axes.right.dot(move_camera_m), " to the right", " to the left");
  add(axes.up.dot(move_camera_m), " up", " down");
  return parts.empty() ? "Leave the board where it is."
                       : "Move the board " + Joined(parts, " and ") + ".";
}

// From nothing: the distance, and which third of the image.
std::string PlaceWords(const Placement& placement, const CameraModel& camera) {
  const auto third = [](double pixel_px, int size_px) {
    return static_cast<int>(std::floor(3.0 * (pixel_px + 0.5) / size_px));
  };
  const int column = third(placement.centre_px.x(), camera.width_px);
  const int row = third(placement.centre_px.y(), camera.height_px);
  std::vector<std::string> sides;
  if (row != 1) sides.emplace_back(row < 1 ? "upper" : "lower");
  if (column != 1) sides.emplace_back(column < 1 ? "left" : "right");
  std::string where = "in the middle of the image";
  if (!sides.empty()) where = "in the " + Joined(sides, " ") + " part of the image";
  return "Hold the board " + Length(placement.distance_m) + " from the camera, " + where + ".";
}

std::string TiltWords(const Placement& placement) {
  std::vector<std::string> parts;
  const std::string pitch = Angle(placement.pitch_rad);
  const std::string yaw = Angle(placement.yaw_rad);
  if (!pitch.empty()) {
    parts.push_back((placement.pitch_rad > 0.0 ? "the top " : "the bottom ") + pitch);
  }
  if (!yaw.empty()) {
    parts.push_back((placement.yaw_rad > 0.0 ? "the left side " : "the right side ") + yaw);
  }
  return parts.empty() ? "facing the camera" : Joined(parts, " and ") + " towards the camera";
}

}  // namespace

std::string HoldWords(const Eigen::Isometry3d& T_camera_board,
                      const std::optional<Eigen::Vector3d>& last_centre_camera_m,
                      const CameraModel& camera,
                      const Eigen::Vector3d& up_camera) {
  const Placement placement = PlacementOf(T_camera_board, camera, up_camera);
  const std::string where =
      last_centre_camera_m
          ? MoveWords(T_camera_board.translation() - *last_centre_camera_m, up_camera)
          : PlaceWords(placement, camera);
  return where + " Hold it as a diamond, " + TiltWords(placement) + ".";
}

std::string EnoughWords(const WorstError& worst, const ErrorTolerance& tolerance) {
  std::ostringstream text;
  text.precision(2);
  const std::string unit = ToString(tolerance.unit);
  text << "Enough: " << worst.error << " " << unit << " at worst, at " << worst.range_m << " m; "
       << tolerance.tolerance << " " << unit << " are asked.";
  return text.str();
}

}  // namespace voqcal
