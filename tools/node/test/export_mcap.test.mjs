import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { LogWriter } from "../lib/lcm_log.mjs";
import { voqcalTypes } from "../lib/lcm_types.mjs";
import { programPath } from "../lib/program_path.mjs";

const require = createRequire(import.meta.url);
const protobuf = require("protobufjs");
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");

const folder = mkdtempSync(join(tmpdir(), "voqcal-export-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const program = fileURLToPath(new URL("../../export_mcap", import.meta.url));
const types = voqcalTypes();

const UTIME = 1_577_836_800_500_000n;
const CORNERS = [[3, 0.3, -0.4], [3, -0.3, -0.4], [3.1, -0.3, 0.4], [3.1, 0.3, 0.4]];
const RESULT = {
  result: { T_lidar_camera: { quaternion_xyzw: [-0.5, 0.5, -0.5, 0.5], translation_m: [0.1, 0.2, 0.3] } },
  rig: {
    camera: {
      lens_model: "equidistant", width_px: 64, height_px: 48, fx_px: 50, fy_px: 51, cx_px: 32, cy_px: 24,
      distortion: [0.1, 0.2, 0.3, 0.4],
    },
  },
};

/** A value of an LCM type with every number 0, every text and list empty. */
function zero(pose) {
  return {
    pose: { centre_m: [0, 0, 0], normal: [0, 0, 0], corners_m: CORNERS, covariance: Array(6).fill(Array(6).fill(0)) },
    ...pose,
  };
}
const sample = {
  id: 1,
  utime: UTIME,
  num_frames: 1,
  lidar: zero({
    sides: [0, 0, 0, 0], edge_lengths_m: [0, 0, 0, 0], plane_rms_m: 0, num_beams: 0, log_likelihood: 0,
    num_points: 0, points: [], num_rings: 0, rings: [],
  }),
  camera: zero({
    utime: UTIME, seq: 0, frame: "camera", miss: "", detail: "", num_warnings: 0, warnings: [],
    reprojection_rms_px: 0, num_corners: 0, corners_px: [],
  }),
  num_runners_up: 0,
  runners_up: [],
};
const sweep = {
  utime: UTIME, seq: 0, frame_id: "lidar", height: 1, width: 1, nfields: 4,
  fields: [["x", 0, 7], ["y", 4, 7], ["z", 8, 7], ["ring", 12, 4]].map(([name, offset, datatype]) => ({
    name, offset, datatype, count: 1,
  })),
  is_bigendian: 0, point_step: 14, row_step: 14, data_nbytes: 14, data: Buffer.from("abcdefghijklmn"), is_dense: 1,
};
const picture = (pixelformat, data, row_stride) => ({
  utime: UTIME + 5n, width: 2, height: 1, row_stride, pixelformat, size: data.length, data, nmetadata: 0, metadata: [],
});

function writeSession(name, image) {
  mkdirSync(path(name), { recursive: true });
  writeFileSync(path(`${name}/result.json`), JSON.stringify(RESULT));
  const log = new LogWriter(path(`${name}/samples.lcm`));
  log.write(UTIME, "CALIB_SWEEP", types.encode("pointcloud2_t", sweep));
  log.write(UTIME, "CALIB_IMAGE", types.encode("image_t", image));
  log.write(UTIME, "CALIB_SAMPLE", types.encode("sample_t", sample));
  log.finish();
}

/** Topic -> the last {type, message, logTime} of it. */
const readBack = async (file) => Object.fromEntries((await messagesOf(file)).map((each) => [each.topic, each]));

/** {topic, type, message, logTime}, decoded by nothing but the schemas in the file. */
async function messagesOf(file) {
  const handle = await open(file);
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle) });
  const found = [];
  for await (const { channelId, logTime, data } of reader.readMessages()) {
    const channel = reader.channelsById.get(channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(schema.encoding, "protobuf");
    const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data));
    const type = root.lookupType(schema.name);
    found.push({ topic: channel.topic, type: schema.name, message: type.toObject(type.decode(data)), logTime });
  }
  await handle.close();
  return found;
}

