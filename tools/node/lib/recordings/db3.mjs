// ROS 2's sqlite3 recordings, read by Python's own sqlite3 (read_db3.py): it streams files of any size, and reads
// what a killed recorder left in its write-ahead log, which no package of npm does without a compiler.

import { execFile, spawn } from "node:child_process";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { loadDecompressHandlers } from "@mcap/support";
import { UserError } from "../command.mjs";
import { exactReader } from "../exact_reader.mjs";
import { plainType, ros2Decoder } from "./message_decoders.mjs";
import { ZSTD_MAGIC, zstdContentBytes } from "./zstd.mjs";

export const SQLITE_MAGIC = Buffer.from("SQLite format 3\0");
const SCRIPT = fileURLToPath(new URL("read_db3.py", import.meta.url));
const FRAME_BYTES = 16;
const DAMAGED = 0xffffffff;

export async function openDb3(path) {
  const about = await tell(path);
  const { zstd } = await loadDecompressHandlers();
  const byId = new Map(about.topics.map((topic) => [topic.id, topic]));
  const part = {
    topics: topicsOf(about.topics),
    startNs: BigInt(about.start_ns),
    isIndexed: false,
    remarks: [],
    close() {},
  };
  part.messages = async function* messages(names) {
    const ids = about.topics.filter(({ name }) => names.includes(name)).map(({ id }) => id);
    if (ids.length === 0) return;
    for await (const { id, logTimeNs, data } of rows(path, ids)) {
      if (id === DAMAGED) {
        part.remarks.push(`is cut off or damaged (${data}): what is before it is read`);
        return;
      }
      yield messageOf(byId.get(id), logTimeNs, unpacked(data, zstd));
    }
  };
  return part;
}

async function tell(path) {
  try {
    const { stdout } = await promisify(execFile)("python3", [SCRIPT, path], { maxBuffer: 1 << 28 });
    return JSON.parse(stdout);
  } catch (error) {
    const cause = error.code === "ENOENT" ? "reading it needs python3" : (error.stderr ?? error.message).trim();
    throw new UserError(`${path}: cannot be read as a ROS 2 sqlite3 recording: ${cause}`);
  }
}

function topicsOf(topics) {
  const byName = new Map();
  for (const { name, type, count } of topics) {
    byName.set(name, { type: plainType(type), count: count + (byName.get(name)?.count ?? 0) });
  }
  return byName;
}

function messageOf(topic, logTimeNs, data) {
  const decode = () => {
    if (topic.format !== "cdr") throw new UserError(`topic ${topic.name} is encoded as ${topic.format}; wanted: cdr`);
    topic.decode ??= ros2Decoder(topic.type, topic.definition);
    return topic.decode(data);
  };
  return { topic: topic.name, logTimeNs, data, decode };
}

/** Messages may be compressed one by one (`--compression-mode message`); CDR never begins like zstd. */
const unpacked = (data, zstd) =>
  data.subarray(0, 4).equals(ZSTD_MAGIC) ? zstd(data, zstdContentBytes(data)) : data;

async function* rows(path, ids) {
  const child = spawn("python3", [SCRIPT, path, ...ids.map(String)], { stdio: ["ignore", "pipe", "ignore"] });
  const ended = new Promise((resolve) => child.once("close", resolve));
  try {
    const read = exactReader(child.stdout);
    for (let head = await read(FRAME_BYTES); head; head = await read(FRAME_BYTES)) {
      const data = await read(head.readUInt32LE(12));
      if (data === undefined) return;
      yield { id: head.readUInt32LE(0), logTimeNs: head.readBigInt64LE(4), data };
    }
    if ((await ended) !== 0) yield { id: DAMAGED, logTimeNs: 0n, data: "its reader ended early" };
  } finally {
    child.kill();
  }
}
