import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { readLog } from "../lib/lcm_log.mjs";
import { voqcalTypes } from "../lib/lcm_types.mjs";
import { writeBag, writeMcap } from "./recording_writers.mjs";

const folder = mkdtempSync(join(tmpdir(), "voqcal-import-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const program = fileURLToPath(new URL("../../import_ros", import.meta.url));
const types = voqcalTypes();

const SECOND = 1_000_000_000n;
const START = 1_600_000_000n * SECOND;
const stamp = (ns) => ({ sec: Number(ns / SECOND), nsec: Number(ns % SECOND) });

// Two points of a lidar with every sort of field, the second sweep 0.1 s later.
const cloud = (ns) => ({
  header: { seq: 7, stamp: stamp(ns), frame_id: "velodyne" },
  height: 1,
  width: 2,
  fields: [
    { name: "x", offset: 0, datatype: 7, count: 1 },
    { name: "y", offset: 4, datatype: 7, count: 1 },
    { name: "z", offset: 8, datatype: 8, count: 1 },
    { name: "ring", offset: 16, datatype: 4, count: 1 },
  ],
  is_bigendian: false,
  point_step: 18,
  row_step: 36,
  data: Uint8Array.from({ length: 36 }, (_, i) => i),
  is_dense: true,
});
const image = (ns, encoding, bytesPerPixel) => ({
  header: { seq: 0, stamp: stamp(ns), frame_id: "camera" },
  width: 2,
  height: 2,
  encoding,
  is_bigendian: 0,
  step: 2 * bytesPerPixel + 1, // rows may be padded
  data: Uint8Array.from({ length: 2 * (2 * bytesPerPixel + 1) }, (_, i) => 10 + i),
});
// The first bytes of a baseline JPEG of 640 x 480, with a segment before the frame's.
const JPEG = Buffer.from("ffd8ffe000044a46ffc0001108" + "01e0" + "0280" + "03012200021101031101ffd9", "hex");
const compressed = (ns) => ({
  header: { seq: 0, stamp: stamp(ns), frame_id: "camera" },
  format: "jpeg",
  data: JPEG,
});
const cameraInfo = (ns, isRos1) => {
  const d = [0.1, -0.2, 0.3, -0.4];
  const k = [700, 0, 640.5, 0, 701, 400.25, 0, 0, 1];
  const [r, p] = [new Array(9).fill(0), new Array(12).fill(0)];
  const roi = { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false };
  return {
    header: { seq: 0, stamp: stamp(ns), frame_id: "camera" },
    height: 800,
    width: 1280,
    distortion_model: "equidistant",
    ...(isRos1 ? { D: d, K: k, R: r, P: p } : { d, k, r, p }),
    binning_x: 0,
    binning_y: 0,
    roi,
  };
};

const recording = (isRos1, imageType, makeImage) => {
  const messages = [];
  for (const offset of [0n, SECOND / 10n]) {
    const logTimeNs = START + offset + 5_000_000n; // recorded 5 ms after it was measured
    const add = (topic, type, message) => messages.push({ topic, type, logTimeNs, message });
    add("/points", "sensor_msgs/PointCloud2", cloud(START + offset));
    add("/camera", imageType, makeImage(START + offset));
    add("/info", "sensor_msgs/CameraInfo", cameraInfo(START + offset, isRos1));
  }
  return messages;
};
const rawRecording = (isRos1, encoding = "bgr8", bytesPerPixel = 3) =>
  recording(isRos1, "sensor_msgs/Image", (ns) => image(ns, encoding, bytesPerPixel));

const WRITERS = {
  bag: async (name, makeMessages) => writeBag(path(name), makeMessages(true)),
  mcap: async (name, makeMessages) => writeMcap(path(name), makeMessages(false)),
};

const TYPE_OF = { LIDAR_POINTS: "pointcloud2_t", CAMERA_IMAGE: "image_t", CAMERA_INFO: "camera_info_t" };
const events = (log) =>
  [...readLog(log)].map(({ utime, channel, bytes }) => ({
    utime,
    channel,
    message: types.decode(TYPE_OF[channel], bytes),
  }));
const importTo = (name, ...flags) => {
  execFileSync(program, [path(name), "--force", "--out", path("out.lcm"), ...flags]);
  return events(path("out.lcm"));
};

for (const [kind, write] of Object.entries(WRITERS)) {
  test(`${kind}: clouds, images and lenses arrive as they were`, async () => {
    await write(`raw.${kind}`, (isRos1) => rawRecording(isRos1));
    const log = importTo(`raw.${kind}`, "--camera-info-topic", "/info");
    assert.deepEqual(
      log.map(({ channel }) => channel),
      ["LIDAR_POINTS", "CAMERA_IMAGE", "CAMERA_INFO", "LIDAR_POINTS", "CAMERA_IMAGE", "CAMERA_INFO"],
    );
    const [points, picture, lens, laterPoints] = log.map(({ message }) => message);
    assert.equal(log[0].utime, START / 1000n + 5000n); // when it was recorded
    assert.equal(points.utime, START / 1000n); // when it was measured
    assert.equal(laterPoints.utime, START / 1000n + 100_000n);
    assert.deepEqual([points.seq, laterPoints.seq], [0, 1]);
    const sent = cloud(START);
    assert.deepEqual(points.fields, sent.fields);
    assert.deepEqual([...points.data], [...sent.data]);
    assert.deepEqual([points.width, points.point_step, points.row_step], [2, 18, 36]);
    assert.equal(picture.pixelformat, 861030210); // BGR
    assert.deepEqual([picture.width, picture.height, picture.row_stride], [2, 2, 7]);
    assert.deepEqual([...picture.data], [...image(START, "bgr8", 3).data]);
    assert.equal(lens.lens_model, "equidistant");
    assert.deepEqual([lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px], [700, 701, 640.5, 400.25]);
    assert.deepEqual(lens.distortion, [0.1, -0.2, 0.3, -0.4, 0, 0, 0, 0]);
  });

  test(`${kind}: compressed images keep their bytes`, async () => {
    await write(`jpeg.${kind}`, (isRos1) =>
      recording(isRos1, "sensor_msgs/CompressedImage", compressed),
    );
    const picture = importTo(`jpeg.${kind}`)[1].message;
    assert.deepEqual([picture.width, picture.height, picture.row_stride], [640, 480, 0]);
    assert.equal(picture.pixelformat, 1196444237); // MJPEG
    assert.deepEqual(picture.data, JPEG);
  });

  test(`${kind}: CameraInfo as the rig file's section`, async () => {
    await write(`info.${kind}`, (isRos1) => rawRecording(isRos1));
    const text = execFileSync(program, [path(`info.${kind}`), "--print-camera"]).toString();
    assert.equal(
      text,
      "camera:\n  lens_model: equidistant\n  width_px: 1280\n  height_px: 800\n  fx_px: 700\n" +
        "  fy_px: 701\n  cx_px: 640.5\n  cy_px: 400.25\n  distortion: [0.1, -0.2, 0.3, -0.4]\n",
    );
  });
}

test("the alpha of four-channel images is left out", async () => {
  await WRITERS.mcap("rgba.mcap", () => rawRecording(false, "rgba8", 4));
  const picture = importTo("rgba.mcap")[1].message;
  assert.equal(picture.pixelformat, 859981650); // RGB
  assert.deepEqual([...picture.data], [10, 11, 12, 14, 15, 16, 19, 20, 21, 23, 24, 25]);
});

const run = (...args) => spawnSync(program, args, { encoding: "utf8" });

/** One line on stderr that has every part, status 1, and no log. */
function expectRefused(args, ...parts) {
  rmSync(path("out.lcm"), { force: true });
  const before = readdirSync(folder);
  const done = run(...args, "--out", path("out.lcm"));
  assert.equal(done.status, 1, done.stderr);
  assert.match(done.stderr, /^import_ros: [^\n]*\n$/);
  for (const part of parts) assert.ok(done.stderr.includes(part), `${part} in ${done.stderr}`);
  assert.deepEqual(readdirSync(folder), before);
}

test("topics that are not there: says what is there and what was wanted", async () => {
  for (const [kind, write] of Object.entries(WRITERS)) {
    const file = `topics.${kind}`;
    await write(file, (isRos1) => rawRecording(isRos1));
    const there = ["/points (sensor_msgs/PointCloud2, 2)", "/camera (sensor_msgs/Image, 2)"];
    expectRefused([path(file), "--lidar-topic", "/lidar"], path(file), "/lidar", "PointCloud2", ...there);
    expectRefused([path(file), "--image-topic", "/points"], "/points of type sensor_msgs/Image", ...there);
    await write(file, (isRos1) => rawRecording(isRos1).filter(({ topic }) => topic === "/info"));
    expectRefused([path(file)], "0 topics of type sensor_msgs/PointCloud2", "/info");
  }
});

test("a recording that is cut off: what is before the cut is read, or there is none", async () => {
  for (const [kind, write] of Object.entries(WRITERS)) {
    await write(`whole.${kind}`, (isRos1) => rawRecording(isRos1));
    const whole = readFileSync(path(`whole.${kind}`));
    for (const share of [0.01, 0.9]) {
      writeFileSync(path("cut"), whole.subarray(0, Math.floor(share * whole.length)));
      const done = run(path("cut"), "--force", "--out", path("out.lcm"));
      if (done.status === 0) assert.match(done.stdout, /LIDAR_POINTS: [12] messages[^]*CAMERA_IMAGE: [12] messages/);
      else assert.match(done.stderr, /^import_ros: [^\n]*cut[^\n]*(is cut off|damaged|has no topics|no message)[^\n]*\n$/);
    }
  }
});

test("files of another kind", () => {
  expectRefused([path("missing")], path("missing"), "no such file");
  mkdirSync(path("empty"));
  expectRefused([path("empty")], path("empty"), "a folder without .bag, .mcap, .db3 or .lcm files");
  writeFileSync(path("text"), "no recording");
  expectRefused([path("text")], "neither a ROS 1 bag nor a ROS 2 recording");
  writeFileSync(path("nothing.mcap"), "");
  expectRefused([path("nothing.mcap")], "is empty");
  writeFileSync(path("old.db3"), "SQLite format 3\0...");
  expectRefused([path("old.db3")], "cannot be read as a ROS 2 sqlite3 recording");
  writeFileSync(path("bag.gz"), Buffer.from("1f8b0800", "hex"));
  expectRefused([path("bag.gz")], "is compressed", "gunzip");
});

test("a log that is there already is overwritten only if asked; folders are made", async () => {
  await WRITERS.mcap("again.mcap", () => rawRecording(false));
  writeFileSync(path("precious.lcm"), "precious");
  const refused = run(path("again.mcap"), "--out", path("precious.lcm"));
  assert.equal(refused.status, 1);
  assert.match(refused.stderr, /precious.lcm: is there already \(--force overwrites it\)\n$/);
  assert.equal(readFileSync(path("precious.lcm"), "utf8"), "precious");
  assert.equal(run(path("again.mcap"), "--out", path("precious.lcm"), "--force").status, 0);
  assert.equal(run(path("again.mcap"), "--out", path("new/folder/out.lcm")).status, 0);
  assert.deepEqual(readFileSync(path("new/folder/out.lcm")), readFileSync(path("precious.lcm")));
});

test("images that cannot be taken", async () => {
  await WRITERS.mcap("depth.mcap", () => rawRecording(false, "32FC1", 4));
  expectRefused([path("depth.mcap")], "2 of 2 left out", "32FC1", "mono8", "bgr8");
  await WRITERS.mcap("short.mcap", () =>
    recording(false, "sensor_msgs/Image", (ns) => ({ ...image(ns, "mono8", 1), height: 9 })),
  );
  expectRefused([path("short.mcap")], "2 x 9 mono8", "6 bytes");
});

test("flags that cannot be understood: status 2 and one line", () => {
  for (const args of [[], ["a", "--no-such-flag"]]) {
    const done = run(...args);
    assert.equal(done.status, 2);
    assert.match(done.stderr, /^import_ros: [^\n]*\n$/);
  }
});
