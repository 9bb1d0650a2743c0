#include "result/extrinsic_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <utility>

#include "core/geometry/rigid.hpp"
#include "files/number_text.hpp"

namespace voqcal {
namespace {

/// NumberText with a dot before any exponent: YAML 1.1 (PyYAML) takes "1e-07" for a string.
std::string ExactText(double value) {
  std::string text = NumberText(value);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

template <typename Values>
std::string Join(const Values& values, const std::string& separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + ExactText(value);
  return text;
}

template <typename Values>
std::string List(const Values& values) {
  return "[" + Join(values, ", ") + "]";
}

/// x y z w, w >= 0.
Eigen::Vector4d QuaternionXyzw(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  return q.w() < 0 ? -q.coeffs() : q.coeffs();
}

Eigen::Vector3d RotationVector(const Eigen::Isometry3d& T) {
  const Eigen::AngleAxisd rotation(T.linear());
  return rotation.angle() * rotation.axis();
}

/// Angles about the fixed axes: R = Rz(yaw) Ry(pitch) Rx(roll). Yaw is taken off before the others
/// are read, so that they fit together also where pitch is near 90 degrees and yaw is arbitrary.
Eigen::Vector3d RollPitchYaw(const Eigen::Matrix3d& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const Eigen::Matrix3d rest =
      Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
  return {std::atan2(-rest(1, 2), rest(1, 1)), std::atan2(-rest(2, 0), rest(0, 0)), yaw};
}

std::string PointText(const Eigen::Vector3d& point) {
  char text[96];
  std::snprintf(text, sizeof(text), "(%.6f, %.6f, %.6f)", point.x(), point.y(), point.z());
  return text;
}

/// The lines that every format carries as comments.
std::vector<std::string> Explanation(const ExportedExtrinsic& extrinsic, const std::string& what) {
  const Eigen::Vector3d p_camera_m(0.5, 0.25, 5.0);
  const Eigen::Vector3d p_lidar_m = extrinsic.T_child_parent.inverse() * p_camera_m;
  std::string example = "Example: p_" + extrinsic.parent + " = " + PointText(p_lidar_m) +
                        " m is p_" + extrinsic.child + " = " + PointText(p_camera_m) + " m";
  if (extrinsic.camera) {
    const Eigen::Vector2d pixel_px = extrinsic.camera->Project<double>(p_camera_m);
    char text[64];
    std::snprintf(text, sizeof(text), ", pixel (%.3f, %.3f)", pixel_px.x(), pixel_px.y());
    example += text;
  }
  return {"parent: " + extrinsic.parent + " (" + extrinsic.parent_kind +
              "); child: " + extrinsic.child + " (" + extrinsic.child_kind + "). Metres, radians.",
          what,
          example + "."};
}

std::string Comments(const ExportedExtrinsic& extrinsic, const std::string& what) {
  std::string text;
  for (const std::string& line : Explanation(extrinsic, what)) text += "# " + line + "\n";
  return text;
}

/// "Pose of the camera in the lidar frame", as the tf tree has it.
std::string PoseLine(const ExportedExtrinsic& extrinsic) {
  return "Pose of " + extrinsic.child + " in " + extrinsic.parent +
         ": takes coordinates of the child to the parent, p_" + extrinsic.parent + " = T p_" +
         extrinsic.child + ".";
}

std::string ProjectionLine(const ExportedExtrinsic& extrinsic, const std::string& name) {
  return name + " takes coordinates of the parent to the child, p_" + extrinsic.child + " = " +
         name + " p_" + extrinsic.parent + ".";
}

std::string Ros1Command(const ExportedExtrinsic& extrinsic) {
  const Eigen::Isometry3d T_lidar_camera = extrinsic.T_child_parent.inverse();
  const Eigen::Vector3d t = T_lidar_camera.translation();
  return "rosrun tf2_ros static_transform_publisher " + Join(t, " ") + " " +
         Join(QuaternionXyzw(T_lidar_camera), " ") + " " + extrinsic.parent + " " + extrinsic.child;
}

std::string Ros2Command(const ExportedExtrinsic& extrinsic) {
  const Eigen::Isometry3d T_lidar_camera = extrinsic.T_child_parent.inverse();
  const Eigen::Vector3d t = T_lidar_camera.translation();
  const Eigen::Vector4d q = QuaternionXyzw(T_lidar_camera);
  const std::pair<const char*, double> values[] = {{"x", t[0]},
                                                   {"y", t[1]},
                                                   {"z", t[2]},
                                                   {"qx", q[0]},
                                                   {"qy", q[1]},
                                                   {"qz", q[2]},
                                                   {"qw", q[3]}};
  std::string command = "ros2 run tf2_ros static_transform_publisher";
  for (const auto& [name, value] : values) {
    command += std::string(" --") + name + " " + ExactText(value);
  }
  return command + " --frame-id " + extrinsic.parent + " --child-frame-id " + extrinsic.child;
}

std::string Ros1Text(const ExportedExtrinsic& extrinsic) {
  return Comments(extrinsic, PoseLine(extrinsic) + " Order: x y z qx qy qz qw parent child.") +
         Ros1Command(extrinsic) + "\n";
}

std::string Ros2Text(const ExportedExtrinsic& extrinsic) {
  return Comments(extrinsic, PoseLine(extrinsic)) + Ros2Command(extrinsic) + "\n";
}

std::string RosText(const ExportedExtrinsic& extrinsic) {
  return Ros2Text(extrinsic) + "# The same in ROS 1:\n# " + Ros1Command(extrinsic) + "\n";
}

std::string UrdfText(const ExportedExtrinsic& extrinsic) {
  const Eigen::Isometry3d T_lidar_camera = extrinsic.T_child_parent.inverse();
  const Eigen::Vector3d t = T_lidar_camera.translation();
  const std::string what = PoseLine(extrinsic) + " rpy turns about the parent's fixed x, y, z.";
  std::string text = "<!--\n";
  for (const std::string& line : Explanation(extrinsic, what)) text += "  " + line + "\n";
  return text + "-->\n<joint name=\"" + extrinsic.parent + "_to_" + extrinsic.child +
         "\" type=\"fixed\">\n  <parent link=\"" + extrinsic.parent + "\"/>\n  <child link=\"" +
         extrinsic.child + "\"/>\n  <origin xyz=\"" + Join(t, " ") + "\" rpy=\"" +
         Join(RollPitchYaw(T_lidar_camera.linear()), " ") + "\"/>\n</joint>\n";
}

std::string BotFramesText(const ExportedExtrinsic& extrinsic) {
  return Comments(extrinsic, PoseLine(extrinsic) + " quat is w x y z.") +
         "coordinate_frames {\n  root_frame = \"" + extrinsic.parent + "\";\n" +
         BotFrame(extrinsic) + "}\n";
}

std::string KalibrText(const ExportedExtrinsic& extrinsic) {
  return Comments(extrinsic, ProjectionLine(extrinsic, "T_cam_lidar")) + "cam0:\n  T_cam_lidar:\n" +
         ExactRows(extrinsic.T_child_parent.matrix(), "  ") +
         (extrinsic.camera ? KalibrLens(*extrinsic.camera) : "");
}

template <typename Matrix>
std::string OpencvMatrix(const std::string& name, const Matrix& matrix) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
  return name + ": !!opencv-matrix\n   rows: " + std::to_string(matrix.rows()) +
         "\n   cols: " + std::to_string(matrix.cols()) + "\n   dt: d\n   data: " + List(values) +
         "\n";
}

std::string OpencvLens(const CameraModel& camera) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K.diagonal() << camera.fx_px, camera.fy_px, 1;
  K(0, 2) = camera.cx_px;
  K(1, 2) = camera.cy_px;
  const Eigen::Map<const Eigen::RowVectorXd> distortion(camera.distortion.data(),
                                                        NumDistortion(camera.lens));
  const bool is_fisheye = camera.lens == LensModel::kEquidistant;
  return std::string("# for cv::") + (is_fisheye ? "fisheye::" : "") + "projectPoints\n" +
         OpencvMatrix("camera_matrix", K) + OpencvMatrix("distortion_coefficients", distortion) +
         "image_width: " + std::to_string(camera.width_px) +
         "\nimage_height: " + std::to_string(camera.height_px) + "\n";
}

std::string OpencvText(const ExportedExtrinsic& extrinsic) {
  const Eigen::Isometry3d& T = extrinsic.T_child_parent;
  const Eigen::Vector3d t = T.translation();
  const std::string what = ProjectionLine(extrinsic, "T_camera_lidar") +
                           " rvec and tvec say the same, for cv::projectPoints of lidar points.";
  return "%YAML:1.0\n---\n" + Comments(extrinsic, what) + "parent: \"" + extrinsic.parent +
         "\"\nchild: \"" + extrinsic.child + "\"\n" + OpencvMatrix("T_camera_lidar", T.matrix()) +
         OpencvMatrix("rvec", RotationVector(T)) + OpencvMatrix("tvec", t) +
         (extrinsic.camera ? OpencvLens(*extrinsic.camera) : "");
}

std::string AutowareText(const ExportedExtrinsic& extrinsic) {
  // REP 103: a body frame is x forward, y left, z up. Its axes in the optical frame, as columns.
  Eigen::Isometry3d T_camera_link = Eigen::Isometry3d::Identity();
  T_camera_link.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::Isometry3d T_lidar_link = extrinsic.T_child_parent.inverse() * T_camera_link;
  const Eigen::Vector3d t = T_lidar_link.translation();
  const Eigen::Vector3d rpy = RollPitchYaw(T_lidar_link.linear());
  const std::string link = extrinsic.child + "/camera_link";
  const std::string what = "Pose of " + link + " (x forward, y left, z up) in " + extrinsic.parent +
                           "; " + extrinsic.child +
                           " stands in it turned by roll -pi/2, pitch 0, yaw -pi/2 (REP 103).";
  const std::pair<const char*, double> values[] = {
      {"x", t[0]}, {"y", t[1]}, {"z", t[2]}, {"roll", rpy[0]}, {"pitch", rpy[1]}, {"yaw", rpy[2]}};
  std::string text = Comments(extrinsic, what) + extrinsic.parent + ":\n  " + link + ":\n";
  for (const auto& [name, value] : values) {
    text += std::string("    ") + name + ": " + ExactText(value) + "\n";
  }
  return text;
}

std::string MrcalText(const ExportedExtrinsic& extrinsic) {
  const CameraModel& camera = *extrinsic.camera;
  const int num_distortion = NumDistortion(camera.lens);
  std::vector<double> intrinsics{camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
  intrinsics.insert(
      intrinsics.end(), camera.distortion.begin(), camera.distortion.begin() + num_distortion);
  Vector6d rt_camera_lidar;
  rt_camera_lidar << RotationVector(extrinsic.T_child_parent),
      extrinsic.T_child_parent.translation();
  const std::string what =
      ProjectionLine(extrinsic, "rt_fromref") + " mrcal's reference frame is the parent.";
  return Comments(extrinsic, what) + "{\n    'lensmodel': 'LENSMODEL_OPENCV" +
         std::to_string(num_distortion) + "',\n    'intrinsics': " + List(intrinsics) +
         ",\n    # extrinsics are rt_fromref\n    'extrinsics': " + List(rt_camera_lidar) +
         ",\n    'imagersize': [" + std::to_string(camera.width_px) + ", " +
         std::to_string(camera.height_px) + "],\n}\n";
}

using Formatter = std::string (*)(const ExportedExtrinsic&);

const std::vector<std::pair<std::string, Formatter>>& Formatters() {
  static const std::vector<std::pair<std::string, Formatter>> kFormatters = {
      {"ros", RosText},
      {"ros1", Ros1Text},
      {"ros2", Ros2Text},
      {"urdf", UrdfText},
      {"bot_frames", BotFramesText},
      {"kalibr", KalibrText},
      {"opencv", OpencvText},
      {"autoware", AutowareText},
      {"mrcal", MrcalText}};
  return kFormatters;
}

}  // namespace

// libbot2, bot2-frames: quaternions are w x y z, and a frame's transform takes its coordinates to
// those of the frame that it is relative to.
std::string BotFrame(const ExportedExtrinsic& extrinsic) {
  const Eigen::Isometry3d T_lidar_camera = extrinsic.T_child_parent.inverse();
  const Eigen::Vector3d t = T_lidar_camera.translation();
  const Eigen::Vector4d q = QuaternionXyzw(T_lidar_camera);
  const Eigen::Vector4d q_wxyz(q[3], q[0], q[1], q[2]);
  return "  " + extrinsic.child + " {\n    relative_to = \"" + extrinsic.parent +
         "\";\n    history = 0;  # it does not move\n    initial_transform {\n      translation "
         "= " +
         List(t) + ";\n      quat = " + List(q_wxyz) + ";\n    }\n  }\n";
}

// "radtan" is k1 k2 p1 p2.
std::string KalibrLens(const CameraModel& camera) {
  const bool is_equidistant = camera.lens == LensModel::kEquidistant;
  const bool is_radtan = camera.lens == LensModel::kPlumbBob && camera.distortion[4] == 0;
  if (!is_equidistant && !is_radtan) return "";
  const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.begin() + 4);
  const std::vector<double> intrinsics{camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
  return std::string("  camera_model: pinhole\n  distortion_model: ") +
         (is_equidistant ? "equidistant" : "radtan") +
         "\n  distortion_coeffs: " + List(distortion) + "\n  intrinsics: " + List(intrinsics) +
         "\n  resolution: [" + std::to_string(camera.width_px) + ", " +
         std::to_string(camera.height_px) + "]\n";
}

std::string ExactRows(const Eigen::Matrix4d& matrix, const std::string& indent) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const Eigen::RowVector4d row = matrix.row(i);
    text += indent + "- " + List(row) + "\n";
  }
  return text;
}

