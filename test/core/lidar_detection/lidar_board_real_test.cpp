#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "core/median.hpp"
#include "support/real_data.hpp"
#include "support/real_sweeps.hpp"

namespace voqcal {
namespace {

using test::LoadPcd;

const BoardSpec& kBoard = test::kAcfrBoard;

struct TableRow {
  Eigen::Vector3d camera_centre_m;
  Eigen::Vector3d lidar_centre_m;
  Eigen::Vector3d lidar_normal;
};

/// poses.csv by pose number; 19 lines of three numbers a pose.
std::map<int, TableRow> LoadTable(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::map<int, TableRow> table;
  std::vector<Eigen::Vector3d> rows;
  std::string line;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    Eigen::Vector3d row = Eigen::Vector3d::Zero();
    numbers >> row.x() >> row.y() >> row.z();
    rows.push_back(row);
    if (rows.size() < 19) continue;
    table[static_cast<int>(rows[18].x())] = {rows[0] / 1e3, rows[6] / 1e3, rows[7]};
    rows.clear();
  }
  return table;
}

/// All that a sweep says, and the table's row of the same pose.
struct Found {
  int pose = 0;
  LidarBoard board;
  TableRow row;
};

class RealSweeps : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::RealDataFolder();
    if (!folder) GTEST_SKIP() << "no ../shared/data on this machine";
    folder_ = *folder / "acfr-vlp16";
  }

  std::vector<Found> DetectAll(const std::string& kind) const {
    std::vector<Found> found;
    for (const auto& [pose, row] : LoadTable(folder_ / "poses.csv")) {
      const auto path = folder_ / "pcd" / ("pose" + std::to_string(pose) + "_" + kind + ".pcd");
      if (!std::filesystem::exists(path)) continue;
      const auto boards = DetectLidarBoard(LoadPcd(path), kBoard, {});
      if (boards)
        found.push_back({pose, boards->front(), row});
      else
        ADD_FAILURE() << path << ": " << ToString(boards.error());
    }
    return found;
  }

  std::filesystem::path folder_;
};

TEST_F(RealSweeps, AllThirtyBoardsAreFoundWhereTheyAre) {
  const std::vector<Found> found = DetectAll("full");
  ASSERT_EQ(found.size(), 30U);
  std::vector<double> normal_errors_rad;
  std::vector<double> edge_errors_m;
  for (const Found& f : found) {
    double edge_error_m = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      edge_error_m += std::abs(f.board.edge_lengths_m[i] - kBoard.EdgeLengthsM()[i]);
    }
    edge_errors_m.push_back(edge_error_m);
    if (f.pose == 1) continue;  // its row is of another capture
    // The table's centres are about 10 mm accurate (1 sigma).
    EXPECT_LT((f.board.pose.centre_m - f.row.lidar_centre_m).norm(), 0.03) << "pose " << f.pose;
    normal_errors_rad.push_back(AngleBetween(f.board.pose.normal, f.row.lidar_normal));
  }
  EXPECT_LT(Median(normal_errors_rad), 0.026);  // 1.5 degrees: the table's own error
  EXPECT_LT(Median(edge_errors_m), 0.020);
}

TEST_F(RealSweeps, WholeAndHandCroppedSweepsAgree) {
  const std::vector<Found> whole = DetectAll("full");
  for (const Found& f : whole) {
    const auto path = folder_ / "pcd" / ("pose" + std::to_string(f.pose) + "_target.pcd");
    const auto cropped = DetectLidarBoard(LoadPcd(path), kBoard, {});
    // A crop has no background: hits only, which leaves a spacing of beams open on each side.
    ASSERT_TRUE(cropped) << "pose " << f.pose << ": " << ToString(cropped.error());
    EXPECT_LT((f.board.pose.centre_m - cropped->front().pose.centre_m).norm(), 0.02)
        << "pose " << f.pose;
    EXPECT_LT(AngleBetween(f.board.pose.normal, cropped->front().pose.normal), 0.026)
        << "pose " << f.pose;
  }
}

TEST_F(RealSweeps, CentresKeepTheirDistancesFromTheCamera) {
  // Distances between the centres of two poses are the same in both sensors: no extrinsic is needed
  // to judge. The camera's depth is good to about 0.3 percent (8 mm), and the lidar's to 10 mm.
  const std::vector<Found> found = DetectAll("full");
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (found[i].pose == 1 || found[j].pose == 1) continue;
      const double lidar_m = (found[i].board.pose.centre_m - found[j].board.pose.centre_m).norm();
      const double camera_m = (found[i].row.camera_centre_m - found[j].row.camera_centre_m).norm();
      errors_m.push_back(std::abs(lidar_m - camera_m));
    }
  }
  EXPECT_LT(Median(errors_m), 0.010);
}

}  // namespace
}  // namespace voqcal
