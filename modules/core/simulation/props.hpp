#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace voqcal {

/// What a surface of the room is made of; decides its texture.
enum class Material {
  kFloor,
  kCeiling,
  kWall,
  kDoor,
  kPillar,
  kTable,
  kCrate,
  kCupboard,
  kCloth,
  kSkin,
  kMetal,
  kWhiteboard,
};

/// An axis-aligned box in the lidar frame.
struct Box {
  Eigen::Vector3d min_lidar_m;
  Eigen::Vector3d max_lidar_m;
  Material material = Material::kCrate;
};

/// A straight round bar or a limb, without end caps.
struct Tube {
  Eigen::Vector3d begin_m;
  Eigen::Vector3d end_m;
  double radius_m = 0.0;
  Material material = Material::kMetal;

  /// Distance along a ray (unit direction) to the tube's outside.
  std::optional<double> Cast(const Eigen::Vector3d& origin_m,
                             const Eigen::Vector3d& direction) const;
};

/// A flat rectangle without thickness, seen from both sides: its frame has its origin at the centre
/// and z across it.
struct Panel {
  Eigen::Isometry3d T_lidar_panel = Eigen::Isometry3d::Identity();
  double width_m = 0.0;   ///< Along the panel's x.
  double height_m = 0.0;  ///< Along the panel's y.
  Material material = Material::kWhiteboard;

  /// Distance along a ray to the panel.
  std::optional<double> Cast(const Eigen::Vector3d& origin_m,
                             const Eigen::Vector3d& direction) const;
};

/// Things that stand about.
struct Props {
  std::vector<Box> boxes;
  std::vector<Tube> tubes;
  std::vector<Panel> panels;

  void Append(const Props& others);
};

// How far a point is from a thing; zero inside of it.
double DistanceM(const Box& box, const Eigen::Vector3d& point_m);
double DistanceM(const Tube& tube, const Eigen::Vector3d& point_m);
double DistanceM(const Panel& panel, const Eigen::Vector3d& point_m);

}  // namespace voqcal
