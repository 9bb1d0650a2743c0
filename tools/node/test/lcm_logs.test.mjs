// LCM logs whose sensors' messages are packets, or of types that voqcal does not have.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { appendFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { LogWriter, readLog } from "../lib/lcm_log.mjs";
import { LcmTypes, voqcalTypes } from "../lib/lcm_types.mjs";

const folder = mkdtempSync(join(tmpdir(), "voqcal-lcm-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const importRos = fileURLToPath(new URL("../../import_ros", import.meta.url));
const ours = voqcalTypes();

// Another team's types: packages, constants, several structs in a file, comments.
mkdirSync(path("types"));
writeFileSync(
  path("types/scan.lcm"),
  `package robot;
struct echo_t { double x, y, z; float reflectivity; int16_t line; int64_t t; /* ns; after the stamp */ }
struct scan_t {
  int64_t timestamp;  // us
  int32_t num;
  robot.echo_t points[num];
  const int32_t MODEL_A = 1, MODEL_B = 2;
}`,
);
writeFileSync(
  path("types/frames.lcm"),
  `package robot;
struct frame_t { int32_t width; int32_t height; int32_t row_stride; int32_t pixelformat; int32_t size; byte data[size]; }
struct frames_t { int64_t utime; int32_t num; frame_t images[num]; }
struct range_image_t {
  /* The sweep as a picture: see http://example.org/range_images */
  int64_t utime; int32_t width; int32_t height; int32_t num; echo_t points[num]; }
struct columns_t { int64_t utime; int32_t num; float x[num]; float y[num]; float z[num]; int32_t other[3]; }
struct cloud_t {
  int64_t utime; int32_t n_points; float points[n_points][3];
  int32_t n_channels; string channel_names[n_channels]; float channels[n_channels][n_points];
}`,
);
const theirs = new LcmTypes(pathToFileURL(path("types/")));

const START_US = 1_600_000_000_000_000n;
const GREY = 1497715271;
const BAYER_RGGB = Buffer.from("XXX4").readInt32LE(0);

/** @param events  [channel, utime after the start, types, type, message] */
function writeLog(name, events) {
  const log = new LogWriter(path(name));
  for (const [channel, us, types, type, message] of events) {
    log.write(START_US + BigInt(us) + 1000n, channel, types.encode(type, message));
  }
  log.finish();
}

function importTo(name, ...flags) {
  const said = execFileSync(importRos, [path(name), "--force", "--out", path("out.lcm"), ...flags], { encoding: "utf8" });
  const typeOf = { LIDAR_POINTS: "pointcloud2_t", CAMERA_IMAGE: "image_t" };
  const events = [...readLog(path("out.lcm"))].map(({ channel, bytes }) => ({ channel, message: ours.decode(typeOf[channel], bytes) }));
  return { said, clouds: messagesOf(events, "LIDAR_POINTS"), images: messagesOf(events, "CAMERA_IMAGE") };
}
const messagesOf = (events, wanted) => events.filter(({ channel }) => channel === wanted).map(({ message }) => message);
const refusal = (...args) => spawnSync(importRos, [...args, "--force", "--out", path("out.lcm")], { encoding: "utf8" }).stderr;

/** The points of a cloud of 64-bit fields, by name. */
function pointsOf({ fields, width, point_step: step, data }) {
  return Array.from({ length: width }, (_, i) =>
    Object.fromEntries(fields.map(({ name, offset, datatype }) => [name, datatype === 7 ? data.readFloatLE(i * step + offset) : data.readDoubleLE(i * step + offset)])),
  );
}

const grey = (us) => ({ utime: START_US + BigInt(us), width: 2, height: 2, row_stride: 3, pixelformat: GREY, size: 6, data: Buffer.from([1, 2, 0, 3, 4, 0]), nmetadata: 0, metadata: [] });
const echo = (i) => ({ x: 1 + i, y: 2, z: 3, reflectivity: 7 * i, line: i, t: 50_000_000 * i });
const scan = (us) => ({ timestamp: START_US + BigInt(us), num: 3, points: [0, 1, 2].map(echo) });
const scanEvents = [0, 100_000].flatMap((us) => [
  ["SCAN", us, theirs, "scan_t", scan(us)],
  ["EYE", us, ours, "image_t", grey(us)],
]);

test("clouds as lists of points, by the folder of their types", () => {
  writeLog("scans.lcm", scanEvents);
  const { said, clouds, images } = importTo("scans.lcm", "--lcm-types", path("types"));
  assert.match(said, /the points' t: nanoseconds after the stamp/);
  assert.equal(clouds.length, 2);
  assert.equal(clouds[1].utime, START_US + 100_000n);
  const [, second] = pointsOf(clouds[1]);
  assert.deepEqual({ ...second, time: second.time.toFixed(6) }, { x: 2, y: 2, z: 3, intensity: 7, ring: 1, time: "0.050000" });
  assert.deepEqual(images[0].data, Buffer.from([1, 2, 0, 3, 4, 0]));
  assert.equal(images[0].row_stride, 3);
});

test("clouds as columns and as bot_core's pointcloud_t; images within a message, of other pixels", () => {
  const frame = { width: 4, height: 4, row_stride: 0, pixelformat: BAYER_RGGB, size: 16, data: Buffer.alloc(16, 80) };
  const frames = { utime: START_US, num: 1, images: [frame] };
  const columns = { utime: START_US, num: 2, x: [1, 2], y: [3, 4], z: [5, 6], other: [0, 0, 0] };
  const cloud = { utime: START_US, n_points: 2, points: [[1, 3, 5], [2, 4, 6]], n_channels: 1, channel_names: ["Intensity"], channels: [[8, 9]] };
  writeLog("columns.lcm", [["A", 0, theirs, "columns_t", columns], ["EYES", 0, theirs, "frames_t", frames], ["B", 0, theirs, "cloud_t", cloud]]);
  const of = (topic) => importTo("columns.lcm", "--lcm-types", path("types"), "--lidar-topic", topic);
  const { clouds, images } = of("A");
  assert.deepEqual(pointsOf(clouds[0]), [{ x: 1, y: 3, z: 5 }, { x: 2, y: 4, z: 6 }]);
  assert.equal(images[0].pixelformat, GREY);
  assert.deepEqual(images[0].data, Buffer.alloc(16, 80));
  assert.deepEqual(pointsOf(of("B").clouds[0]), [{ x: 1, y: 3, z: 5, intensity: 8 }, { x: 2, y: 4, z: 6, intensity: 9 }]);
});

test("of several clouds, the one on the rig's channel", () => {
  writeLog("two.lcm", [...scanEvents, ["SPARE", 0, theirs, "scan_t", { ...scan(0), num: 0, points: [] }]]);
  const importOn = (...flags) => ["--lcm-types", path("types"), ...flags];
  assert.match(refusal(path("two.lcm"), ...importOn()), /has 2 topics of type/);
  const args = importOn("--lidar-channel", "SCAN", "--force", "--out", path("two_out.lcm"));
  assert.match(execFileSync(importRos, [path("two.lcm"), ...args], { encoding: "utf8" }), /SCAN: 2 messages of SCAN/);
});

test("clouds with a width and a height are no images", () => {
  const picture = { utime: START_US, width: 3, height: 1, num: 3, points: [0, 1, 2].map(echo) };
  writeLog("range_images.lcm", [["SCAN", 0, theirs, "range_image_t", picture], ["EYE", 0, ours, "image_t", grey(0)]]);
  const { clouds } = importTo("range_images.lcm", "--lcm-types", path("types"));
  assert.deepEqual(pointsOf(clouds[0]).map(({ x }) => x), [1, 2, 3]);
});

test("a file of types that cannot be read is named", () => {
  mkdirSync(path("broken"));
  writeFileSync(path("broken/odd.lcm"), "struct odd_t { int32_t; }");
  writeLog("scans.lcm", scanEvents);
  assert.match(refusal(path("scans.lcm"), "--lcm-types", path("broken")), /odd\.lcm: cannot read the member "int32_t"/);
});

test("types that are not known: said, and how to define them", () => {
  writeLog("scans.lcm", scanEvents);
  assert.match(refusal(path("scans.lcm")), /SCAN \(LCM type 0x[0-9a-f]{16}, which is not known: --lcm-types FOLDER defines it, 2\)/);
  assert.match(refusal(path("scans.lcm"), "--lcm-types", path("nowhere")), /^import_ros: --lcm-types .*nowhere: ENOENT/);
});

test("a log that is cut off or damaged: what is whole", () => {
  writeLog("scans.lcm", scanEvents);
  const whole = readFileSync(path("scans.lcm"));
  writeFileSync(path("cut.lcm"), whole.subarray(0, -10));
  const cut = importTo("cut.lcm", "--lcm-types", path("types"));
  assert.deepEqual([cut.clouds.length, cut.images.length], [2, 1]);
  assert.match(cut.said, /is cut off at byte \d+ of \d+: what is before it is read/);
  const second = whole.indexOf(whole.subarray(0, 4), 4); // the first image's event
  writeFileSync(path("damaged.lcm"), whole.subarray(0, second));
  appendFileSync(path("damaged.lcm"), Buffer.alloc(50, 1));
  appendFileSync(path("damaged.lcm"), whole.subarray(second));
  const damaged = importTo("damaged.lcm", "--lcm-types", path("types"));
  assert.deepEqual([damaged.clouds.length, damaged.images.length], [2, 2]);
  assert.match(damaged.said, new RegExp(`1 place is damaged and left out, at byte ${second} `));
});
