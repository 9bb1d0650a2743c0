// bench_recordings.mjs FOLDER [MEGABYTES]: writes one recording in each format into FOLDER (as large as that: 300 MB unless
// told) and prints how fast it is read and how fast import_ros makes a log of it: by the time that one core worked, which
// other programs and the disk hardly change, and by the clock; and, to compare with, how fast cp copies it.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { openRecording } from "../lib/recordings/open.mjs";
import { writeBag, writeDb3, writeMcap } from "./recording_writers.mjs";

const [folder, megabytes = "300"] = process.argv.slice(2);
const path = (name) => join(folder, name);
const importer = fileURLToPath(new URL("../../import_ros", import.meta.url));

// A sweep of 60,000 points and a grey image of 2 Mpx: noise, which no packing makes smaller, in half of the bytes.
function noise(length) {
  let state = 1;
  const next = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 24;
  return Uint8Array.from({ length }, (_, i) => (i % 2 ? next() : 0));
}
const POINTS = noise(60_000 * 22);
const PIXELS = noise(1920 * 1080);
const header = (ns) => ({ seq: 0, stamp: { sec: Number(ns / 1_000_000_000n), nsec: Number(ns % 1_000_000_000n) }, frame_id: "sensor" });
const field = (name, offset, datatype) => ({ name, offset, datatype, count: 1 });
const FIELDS = [...["x", "y", "z", "intensity"].map((name, i) => field(name, 4 * i, 7)), field("ring", 16, 4), field("time", 18, 7)];
const cloud = (ns) => ({
  header: header(ns), height: 1, width: 60_000, fields: FIELDS, is_bigendian: false, point_step: 22, row_step: POINTS.length, data: POINTS, is_dense: true,
});
const image = (ns) => ({ header: header(ns), width: 1920, height: 1080, encoding: "mono8", is_bigendian: 0, step: 1920, data: PIXELS });

const num = Math.ceil((1e6 * Number(megabytes)) / (POINTS.length + PIXELS.length));
const messages = Array.from({ length: num }, (_, i) => 1_600_000_000_000_000_000n + BigInt(i) * 100_000_000n).flatMap((ns) => [
  { topic: "/points", type: "sensor_msgs/PointCloud2", logTimeNs: ns, message: cloud(ns) },
  { topic: "/camera", type: "sensor_msgs/Image", logTimeNs: ns, message: image(ns) },
]);

const KINDS = {
  "bag": () => writeBag(path("bag"), messages, { chunkBytes: 768 << 10 }), // rosbag's own
  "bag without index": () => writeBag(path("bag without index"), messages, { hasIndex: false, chunkBytes: 768 << 10 }),
  "mcap": () => writeMcap(path("mcap"), messages, { chunkSize: 4 << 20 }),
  "mcap without chunks": () => writeMcap(path("mcap without chunks"), messages, { useChunks: false }),
  "mcap, chunks by zstd": () => writeMcap(path("mcap, chunks by zstd"), messages, { chunkSize: 4 << 20, compressChunk: zstdChunk }),
  "db3": () => writeDb3(path("db3"), messages),
  "mcap packed by zstd": () => execFileSync("zstd", ["-qf", path("mcap"), "-o", path("mcap packed by zstd")]),
};

function zstdChunk(data) {
  return { compression: "zstd", compressedData: execFileSync("zstd", ["-qc1"], { input: data, maxBuffer: 1 << 30 }) };
}

/** What `run` took of the clock and (this process alone) of a core, in seconds. */
async function secondsOf(run) {
  const [begin, cpu] = [process.hrtime.bigint(), process.cpuUsage()];
  await run();
  const { user, system } = process.cpuUsage(cpu);
  return { clock: Number(process.hrtime.bigint() - begin) / 1e9, core: (user + system) / 1e6 };
}

/** The same of another program, and its memory. */
function run(...args) {
  const begin = process.hrtime.bigint();
  const done = spawnSync("/usr/bin/time", ["-f", "%U %S %M", ...args], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(done.stderr);
  const [user, system, kilobytes] = done.stderr.trim().split("\n").at(-1).split(" ").map(Number);
  return { clock: Number(process.hrtime.bigint() - begin) / 1e9, core: user + system, megabytes: kilobytes / 1024 };
}

async function read(name) {
  const recording = await openRecording([path(name)], folder);
  let numBytes = 0;
  for await (const { data } of recording.messages(["/points", "/camera"])) numBytes += data.length;
  await recording.close();
  return numBytes;
}

mkdirSync(folder, { recursive: true });
for (const [name, make] of Object.entries(KINDS)) {
  rmSync(path(name), { force: true });
  await make();
  let numBytes;
  const reading = await secondsOf(async () => (numBytes = await read(name)));
  const importing = run(importer, path(name), "--out", path("out.lcm"), "--force");
  const copying = run("cp", path(name), path("copy"));
  rmSync(path("copy"));
  const rates = ({ clock, core }) => [core, clock].map((s) => (numBytes / 1e6 / s).toFixed(0)).join(" MB a core's second, ") + " MB/s";
  console.log(
    `${name}: ${(statSync(path(name)).size / 1e6).toFixed(0)} MB; read ${rates(reading)}; imported ${rates(importing)}, ` +
      `${importing.megabytes.toFixed(0)} MB of memory; copied ${rates(copying)}`,
  );
  if (name !== "mcap") rmSync(path(name)); // which the last one is made of
}
