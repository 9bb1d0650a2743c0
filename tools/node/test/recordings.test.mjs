// One session, recorded in every way: the same messages, byte for byte.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, truncateSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { UserError } from "../lib/command.mjs";
import { LogWriter } from "../lib/lcm_log.mjs";
import { voqcalTypes } from "../lib/lcm_types.mjs";
import { DamagedIndex } from "../lib/recordings/merged.mjs";
import { openRecording } from "../lib/recordings/open.mjs";
import { writeBag, writeDb3, writeMcap } from "./recording_writers.mjs";

const folder = mkdtempSync(join(tmpdir(), "voqcal-recordings-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const program = fileURLToPath(new URL("../../import_ros", import.meta.url));

const START = 1_600_000_000_000_000_000n;
const NUM = 12;
const stamp = (ns) => ({ sec: Number(ns / 1_000_000_000n), nsec: Number(ns % 1_000_000_000n) });
const cloud = (ns, i) => ({
  header: { seq: 0, stamp: stamp(ns), frame_id: "velodyne" },
  height: 1,
  width: 3,
  fields: ["x", "y", "z"].map((name, axis) => ({ name, offset: 4 * axis, datatype: 7, count: 1 })),
  is_bigendian: false,
  point_step: 12,
  row_step: 36,
  data: Uint8Array.from({ length: 36 }, (_, k) => i + k),
  is_dense: true,
});
const image = (ns, i) => ({
  header: { seq: 0, stamp: stamp(ns), frame_id: "camera" },
  width: 4,
  height: 2,
  encoding: "mono8",
  is_bigendian: 0,
  step: 4,
  data: Uint8Array.from({ length: 8 }, (_, k) => 3 * i + k),
});
const messages = Array.from({ length: NUM }, (_, i) => START + BigInt(i) * 100_000_000n).flatMap((ns, i) => [
  { topic: "/points", type: "sensor_msgs/PointCloud2", logTimeNs: ns, message: cloud(ns, i) },
  { topic: "/camera", type: "sensor_msgs/Image", logTimeNs: ns + 5n, message: image(ns, i) },
]);
const first = messages.slice(0, 10);
const rest = messages.slice(10);

async function read(paths, isScanning = false) {
  const recording = await openRecording(paths, folder, isScanning);
  try {
    const found = [];
    for await (const { topic, logTimeNs, decode } of recording.messages(["/points", "/camera"])) {
      found.push({ topic, logTimeNs, data: [...decode().data] });
    }
    return { found, remarks: recording.remarks, topics: recording.topics };
  } finally {
    await recording.close();
  }
}

const expected = messages.map(({ topic, logTimeNs, message }) => ({ topic, logTimeNs, data: [...message.data] }));
const zstd = (bytes) => execFileSync("zstd", ["-qc", `--stream-size=${bytes.length}`], { input: bytes });
const inFolder = async (name, write) => {
  mkdirSync(path(name));
  await write(first, (file) => join(path(name), file), 0);
  await write(rest, (file) => join(path(name), file), 1);
};

const KINDS = {
  "a bag": () => writeBag(path("a.bag"), messages),
  "a bag whose recorder was killed": () => writeBag(path("b.bag.active"), messages, { hasIndex: false }),
  "bags of a split recording": () =>
    inFolder("bags", (part, file, i) => writeBag(file(`x_2020_${i}.bag`), part)),
  "MCAP": () => writeMcap(path("c.mcap"), messages),
  "MCAP of many chunks": () => writeMcap(path("d.mcap"), messages, { chunkSize: 500 }),
  "MCAP without chunks (fastwrite)": () => writeMcap(path("e.mcap"), messages, { useChunks: false }),
  "MCAP without an index": () => writeMcap(path("f.mcap"), messages, { useMessageIndex: false, useChunkIndex: false }),
  "MCAP whose summary has no channels": () =>
    writeMcap(path("k.mcap"), messages, { repeatSchemas: false, repeatChannels: false }),
  "MCAP without statistics": () => writeMcap(path("g.mcap"), messages, { useStatistics: false }),
  "MCAP of a split recording": () =>
    inFolder("mcaps", async (part, file, i) => {
      writeFileSync(file("metadata.yaml"), "");
      writeFileSync(file("._x_0.mcap"), "of another system");
      await writeMcap(file(`x_${i}.mcap`), part);
    }),
  "MCAP packed by file": async () => {
    await writeMcap(path("h.mcap"), messages);
    execFileSync("zstd", ["-q", "--rm", path("h.mcap"), "-o", path("h.mcap.zstd")]);
  },
  "sqlite3": () => writeDb3(path("i.db3"), messages),
  "sqlite3 of a split recording": () =>
    inFolder("db3s", (part, file, i) => writeDb3(file(`x_${i}.db3`), part)),
  "sqlite3 packed by message": () => writeDb3(path("j.db3"), messages, zstd),
};
const hasPython = spawnSync("python3", ["--version"]).status === 0;
const hasZstd = spawnSync("zstd", ["--version"]).status === 0;
const lacks = (kind) => (kind.includes("sqlite3") && !hasPython) || (kind.includes("packed") && !hasZstd);

for (const [kind, write] of Object.entries(KINDS)) {
  test(`${kind}: the very messages`, { skip: lacks(kind) }, async () => {
    const before = new Set(readdirSync(folder));
    await write();
    const [name] = readdirSync(folder).filter((file) => !before.has(file));
    const { found, topics } = await read([path(name)]);
    assert.deepEqual(found, expected);
    assert.equal(topics.get("/points").type, "sensor_msgs/PointCloud2");
    if (!kind.includes("statistics")) assert.equal(topics.get("/camera").count, NUM);
    assert.ok(!readdirSync(folder).some((file) => file.startsWith(".unpacked")));
  });
}

test("files given in any order are one recording; so are those of one sensor each", async () => {
  await writeMcap(path("one.mcap"), rest);
  await writeMcap(path("two.mcap"), first);
  assert.deepEqual((await read([path("one.mcap"), path("two.mcap")])).found, expected);
  writeBag(path("lidar.bag"), messages.filter(({ topic }) => topic === "/points"));
  writeBag(path("camera.bag"), messages.filter(({ topic }) => topic === "/camera"));
  assert.deepEqual((await read([path("lidar.bag"), path("camera.bag")])).found, expected);
});

test("a recorder that was killed: what came to the disk", async () => {
  await writeMcap(path("killed.mcap"), messages, { isKilled: true, chunkSize: 300 });
  const { found, remarks } = await read([path("killed.mcap")]);
  assert.ok(found.length >= NUM);
  assert.deepEqual(found, expected.slice(0, found.length));
  assert.match(remarks.join(), /killed.mcap: was not closed by its recorder/);
});

test("a damaged chunk is left out and named, once the index led to it", async () => {
  await writeMcap(path("damaged.mcap"), messages, { chunkSize: 300 });
  const bytes = readFileSync(path("damaged.mcap"));
  bytes.fill(0x55, bytes.indexOf("velodyne", bytes.length / 4, "latin1"), bytes.indexOf("velodyne", bytes.length / 4, "latin1") + 8);
  writeFileSync(path("damaged.mcap"), bytes);
  await assert.rejects(read([path("damaged.mcap")]), DamagedIndex);
  const { found, remarks } = await read([path("damaged.mcap")], true);
  assert.ok(found.length > NUM && found.length < 2 * NUM);
  assert.match(remarks.join(), /1 chunk is damaged and left out, at byte \d+/);
});

test("a damaged record outside of chunks is left out and named; what is behind it is read", async () => {
  await writeMcap(path("fast.mcap"), messages, { useChunks: false });
  const whole = readFileSync(path("fast.mcap"));
  const isMessage = (at) => whole[at] === 5 && whole.readUInt32LE(at + 5) === 0 && whole.readBigUInt64LE(at + 15) === START;
  let at = 0;
  while (!isMessage(at)) ++at;
  const damages = {
    "a length beyond the file": (bytes) => bytes.writeBigUInt64LE(1n << 40n, at + 1),
    "no record's opcode": (bytes) => bytes.fill(0, at, at + 9),
    "a message without all of its head": (bytes) => {
      bytes.writeBigUInt64LE(10n, at + 1); // of which what is left is made a record that nobody knows
      bytes[at + 19] = 0x90;
      bytes.writeBigUInt64LE(whole.readBigUInt64LE(at + 1) - 19n, at + 20);
    },
  };
  for (const [what, harm] of Object.entries(damages)) {
    const bytes = Buffer.from(whole);
    harm(bytes);
    writeFileSync(path("harmed.mcap"), bytes);
    const { found, remarks } = await read([path("harmed.mcap")]);
    assert.deepEqual(found, expected.slice(1), what);
    assert.match(remarks.join(), /harmed.mcap: 1 (stretch|record) is damaged and left out, at byte \d+/);
  }
});

test("a damaged schema costs its topic alone", async () => {
  const bytes = readFileSync(path("fast.mcap"));
  const at = bytes.indexOf("sensor_msgs/msg/Image") - 4;
  bytes.writeUInt32LE(0xffffffff, at); // the length of the name
  writeFileSync(path("harmed.mcap"), bytes);
  const recording = await openRecording([path("harmed.mcap")], folder);
  assert.equal(recording.topics.get("/points").count, NUM);
  assert.equal(recording.topics.get("/camera").type, "without a schema");
  assert.match(recording.remarks.join(), /harmed.mcap: 1 record is damaged and left out/);
  await recording.close();
});

test("a bag's damaged records are left out and named", async () => {
  const bytes = readFileSync(path("b.bag.active"));
  const at = bytes.indexOf("time=", bytes.length / 2);
  bytes.write("tame=", at);
  writeFileSync(path("harmed.bag"), bytes);
  const { found, remarks } = await read([path("harmed.bag")]);
  assert.equal(found.length, 2 * NUM - 1);
  assert.match(remarks.join(), /harmed.bag: 1 record is damaged and left out, at byte \d+/);
});

test("a damaged recording is imported but for what is damaged", () => {
  const done = spawnSync(program, [path("damaged.mcap"), "--out", path("out.lcm")], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  assert.match(done.stdout, /damaged.mcap: 1 chunk is damaged[^]*LIDAR_POINTS: \d+ messages/);
});

test("a sqlite3 recording that is cut off: what can be read, or why not", { skip: !hasPython }, async () => {
  writeDb3(path("cut.db3"), Array.from({ length: 40 }, () => messages).flat());
  const bytes = readFileSync(path("cut.db3"));
  for (const share of [0.2, 0.6, 0.95]) {
    writeFileSync(path("cut.db3"), bytes.subarray(0, Math.floor(share * bytes.length)));
    try {
      const { found, remarks } = await read([path("cut.db3")]);
      assert.ok(found.length > 0);
      assert.match(remarks.join(), /cut off or damaged/);
    } catch (error) {
      assert.match(error.message, /cut.db3/);
    }
  }
});

test("bag, MCAP and sqlite3 give the same log, byte for byte", { skip: !hasPython }, () => {
  const logs = ["a.bag", "c.mcap", "e.mcap", "mcaps", "i.db3"].map((name) => {
    execFileSync(program, [path(name), "--out", path(`${name}.lcm`)]);
    return readFileSync(path(`${name}.lcm`));
  });
  for (const log of logs) assert.deepEqual(log, logs[0]);
});

test("a large bag without an index is not held whole to look for one", async () => {
  const name = path("large.bag.active");
  writeBag(name, messages, { hasIndex: false });
  truncateSync(name, 1_500_000_000); // its end is a hole
  const before = process.resourceUsage().maxRSS;
  assert.deepEqual((await read([name])).found, expected);
  assert.ok(process.resourceUsage().maxRSS - before < 500_000); // kB
});

// ---- Hostile variants ----------------------------------------------------------------------------------

/** The same numbers from 0 to 1 each time. */
function numbersFrom(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** Cut off, or with some bytes, a length's bytes or a stretch of it changed. */
function hostile(bytes, next) {
  const changed = Buffer.from(bytes);
  const place = () => Math.floor(next() * changed.length);
  switch (Math.floor(4 * next())) {
    case 0:
      return changed.subarray(0, place());
    case 1:
      for (let i = 0; i < 10; ++i) changed[place()] = 256 * next();
      return changed;
    case 2:
      changed.writeUInt32LE(Math.floor(next() * 2 ** 32), Math.floor(next() * (changed.length - 4)));
      return changed;
    default:
      return Buffer.concat([changed.subarray(0, place()), changed.subarray(place())]);
  }
}

/** As import_ros does: by the index, then without it; its messages undecoded. @returns the error, if it is refused. */
async function refusalOf(file) {
  for (const isScanning of [false, true]) {
    try {
      const recording = await openRecording([file], folder, isScanning);
      for await (const { data } of recording.messages(["/points", "/camera"])) assert.ok(data.length >= 0);
      await recording.close();
      return undefined;
    } catch (error) {
      if (!(error instanceof DamagedIndex)) return error;
    }
  }
  return new Error("the scan looked at the index");
}

/** The same channels, their messages of our types. */
function writeLcmLog(file) {
  const types = voqcalTypes();
  const log = new LogWriter(file);
  for (const { topic, logTimeNs, message } of messages) {
    const { width, height, data } = message;
    const common = { utime: logTimeNs / 1000n, width, height, data };
    const bytes = topic === "/camera"
      ? types.encode("image_t", { ...common, row_stride: 4, pixelformat: 1497715271, size: 8, nmetadata: 0, metadata: [] })
      : types.encode("pointcloud2_t", { ...message, ...common, seq: 0, frame_id: "lidar", nfields: 3, is_bigendian: 0, data_nbytes: 36, is_dense: 1 });
    log.write(common.utime, topic, bytes);
  }
  log.finish();
}

const WRITERS = {
  "bags": (file) => writeBag(file, messages, { chunkBytes: 600 }),
  "bags without index": (file) => writeBag(file, messages, { hasIndex: false, chunkBytes: 600 }),
  "MCAP": (file) => writeMcap(file, messages, { chunkSize: 500 }),
  "MCAP without chunks": (file) => writeMcap(file, messages, { useChunks: false }),
  "LCM logs": writeLcmLog,
};
for (const [kind, write] of Object.entries(WRITERS)) {
  test(`40 hostile variants of ${kind}: read, or refused in one line for people`, async () => {
    const file = path("hostile");
    await write(file);
    const whole = readFileSync(file);
    const next = numbersFrom(1);
    for (let i = 0; i < 40; ++i) {
      writeFileSync(file, hostile(whole, next));
      const error = await refusalOf(file);
      if (!error) continue;
      assert.ok(error instanceof UserError, `variant ${i}: ${error.stack}`);
      assert.match(error.message, /^[^\n]*hostile: [^\n]+$/);
      assert.doesNotMatch(error.message, /undefined|null|NaN|not a function|BigInt|out of range|out of bounds/, `variant ${i}`);
    }
  });
}

test("a cut within a chunk: what of it came to the disk", async () => {
  for (const name of ["a.bag", "c.mcap"]) {
    const whole = readFileSync(path(name));
    writeFileSync(path("half"), whole.subarray(0, whole.lastIndexOf("velodyne", -1, "latin1")));
    const { found, remarks } = await read([path("half")]);
    assert.deepEqual(found, expected.slice(0, 2 * NUM - 2));
    assert.match(remarks.join(), /half: is cut off or damaged at byte/);
  }
});

test("a large sqlite3 recording, of which the beginning is looked at first, comes to its end", { skip: !hasPython }, () => {
  const large = { ...image(START, 0), width: 100_000, height: 1, step: 100_000, data: new Uint8Array(100_000) };
  const isImage = ({ topic }) => topic === "/camera";
  const grown = [...messages, ...messages].map((message) => (isImage(message) ? { ...message, message: large } : message));
  writeDb3(path("large.db3"), grown);
  const done = spawnSync(program, [path("large.db3"), "--out", path("large.lcm")], { encoding: "utf8", timeout: 60_000 });
  assert.equal(done.status, 0, done.stderr);
  assert.match(done.stdout, /CAMERA_IMAGE: 24 messages/);
});
