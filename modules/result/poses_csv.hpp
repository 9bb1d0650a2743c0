#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// Features that another program extracted, one sample a pose.
struct PosesCsv {
  /// id is the file's pose number and utime that many seconds. The covariances, the pixels of the
  /// inner corners and the points on the board are not in such a file.
  std::vector<BoardSample> samples;
  std::vector<double> metres_per_pixel;  ///< One for each sample, as the file says.
  /// What was turned to fit our conventions, one line a kind: "30 poses: the camera's corners ran
  /// clockwise". Empty if nothing was.
  std::vector<std::string> remarks;
};

/// Reads the table that the authors of the paper write (cam_lidar_calibration, poses.csv): three
/// numbers a line, 19 lines a pose, millimetres. Line by line: camera centre, camera normal, 4
/// camera corners, lidar centre, lidar normal, 4 lidar corners, 2 lines of angles, widths, heights,
/// distance (m), metres per pixel, pose number.
///
/// Normals are turned to the sensor. The corners of both sensors are put into BoardSpec's order by
/// their sense of rotation and their edge lengths; which of the two half-turns it is remains open,
/// as always without an extrinsic. Edge lengths are those of the lidar's corners.
///
/// @throws std::runtime_error naming the file, the line, what was wanted there and what there is.
PosesCsv ReadPosesCsv(const std::filesystem::path& path, const BoardSpec& board);

}  // namespace voqcal