std::vector<std::string> ExportedExtrinsic::Problems() const {
  std::vector<std::string> problems;
  const std::pair<const char*, const std::string&> names[] = {{"parent", parent}, {"child", child}};
  for (const auto& [what, name] : names) {
    // What neither XML, YAML, a shell nor bot_param gives a meaning of its own.
    const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '_' || c == '/';
    });
    if (name.empty() || !is_plain) {
      problems.push_back(std::string(what) + " must be letters, digits, _ and /, is '" + name +
                         "'");
    }
  }
  if (parent == child) problems.push_back("parent and child must differ, are both '" + child + "'");
  return problems;
}

const std::vector<std::string>& ExportFormats() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, formatter] : Formatters()) names.push_back(name);
    return names;
  }();
  return kNames;
}

std::string FormatProblem(const std::string& format, const ExportedExtrinsic& extrinsic) {
  if (format != "mrcal") return {};
  if (!extrinsic.camera) return "format mrcal holds the lens too: it needs the rig file (--rig)";
  if (extrinsic.camera->lens != LensModel::kEquidistant) return {};
  return "format mrcal has no lens model for an equidistant (fisheye) camera; it has plumb_bob and "
         "rational";
}

std::string ExtrinsicText(const std::string& format, const ExportedExtrinsic& extrinsic) {
  const std::string problem = FormatProblem(format, extrinsic);
  if (!problem.empty()) throw std::invalid_argument(problem);
  for (const auto& [name, formatter] : Formatters()) {
    if (name == format) return formatter(extrinsic);
  }
  std::string known;
  for (const std::string& name : ExportFormats()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("unknown format '" + format + "'; there are: " + known);
}

}  // namespace voqcal
