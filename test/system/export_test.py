#!/usr/bin/python3
"""Every export, read back by a parser that shares nothing with the program that wrote it: the transform
is the same to 1e-9, a point carried by the format's own convention lands on the same pixel, and the
example in the comments is true.

usage: export_test.py BIN_FOLDER   (the folder with export_extrinsic)
"""

import ast
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np
import yaml

BIN = None

# Not near any special orientation, and one of each that is: pitch at +-90 degrees (where roll and yaw
# are not unique), none, and a half turn (where the rotation vector is not unique).
EXTRINSICS = {
    "typical": ([0.510103, -0.471535, 0.501948, 0.515264], [0.06, -0.10, -0.04]),
    "aligned": ([0.5, -0.5, 0.5, 0.5], [0.1, 0.2, 0.3]),
    "identity": ([0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0]),
    "half turn": ([0.6, 0.0, 0.8, 0.0], [-1.0, 2.0, 1e-7]),
    "pitch up": ([0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)], [1.0, 0.0, 0.0]),
    "pitch down": ([0.0, -np.sqrt(0.5), 0.0, np.sqrt(0.5)], [0.0, 1.0, 0.0]),
}
POINTS_CAMERA_M = np.array([[0.5, 0.25, 5.0], [-0.7, -0.4, 2.0], [1.5, 0.9, 8.0]])
FORMATS = ["ros", "ros1", "ros2", "urdf", "bot_frames", "kalibr", "opencv", "autoware", "mrcal"]

CAMERA = dict(width_px=1280, height_px=800, fx_px=750.0, fy_px=751.0, cx_px=641.5, cy_px=398.0)
DISTORTION = [-0.05, 0.01, 0.001, -0.002, 0.003]
RIG = (
    "rig: export\n"
    "board: {width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 4, num_corners_y: 6}\n"
    "camera: {lens_model: plumb_bob, %s, distortion: %s}\n"
    % (", ".join(f"{key}: {value}" for key, value in CAMERA.items()), DISTORTION)
)


def rotation_of_quaternion(x, y, z, w):
    """Rodrigues' formula on the quaternion's vector part: v' = v + 2 w (u x v) + 2 u x (u x v)."""
    norm = np.sqrt(x * x + y * y + z * z + w * w)
    u, w = np.array([x, y, z]) / norm, w / norm
    return np.column_stack(
        [v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v)) for v in np.eye(3)]
    )


def rotation_of_vector(r):
    angle = np.linalg.norm(r)
    if angle == 0:
        return np.eye(3)
    return rotation_of_quaternion(*(np.sin(angle / 2) * np.array(r) / angle), np.cos(angle / 2))


def rotation_of_rpy(roll, pitch, yaw):
    x, y, z = np.eye(3)
    return rotation_of_vector(yaw * z) @ rotation_of_vector(pitch * y) @ rotation_of_vector(roll * x)


def transform(rotation, translation):
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = translation
    return matrix


