// The exports that OpenCV itself reads.

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>

#include "files/atomic_file.hpp"
#include "rig/rig.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

TEST(ExportOpencv, ProjectsLidarPointsToTheSamePixels) {
  const test::TemporaryFolder folder;
  const std::string rig_path = folder.Write("rig.yaml", test::SimulatedRigText());
  const Rig rig = LoadRig(rig_path);
  const std::string result = folder.Write("result.yaml",
                                          "T_camera_lidar:\n"
                                          "  quaternion_xyzw: [0.5, -0.5, 0.5, 0.5]\n"
                                          "  translation_m: [0.06, -0.1, -0.04]\n");
  const std::string out = folder.path() / "opencv.yaml";
  const test::Outcome outcome = test::Run({test::Program("export_extrinsic"),
                                           result,
                                           "--format",
                                           "opencv",
                                           "--rig",
                                           rig_path,
                                           "--out",
                                           out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const cv::FileStorage file(out, cv::FileStorage::READ);
  cv::Mat rvec;
  cv::Mat tvec;
  cv::Mat camera_matrix;
  cv::Mat distortion;
  file["rvec"] >> rvec;
  file["tvec"] >> tvec;
  file["camera_matrix"] >> camera_matrix;
  file["distortion_coefficients"] >> distortion;
  EXPECT_EQ(std::string(file["parent"]), "lidar");
  EXPECT_EQ(std::string(file["child"]), "camera");

  // The quaternion turns lidar x, y, z (forward, left, up) to camera z, -x, -y.
  const std::vector<cv::Point3d> points_lidar_m = {{5, 1, 0.5}, {3, -1, -0.5}, {8, 0, 2}};
  std::vector<cv::Point2d> pixels;
  cv::fisheye::projectPoints(points_lidar_m, pixels, rvec, tvec, camera_matrix, distortion);
  for (std::size_t i = 0; i < points_lidar_m.size(); ++i) {
    const cv::Point3d& p = points_lidar_m[i];
    const Eigen::Vector3d p_camera_m(-p.y + 0.06, -p.z - 0.1, p.x - 0.04);
    const Eigen::Vector2d expected_px = rig.camera.Project<double>(p_camera_m);
    // 1e-9 m at 3 m and 750 px focal length is 3e-7 px.
    EXPECT_NEAR(pixels[i].x, expected_px.x(), 1e-6);
    EXPECT_NEAR(pixels[i].y, expected_px.y(), 1e-6);
  }
}

}  // namespace
}  // namespace voqcal
