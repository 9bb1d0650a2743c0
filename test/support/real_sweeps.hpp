#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal::test {

/// The board of ../shared/data/acfr-vlp16.
inline const BoardSpec kAcfrBoard{0.61, 0.85, 0.095, 5, 7, 0.002, 0.0};

/// An ascii PCD with the fields x y z intensity ring.
inline PointCloud LoadPcd(const std::filesystem::path& path) {
  std::ifstream file(path);
  PointCloud cloud;
  cloud.has_intensity = cloud.has_ring = true;
  std::string line;
  while (std::getline(file, line) && line.rfind("DATA", 0) != 0) {
  }
  LidarPoint point;
  while (file >> point.position_m.x() >> point.position_m.y() >> point.position_m.z() >>
         point.intensity >> point.ring) {
    cloud.points.push_back(point);
  }
  return cloud;
}

}  // namespace voqcal::test
