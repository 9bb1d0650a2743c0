#include "core/guidance/advice.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "core/guidance/placement.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

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
  const auto tens = std::lround(std::abs(angle_rad) * kDegPerRad / 10.0);
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

std::string MoveWords(const Eigen::Vector3d& move_camera_m) {
  std::vector<std::string> parts;
  const auto add = [&](double length_m, const char* forward, const char* backward) {
    const std::string length = Length(length_m);
    if (!length.empty()) parts.push_back(length + (length_m > 0.0 ? forward : backward));
  };
  add(move_camera_m.z(), " away from the camera", " towards the camera");
  add(move_camera_m.x(), " to the right", " to the left");
  add(-move_camera_m.y(), " up", " down");
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

std::string TurnWords(const Placement& placement) {
  const bool is_diamond = std::abs(std::sin(2.0 * placement.turn_rad)) > std::sqrt(0.5);
  return is_diamond ? "as a diamond" : "upright";
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
                      const CameraModel& camera) {
  const Eigen::Vector3d image_up_camera = -Eigen::Vector3d::UnitY();
  const Placement placement = PlacementOf(T_camera_board, camera, image_up_camera);
  const std::string where = last_centre_camera_m
                                ? MoveWords(T_camera_board.translation() - *last_centre_camera_m)
                                : PlaceWords(placement, camera);
  return where + " Hold it " + TurnWords(placement) + ", " + TiltWords(placement) + ".";
}

}  // namespace voqcal