test("every message of a session reads back by the schemas in the file", async () => {
  const jpeg = Buffer.from("a jpeg");
  writeSession("session", picture(1196444237, jpeg, 0));
  execFileSync(program, [path("session"), "--out", path("out.mcap")]);
  const found = await readBack(path("out.mcap"));

  const tf = found["/tf"];
  assert.equal(tf.type, "foxglove.FrameTransform");
  assert.deepEqual([tf.message.parent_frame_id, tf.message.child_frame_id], ["lidar", "camera"]);
  assert.deepEqual(tf.message.translation, { x: 0.1, y: 0.2, z: 0.3 });
  assert.deepEqual(tf.message.rotation, { x: -0.5, y: 0.5, z: -0.5, w: 0.5 });
  assert.equal(tf.logTime, UTIME * 1000n);
  assert.equal(Number(tf.message.timestamp.seconds), 1577836800);
  assert.equal(tf.message.timestamp.nanos, 500_000_000);

  const points = found["/lidar/points"].message;
  assert.equal(points.frame_id, "lidar");
  assert.equal(points.point_stride, 14);
  assert.deepEqual(points.fields.map(({ name, offset, type }) => [name, offset ?? 0, type]), [
    ["x", 0, 7], ["y", 4, 7], ["z", 8, 7], ["ring", 12, 3], // FLOAT32 and UINT16 of NumericType
  ]);
  assert.equal(Buffer.from(points.data).toString(), "abcdefghijklmn");

  const image = found["/camera/image"];
  assert.equal(image.type, "foxglove.CompressedImage");
  assert.equal(image.message.format, "jpeg");
  assert.deepEqual(Buffer.from(image.message.data), jpeg);

  const lens = found["/camera/calibration"].message;
  assert.equal(lens.distortion_model, "kannala_brandt");
  assert.deepEqual(lens.K, [50, 0, 32, 0, 51, 24, 0, 0, 1]);
  assert.deepEqual(lens.D, [0.1, 0.2, 0.3, 0.4]);

  for (const frame of ["lidar", "camera"]) {
    const [entity] = found[`/${frame}/board`].message.entities;
    assert.equal(entity.frame_id, frame);
    const corners = entity.lines[0].points.map(({ x = 0, y = 0, z = 0 }) => [x, y, z]);
    assert.deepEqual(corners, CORNERS);
    assert.equal(entity.lines[0].type, 1); // LINE_LOOP
  }
});

test("raw images keep their rows", async () => {
  writeSession("raw", picture(861030210, Buffer.from("BGRbgr.."), 8));
  execFileSync(program, [path("raw"), "--out", path("raw.mcap")]);
  const { type, message } = (await readBack(path("raw.mcap")))["/camera/image"];
  assert.equal(type, "foxglove.RawImage");
  assert.deepEqual([message.encoding, message.width, message.height, message.step], ["bgr8", 2, 1, 8]);
});

/** rig_extrinsics.yaml of two lidars and two cameras, as far as it is read. */
function writeRigResult(name) {
  const pose = (x) => `{quaternion_xyzw: [0, 0, 0.6, 0.8], translation_m: [${x}, 0, 0]}`;
  const sensors = { top: "lidar", side: "lidar", left: "camera", right: "camera" };
  const lines = Object.entries(sensors).map(([sensor, kind], i) => `  ${sensor}: {kind: ${kind}, T_reference_sensor: ${pose(i)}}\n`);
  lines[0] = "  top: {kind: lidar, T_reference_sensor: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}}\n";
  mkdirSync(path(name), { recursive: true });
  const text = `rig: truck\nreference: top\nverdict: {grade: good}\nsensors:\n${lines.join("")}`;
  writeFileSync(path(`${name}/rig_extrinsics.yaml`), text);
}
const ofPrograms = { skip: !programPath("export_extrinsic") && "the programs are not built" };

