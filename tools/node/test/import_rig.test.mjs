// Recordings of several lidars and cameras: each sensor's topic onto its channel.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { firstMessages } from "../lib/first_messages.mjs";
import { readLog } from "../lib/lcm_log.mjs";
import { voqcalTypes } from "../lib/lcm_types.mjs";
import { writeMcap } from "./recording_writers.mjs";

const folder = mkdtempSync(join(tmpdir(), "voqcal-import-rig-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const program = fileURLToPath(new URL("../../import_ros", import.meta.url));
const types = voqcalTypes();

const SECOND = 1_000_000_000n;
const START = 1_600_000_000n * SECOND;
const header = (ns) => ({ stamp: { sec: Number(ns / SECOND), nsec: Number(ns % SECOND) }, frame_id: "sensor" });

/** A sweep of three points in 0.1 s, whose times count so many a second. */
function cloud(ns, ticksPerSecond) {
  const fields = ["x", "y", "z", "t"].map((name, i) => ({ name, offset: 4 * i, datatype: 7, count: 1 }));
  const points = [0, 0.05, 0.1].map((time) => Float32Array.from([1, 2, 3, time * ticksPerSecond]));
  const data = Buffer.concat(points.map(({ buffer }) => Buffer.from(buffer)));
  return { header: header(ns), height: 1, width: 3, fields, is_bigendian: false, point_step: 16, row_step: 48, data, is_dense: true };
}

const image = (ns, brightness) => ({
  header: header(ns), width: 2, height: 1, encoding: "mono8", is_bigendian: 0, step: 2, data: Buffer.alloc(2, brightness),
});

const LIDARS = { "/front/points": 1, "/rear/points": 1e6 }; // seconds, microseconds
const CAMERAS = { "/cam_left/image": 10, "/cam_LEFT_FRONT/image": 20 }; // their brightness

/**
 * Five frames of every sensor.
 * @param lateNs, recordedLateNs  by topic, how much later its stamps are than they should be, and than others it is recorded.
 */
async function record(name, { lidars = LIDARS, cameras = CAMERAS, lateNs = {}, recordedLateNs = {} } = {}) {
  const messages = [];
  for (let i = 0n; i < 5n; ++i) {
    const timeNs = START + i * (SECOND / 10n);
    const add = (topic, type, make, what) => {
      const logTimeNs = timeNs + (recordedLateNs[topic] ?? 0n);
      messages.push({ topic, type, logTimeNs, message: make(timeNs + (lateNs[topic] ?? 0n), what) });
    };
    for (const [topic, ticks] of Object.entries(lidars)) add(topic, "sensor_msgs/PointCloud2", cloud, ticks);
    for (const [topic, brightness] of Object.entries(cameras)) add(topic, "sensor_msgs/Image", image, brightness);
  }
  await writeMcap(path(name), messages);
}

const SENSORS = ["--lidar", "front=L_front", "--lidar", "rear=L_rear", "--camera", "left_front=C_1", "--camera", "left=C_2"];
const run = (name, flags = SENSORS) =>
  spawnSync(program, [path(name), "--force", "--out", path("out.lcm"), ...flags], { encoding: "utf8" });

/** The messages of each channel. */
function imported(name, flags) {
  const done = run(name, flags);
  assert.equal(done.status, 0, done.stderr);
  const found = {};
  for (const { channel, bytes } of readLog(path("out.lcm"))) {
    const type = channel.startsWith("L_") ? "pointcloud2_t" : "image_t";
    (found[channel] ??= []).push(types.decode(type, bytes));
  }
  return { ...found, said: done.stdout };
}

const timesOf = ({ data }) => [0, 1, 2].map((i) => data.readFloatLE(16 * i + 12));
const roundedTimesOf = (sweep) => timesOf(sweep).map((time) => Number(time.toFixed(6)));

test("each topic goes to the sensor whose name it has, the longest that fits; each lidar's times are its own", async () => {
  await record("named.mcap");
  const { L_front, L_rear, C_1, C_2, said } = imported("named.mcap");
  assert.deepEqual([L_front, L_rear, C_1, C_2].map(({ length }) => length), [5, 5, 5, 5]);
  assert.deepEqual([C_1[0].data[0], C_2[0].data[0]], [20, 10]);
  assert.deepEqual([roundedTimesOf(L_front[0]), roundedTimesOf(L_rear[0])], [[0, 0.05, 0.1], [0, 0.05, 0.1]]);
  assert.match(said, /^front: the points' t: seconds [^]*^rear: the points' t: microseconds /m);
  assert.match(said, /^C_1: 5 messages of \/cam_LEFT_FRONT\/image$/m);
});

test("topics of other names: one line says which there are and which flags map them; --topic does", async () => {
  await record("other.mcap", { lidars: { "/lidar0": 1, "/lidar1": 1e6, "/lidar2": 1 } });
  rmSync(path("out.lcm"), { force: true });
  const done = run("other.mcap");
  assert.equal(done.status, 1);
  assert.equal(
    done.stderr,
    `import_ros: ${path("other.mcap")}: which topics are those of the lidars front, rear is not clear ` +
      "(--topic front=NAME --topic rear=NAME says it); there are /lidar0, /lidar1, /lidar2\n",
  );
  assert.ok(!existsSync(path("out.lcm")));
  const { L_front, L_rear } = imported("other.mcap", [...SENSORS, "--topic", "front=/lidar1", "--topic", "rear=lidar2"]);
  assert.equal(timesOf(L_front[0])[2].toFixed(6), "0.100000"); // that of microseconds
  assert.equal(L_rear.length, 5);
  // One that is left for one needs no name.
  await record("one_left.mcap", { lidars: { "/lidar0": 1, "/lidar1": 1 } });
  assert.match(imported("one_left.mcap", [...SENSORS, "--topic", "front=/lidar1"]).said, /L_rear: 5 messages of \/lidar0/);
});

test("a topic that is given to another sensor is not taken a second time for its channel's name", async () => {
  await record("given.mcap", { cameras: { IMAGE_right: 10, IMAGE_other: 20 } });
  const sensors = [...SENSORS.slice(0, 4), "--camera", "left=C_left", "--camera", "right=IMAGE_right", "--topic", "left=IMAGE_right"];
  const { C_left, IMAGE_right } = imported("given.mcap", sensors);
  assert.deepEqual([C_left[0].data[0], IMAGE_right[0].data[0]], [10, 20]);
  await record("given.mcap", { cameras: { IMAGE_right: 10 } });
  assert.match(run("given.mcap", sensors).stderr, /^import_ros: [^\n]*topics are those of the cameras right is not clear[^\n]* none left: IMAGE_right is another sensor's already\n$/);
});

test("names that fit two topics, or none, are not guessed", async () => {
  for (const lidars of [{ "/front/a": 1, "/front/b": 1 }, { "/front_rear/a": 1, "/x": 1 }, { "/front_and_rear/a": 1, "/rear": 1 }]) {
    await record("unclear.mcap", { lidars });
    assert.match(run("unclear.mcap").stderr, /^import_ros: [^\n]*lidars front, rear is not clear[^\n]*\n$/);
  }
});

test("flags that cannot be meant: one line", async () => {
  await record("flags.mcap");
  const refuses = (words, ...flags) => {
    const done = run("flags.mcap", flags);
    assert.equal(done.status, 1);
    assert.match(done.stderr, /^import_ros: [^\n]*\n$/);
    assert.ok(done.stderr.includes(words), done.stderr);
  };
  refuses("--topic tail=/x: no sensor tail; there are front, rear, left_front, left", ...SENSORS, "--topic", "tail=/x");
  refuses("--topic must be SENSOR=NAME, is front", ...SENSORS, "--topic", "front");
  refuses("no topic /x of type sensor_msgs/Image", ...SENSORS, "--topic", "left=/x");
  const twice = ["--topic", "front=/rear/points", "--topic", "rear=/rear/points"];
  refuses("/rear/points is given to front too", ...SENSORS, ...twice);
  refuses("--lidar-topic is of a pair", ...SENSORS, "--lidar-topic", "/front/points");
  refuses("--camera-info-topic is of a pair", ...SENSORS, "--camera-info-topic", "/info");
  refuses("--topic is of a sensor that --lidar or --camera names", "--topic", "front=/front/points");
});

test("a sensor on another clock: log times for all, and which pairs tell of it", async () => {
  await record("clocks.mcap", { lateNs: { "/cam_left/image": 1000n * SECOND } });
  const { L_front, C_2, said } = imported("clocks.mcap");
  assert.equal(C_2[0].utime, L_front[0].utime);
  assert.match(said, /^front with left, rear with left: the clocks of lidar and camera differ by 16.7 min; log times/m);
});

test("log times for all: of no pair is it said that stamps are used", async () => {
  const lateNs = { "/cam_left/image": 1000n * SECOND, "/cam_LEFT_FRONT/image": 40n * SECOND };
  const recordedLateNs = { "/cam_LEFT_FRONT/image": 20n * SECOND };
  await record("both.mcap", { lateNs, recordedLateNs });
  const { L_front, C_1, C_2, said } = imported("both.mcap");
  assert.deepEqual([C_1, C_2].map(([{ utime }]) => utime - L_front[0].utime), [20_000_000n, 0n]);
  assert.match(said, /^front with left, rear with left: [^\n]*log times agree within 0 ms: using them/m);
  assert.match(said, /^front with left_front, rear with left_front: [^\n]*nor do the times [^\n]*agree \(19.8 s apart\)$/m);
  await record("stamps.mcap", { lateNs: { "/cam_LEFT_FRONT/image": 40n * SECOND }, recordedLateNs });
  assert.match(imported("stamps.mcap").said, /agree \(19.8 s apart\): stamps are used$/m);
});

/** A recording whose messages are all as large; how many were read is counted. */
function endless(topics, numBytes) {
  const recording = { numRead: 0 };
  const message = { data: { length: numBytes }, logTimeNs: START, decode: () => ({}) };
  recording.messages = async function* () {
    for (;;) for (const topic of topics) yield { topic, ...message, num: ++recording.numRead };
  };
  return recording;
}
const planOf = (topics) => new Map(topics.map((topic) => [topic, { prepare: (message) => message, stampNs: () => START, isTelling: () => false }]));

test("how much is looked at grows with the sensors; one that is silent does not have all read", async () => {
  const topics = ["a", "b", "c", "d", "e", "f", "g", "h"];
  const sensors = topics.map((topic) => ({ topic }));
  const first = await firstMessages(endless(topics, 12 << 20), planOf(topics), sensors);
  assert.deepEqual([...first.values()].map(({ length }) => length), topics.map(() => 20));
  const withoutA = endless(topics.slice(1), 16 << 20);
  assert.equal((await firstMessages(withoutA, planOf(topics), sensors)).get("a").length, 0);
  assert.equal(withoutA.numRead, 8 * 16 + 1);
});
