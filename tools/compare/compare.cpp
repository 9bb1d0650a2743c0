// compare: how far two extrinsics are apart, e.g. a result and a simulated rig's truth.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/tool_main.hpp"
#include "core/geometry/rigid.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct CompareArgs {
  std::filesystem::path extrinsic;
  std::optional<std::filesystem::path> with;
  std::optional<std::filesystem::path> rig;
  std::optional<double> max_rotation_deg;
  std::optional<double> max_translation_mm;
};

void PrintTransform(const char* name, const Eigen::Isometry3d& T_camera_lidar) {
  const Eigen::Vector3d& t = T_camera_lidar.translation();
  Eigen::Quaterniond q(T_camera_lidar.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  std::printf("%-10s t_m %9.5f %9.5f %9.5f   q_xyzw %9.6f %9.6f %9.6f %9.6f\n",
              name,
              t.x(),
              t.y(),
              t.z(),
              q.x(),
              q.y(),
              q.z(),
              q.w());
}

void Compare(const CompareArgs& args) {
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.extrinsic);
  const Eigen::Isometry3d T_reference =
      args.with ? ReadExtrinsic(*args.with) : LoadRig(*args.rig).simulation.T_camera_lidar;
  const Vector6d difference = DifferenceLeft(T_reference, T_camera_lidar);
  const double rotation_deg = difference.head<3>().norm() * 180.0 / M_PI;
  const double translation_mm = 1e3 * difference.tail<3>().norm();
  PrintTransform(args.with ? "reference" : "truth", T_reference);
  PrintTransform("result", T_camera_lidar);
  std::printf("difference rotation %.4f deg   translation %.2f mm (%.2f %.2f %.2f)\n",
              rotation_deg,
              translation_mm,
              1e3 * difference[3],
              1e3 * difference[4],
              1e3 * difference[5]);
  if (rotation_deg > args.max_rotation_deg.value_or(360)) {
    throw std::runtime_error("rotation differs by more than " +
                             std::to_string(*args.max_rotation_deg) + " deg");
  }
  if (args.max_translation_mm && translation_mm > *args.max_translation_mm) {
    throw std::runtime_error("translation differs by more than " +
                             std::to_string(*args.max_translation_mm) + " mm");
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Compares T_camera_lidar of a result with another, or with a simulated rig's truth.",
               "compare");
  voqcal::CompareArgs args;
  app.add_option("extrinsic", args.extrinsic, "extrinsic.yaml")->required();
  auto* reference = app.add_option_group("reference", "One of:");
  reference->add_option("--with", args.with, "Another extrinsic.yaml");
  reference->add_option("--truth-of", args.rig, "A simulated rig's file");
  reference->require_option(1);
  app.add_option("--max-rotation-deg", args.max_rotation_deg, "Fail (exit 1) beyond this");
  app.add_option("--max-translation-mm", args.max_translation_mm, "Fail (exit 1) beyond this");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Compare(args); });
}