test("a rig: every sensor's pose, each camera's lens, and what its pairs saw, once", ofPrograms, async () => {
  writeRigResult("rig");
  for (const pair of ["top_left", "side_left"]) writeSession(`rig/${pair}`, picture(1196444237, Buffer.from("a jpeg"), 0));
  const out = execFileSync(program, [path("rig"), "--out", path("rig.mcap")], { encoding: "utf8" });
  assert.match(out, /^right: its lens is in no pair's folder, so not written \(--rig RIG gives it\)\n2 samples\n/);
  const messages = await messagesOf(path("rig.mcap"));
  const poses = messages.filter(({ topic }) => topic === "/tf").map(({ message }) => message);
  assert.deepEqual(poses.map((pose) => pose.child_frame_id), ["side", "left", "right"]);
  for (const [i, pose] of poses.entries()) {
    assert.equal(pose.parent_frame_id, "top");
    assert.equal(pose.translation.x, i + 1);
    assert.deepEqual([pose.rotation.z, pose.rotation.w], [0.6, 0.8]);
  }
  const topics = messages.map(({ topic }) => topic).filter((topic) => topic !== "/tf");
  const wanted = ["/left/board", "/left/calibration", "/left/image", "/side/board", "/side/points", "/top/board", "/top/points"];
  assert.deepEqual(topics.sort(), wanted);
  const of = (wantedTopic) => messages.find(({ topic }) => topic === wantedTopic).message;
  assert.equal(of("/left/image").frame_id, "left");
  assert.equal(of("/side/points").frame_id, "side");
  assert.equal(of("/top/board").entities[0].frame_id, "top");
  assert.deepEqual([of("/left/calibration").frame_id, of("/left/calibration").K[0]], ["left", 50]);
});

test("a rig's result alone: poses, and the lenses of its rig file", ofPrograms, async () => {
  writeRigResult("moved");
  const lens = "lens_model: plumb_bob, width_px: 640, height_px: 480, cx_px: 320, cy_px: 240, distortion: [0.1, 0, 0, 0, 0]";
  const camera = (fx) => `{camera: {${lens}, fx_px: ${fx}, fy_px: ${fx}}}`;
  const board = "{width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 5, num_corners_y: 7}";
  writeFileSync(path("truck.yaml"), `rig: truck\nboard: ${board}\nlidars: {top: {}, side: {}}\ncameras: {left: ${camera(400)}, right: ${camera(500)}}\n`);
  execFileSync(program, [path("moved"), "--rig", path("truck.yaml"), "--out", path("moved.mcap")]);
  const messages = await messagesOf(path("moved.mcap"));
  assert.deepEqual(messages.map(({ topic }) => topic), ["/tf", "/tf", "/tf", "/left/calibration", "/right/calibration"]);
  assert.equal(messages[4].message.distortion_model, "plumb_bob");
  assert.deepEqual(messages[4].message.K, [500, 0, 320, 0, 500, 240, 0, 0, 1]);
  assert.deepEqual(messages[4].message.D, [0.1, 0, 0, 0, 0]);
  writeFileSync(path("moved/rig_extrinsics.yaml"), "rig: truck\n");
  expectRefused([path("moved"), "--out", path("no.mcap")], path("moved/rig_extrinsics.yaml"));
});

test("the same session gives the same bytes", () => {
  writeSession("same", picture(1196444237, Buffer.from("a jpeg"), 0));
  for (const out of ["a.mcap", "b.mcap"]) execFileSync(program, [path("same"), "--out", path(out)]);
  execFileSync("cmp", [path("a.mcap"), path("b.mcap")]);
});

function expectRefused(args, ...parts) {
  const before = readdirSync(folder);
  const done = spawnSync(program, args, { encoding: "utf8" });
  assert.equal(done.status, 1, done.stderr);
  assert.match(done.stderr, /^export_mcap: [^\n]*\n$/);
  for (const part of parts) assert.ok(done.stderr.includes(part), `${part} in ${done.stderr}`);
  assert.deepEqual(readdirSync(folder), before);
}

test("a file that is there already is overwritten only if asked", () => {
  writeSession("twice", picture(1196444237, Buffer.from("a jpeg"), 0));
  const args = [path("twice"), "--out", path("twice.mcap")];
  execFileSync(program, args);
  expectRefused(args, "twice.mcap: is there already (--force overwrites it)");
  execFileSync(program, [...args, "--force"]);
});

test("folders that are no results", () => {
  expectRefused([folder, "--out", path("x.mcap")], "result.json", "calibrate");
  mkdirSync(path("other"));
  writeFileSync(path("other/result.json"), JSON.stringify(RESULT));
  expectRefused([path("other"), "--out", path("x.mcap")], "samples.lcm", "no such file");
  const log = new LogWriter(path("other/samples.lcm"));
  log.write(0n, "LIDAR_POINTS", Buffer.from("x"));
  log.finish();
  expectRefused([path("other"), "--out", path("x.mcap")], "CALIB_SAMPLE", "LIDAR_POINTS");
});