def apply(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def project(points_camera_m):
    """The pinhole model with k1 k2 p1 p2 k3 as OpenCV documents it."""
    k1, k2, p1, p2, k3 = DISTORTION
    x, y = points_camera_m[:, 0] / points_camera_m[:, 2], points_camera_m[:, 1] / points_camera_m[:, 2]
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.column_stack(
        [CAMERA["fx_px"] * u + CAMERA["cx_px"], CAMERA["fy_px"] * v + CAMERA["cy_px"]]
    )


# ---- Each format's own reader: text -> (T_camera_lidar, parent, child) ------------------------------


def commands(text):
    return [shlex.split(line) for line in text.splitlines() if not line.startswith("#")]


def read_ros1(text):
    (command,) = commands(text)
    assert command[:3] == ["rosrun", "tf2_ros", "static_transform_publisher"], command
    numbers = [float(number) for number in command[3:10]]
    parent, child = command[10:]
    T_parent_child = transform(rotation_of_quaternion(*numbers[3:]), numbers[:3])
    return np.linalg.inv(T_parent_child), parent, child


def read_ros2(text):
    (command,) = commands(text)
    assert command[:4] == ["ros2", "run", "tf2_ros", "static_transform_publisher"], command
    flags = dict(zip(command[4::2], command[5::2]))
    numbers = [float(flags["--" + name]) for name in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    T_parent_child = transform(rotation_of_quaternion(*numbers[3:]), numbers[:3])
    return np.linalg.inv(T_parent_child), flags["--frame-id"], flags["--child-frame-id"]


def read_ros(text):
    by_ros2 = read_ros2(text)
    ros1 = next(line[2:] for line in text.splitlines() if line.startswith("# rosrun"))
    by_ros1 = read_ros1(ros1)
    assert np.array_equal(by_ros1[0], by_ros2[0]) and by_ros1[1:] == by_ros2[1:]
    return by_ros2


def read_urdf(text):
    joint = xml.etree.ElementTree.fromstring(text)
    assert joint.tag == "joint" and joint.get("type") == "fixed"
    origin = joint.find("origin")
    xyz = [float(number) for number in origin.get("xyz").split()]
    rpy = [float(number) for number in origin.get("rpy").split()]
    T_parent_child = transform(rotation_of_rpy(*rpy), xyz)
    return (
        np.linalg.inv(T_parent_child),
        joint.find("parent").get("link"),
        joint.find("child").get("link"),
    )


def bot_frames_in(text):
    """Root, and T_root_child of each child. The bot_param grammar that is used: NAME { ... }, NAME = VALUE;, comments from # on."""
    text = re.sub(r"#.*", "", text)
    tokens = re.findall(r"\[[^\]]*\]|\"[^\"]*\"|[^\s{};=]+|[{};=]", text)

    def block(position):
        content = {}
        while position < len(tokens) and tokens[position] != "}":
            name = tokens[position]
            if tokens[position + 1] == "{":
                content[name], position = block(position + 2)
            else:
                assert tokens[position + 1] == "=" and tokens[position + 3] == ";"
                content[name] = ast.literal_eval(tokens[position + 2])
                position += 4
        return content, position + 1

    frames = block(0)[0]["coordinate_frames"]
    root = frames.pop("root_frame")
    transforms = {}
    for child, frame in frames.items():
        assert frame["relative_to"] == root
        w, x, y, z = frame["initial_transform"]["quat"]
        transforms[child] = transform(
            rotation_of_quaternion(x, y, z, w), frame["initial_transform"]["translation"]
        )
    return root, transforms


def read_bot_frames(text):
    root, transforms = bot_frames_in(text)
    ((child, T_root_child),) = transforms.items()
    return np.linalg.inv(T_root_child), root, child


def names_in_comment(text):
    return re.search(r"parent: (\S+) \(.*child: (\S+) \(", text).groups()


def read_kalibr(text):
    camera = yaml.safe_load(text)["cam0"]
    return (np.array(camera["T_cam_lidar"]), *names_in_comment(text))


class OpencvLoader(yaml.SafeLoader):
    pass


OpencvLoader.add_constructor(
    "tag:yaml.org,2002:opencv-matrix",
    lambda loader, node: (lambda m: np.reshape(m["data"], (m["rows"], m["cols"])))(
        loader.construct_mapping(node, deep=True)
    ),
)


def read_opencv(text):
    first, rest = text.split("\n", 1)
    assert first == "%YAML:1.0"
    content = yaml.load(rest, OpencvLoader)
    by_vectors = transform(rotation_of_vector(content["rvec"].ravel()), content["tvec"].ravel())
    assert np.allclose(by_vectors, content["T_camera_lidar"], rtol=0, atol=1e-9)
    assert np.array_equal(content["distortion_coefficients"].ravel(), DISTORTION)
    return by_vectors, content["parent"], content["child"]


def read_autoware(text):
    ((parent, children),) = yaml.safe_load(text).items()
    ((link, pose),) = children.items()
    assert link.endswith("/camera_link")
    T_parent_link = transform(
        rotation_of_rpy(pose["roll"], pose["pitch"], pose["yaw"]), [pose[axis] for axis in "xyz"]
    )
    # REP 103, as the camera's URDF has it: the optical frame in camera_link.
    T_link_optical = transform(rotation_of_rpy(-np.pi / 2, 0, -np.pi / 2), [0, 0, 0])
    return np.linalg.inv(T_parent_link @ T_link_optical), parent, link[: -len("/camera_link")]


def read_mrcal(text):
    model = ast.literal_eval(text)  # as mrcal itself reads it
    assert model["lensmodel"] == "LENSMODEL_OPENCV5" and model["imagersize"] == [1280, 800]
    assert model["intrinsics"] == [CAMERA[key] for key in ("fx_px", "fy_px", "cx_px", "cy_px")] + DISTORTION
    extrinsics = model["extrinsics"]
    return (transform(rotation_of_vector(extrinsics[:3]), extrinsics[3:]), *names_in_comment(text))


class ExportExtrinsic(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "rig.yaml").write_text(RIG)

    def result(self, quaternion_xyzw, translation_m):
        path = self.folder / "extrinsic.yaml"
        path.write_text(
            "T_camera_lidar: {quaternion_xyzw: %s, translation_m: %s}\n"
            % ([float(q) for q in quaternion_xyzw], translation_m)
        )
        return path

    def for_each_export(self, check, *args):
        """check(T_camera_lidar, format, text) of each extrinsic in each format."""
        for name, (q, t) in EXTRINSICS.items():
            for form in FORMATS:
                with self.subTest(extrinsic=name, format=form):
                    text = self.export(self.result(q, t), "--format", form, *args)
                    check(transform(rotation_of_quaternion(*q), t), form, text)

    def run_export(self, *args):
        return subprocess.run(
            [f"{BIN}/export_extrinsic", *map(str, args)], capture_output=True, text=True, check=False
        )

    def output_of_export(self, *args):
        done = self.run_export(*args)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def export(self, *args):
        return self.output_of_export(*args, "--rig", self.folder / "rig.yaml")

    def test_each_format_reads_back(self):
        def check(wanted, form, text):
            T_camera_lidar, parent, child = globals()["read_" + form](text)
            self.assertEqual((parent, child), ("velodyne", "front"))
            np.testing.assert_allclose(T_camera_lidar, wanted, rtol=0, atol=1e-9)

        self.for_each_export(check, "--parent", "velodyne", "--child", "front")

    def test_each_format_lands_on_the_same_pixel(self):
        def check(wanted, form, text):
            T_camera_lidar = globals()["read_" + form](text)[0]
            points_lidar_m = apply(np.linalg.inv(wanted), POINTS_CAMERA_M)
            pixels = project(apply(T_camera_lidar, points_lidar_m))
            # 1e-9 m at 2 m and 750 px focal length is 4e-7 px.
            np.testing.assert_allclose(pixels, project(POINTS_CAMERA_M), rtol=0, atol=1e-6)

        self.for_each_export(check)

    def test_the_example_in_the_comments_is_true(self):
        def check(T_camera_lidar, _, text):
            example = re.search(
                r"Example: p_lidar = \((.*?)\) m is p_camera = \((.*?)\) m, pixel \((.*?)\)", text
            )
            p_lidar, p_camera, pixel = (
                np.array([[float(x) for x in group.split(",")]]) for group in example.groups()
            )
            # Printed to 1e-6 m and 1e-3 px.
            np.testing.assert_allclose(apply(T_camera_lidar, p_lidar), p_camera, atol=2e-6, rtol=0)
            np.testing.assert_allclose(project(p_camera), pixel, atol=1e-3, rtol=0)

        self.for_each_export(check)

    def test_out_writes_the_same_text(self):
        result = self.result(*EXTRINSICS["typical"])
        out = self.folder / "joint.urdf"
        self.export(result, "--format", "urdf", "--out", out)
        self.assertEqual(out.read_text(), self.export(result, "--format", "urdf"))

    def assert_refused(self, args, *parts):
        done = self.run_export(*args)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_refuses_in_one_line(self):
        result = self.result(*EXTRINSICS["typical"])
        self.assert_refused([result, "--format", "sdf"], "'sdf'", *FORMATS)
        self.assert_refused([self.folder / "none", "--format", "ros"], "none")
        self.assert_refused([result, "--format", "mrcal"], "mrcal", "--rig")
        self.assert_refused([result, "--format", "ros", "--child", "a b"], "child", "'a b'")
        self.assert_refused([result, "--format", "ros", "--child", "lidar"], "must differ")
        rig = self.folder / "fisheye.yaml"
        rig.write_text(
            RIG.replace("plumb_bob", "equidistant").replace(str(DISTORTION), str(DISTORTION[:4]))
        )
        self.assert_refused([result, "--format", "mrcal", "--rig", rig], "mrcal", "equidistant")

    def rig_result(self):
        """rig_extrinsics.yaml of two lidars and two cameras, and T_top_NAME of each but the top."""
        sensors = {
            "top": ("lidar", *EXTRINSICS["identity"]),
            "side": ("lidar", *EXTRINSICS["half turn"]),
            "left": ("camera", *EXTRINSICS["typical"]),
            "right": ("camera", *EXTRINSICS["aligned"]),
        }
        text = "rig: a<b\nreference: top\nverdict: {grade: good}\nsensors:\n"
        for name, (kind, q, t) in sensors.items():
            q = [float(number) for number in q]
            text += f"  {name}: {{kind: {kind}, T_reference_sensor: {{quaternion_xyzw: {q}, translation_m: {t}}}}}\n"
        (self.folder / "rig_extrinsics.yaml").write_text(text)
        return {
            name: transform(rotation_of_quaternion(*q), t)
            for name, (_, q, t) in sensors.items()
            if name != "top"
        }

    def test_a_whole_rig_reads_back(self):
        wanted = self.rig_result()

        def assert_same(found):
            self.assertEqual(set(found), set(wanted))
            for name, T_top_child in found.items():
                np.testing.assert_allclose(T_top_child, wanted[name], rtol=0, atol=1e-9)

        def export(form):
            return self.output_of_export(self.folder, "--format", form)

        def tree_of(parts, read):
            tree = {}
            for part in parts:
                T_child_top, parent, child = read(part)
                self.assertEqual(parent, "top")
                tree[child] = np.linalg.inv(T_child_top)
            return tree

        for form in ("ros", "ros1", "ros2"):
            lines = [line for line in export(form).splitlines() if not line.startswith("#")]
            assert_same(tree_of(lines, read_ros1 if form == "ros1" else read_ros2))
        robot = xml.etree.ElementTree.fromstring(export("urdf"))
        self.assertEqual((robot.tag, robot.get("name")), ("robot", "a_b"))
        self.assertEqual({link.get("name") for link in robot.findall("link")}, {"top", *wanted})
        joints = [xml.etree.ElementTree.tostring(joint) for joint in robot.findall("joint")]
        assert_same(tree_of(joints, read_urdf))
        self.assertIn("parent: top (a lidar); child: side (a lidar)", export("urdf"))
        root, transforms = bot_frames_in(export("bot_frames"))
        self.assertEqual(root, "top")
        assert_same(transforms)
        chain = yaml.safe_load(export("kalibr"))
        T_left_top, T_right_top = (np.linalg.inv(wanted[name]) for name in ("left", "right"))
        np.testing.assert_allclose(chain["cam0"]["T_cam_lidar"], T_left_top, rtol=0, atol=1e-9)
        np.testing.assert_allclose(chain["cam1"]["T_cam_lidar"], T_right_top, rtol=0, atol=1e-9)
        np.testing.assert_allclose(
            chain["cam1"]["T_cn_cnm1"], T_right_top @ np.linalg.inv(T_left_top), rtol=0, atol=1e-9
        )
        self.assertNotIn("T_cn_cnm1", chain["cam0"])
        whole = json.loads(export("json"))
        self.assertEqual((whole["rig"], whole["reference"]), ("a<b", "top"))
        self.assertEqual([each["kind"] for each in whole["sensors"].values()], ["lidar"] * 2 + ["camera"] * 2)
        poses = {name: each["T_reference_sensor"] for name, each in whole["sensors"].items() if name != "top"}
        assert_same(
            {
                name: transform(rotation_of_quaternion(*pose["quaternion_xyzw"]), pose["translation_m"])
                for name, pose in poses.items()
            }
        )

    def test_a_whole_rig_is_refused_in_one_line_where_a_format_holds_one_camera(self):
        self.rig_result()
        self.assert_refused([self.folder, "--format", "opencv"], "'opencv'", "urdf")
        self.assert_refused([self.folder, "--format", "ros", "--child", "x"], "--child", "rig")


if __name__ == "__main__":
    BIN = sys.argv.pop(1)
    unittest.main()
