// What the tests import: recordings of both kinds of ROS, written here. The bag writer
// follows the published format 2.0 of ROS 1 bags, the MCAP one is @mcap/core's own.

import { execFileSync } from "node:child_process";
import { closeSync, openSync, writeSync } from "node:fs";
import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { McapWriter } from "@mcap/core";
import { FileHandleWritable } from "@mcap/nodejs";
import { PACKET_DEFINITIONS } from "../lib/sensor_msgs/packets.mjs";

const require = createRequire(import.meta.url);
const { ros1, ros2humble } = require("@foxglove/rosmsg-msgs-common");
const { md5, parse, stringify } = require("@foxglove/rosmsg");
const { MessageWriter: Ros1Writer } = require("@foxglove/rosmsg-serialization");
const { MessageWriter: Ros2Writer } = require("@foxglove/rosmsg2-serialization");

/** A type and all that it is made of, the type itself first. */
function definitionsOf(types, name) {
  if (PACKET_DEFINITIONS[name]) return parse(PACKET_DEFINITIONS[name], { ros2: true });
  const found = new Map();
  const add = (type) => {
    if (found.has(type)) return;
    const definition = types[type] ?? types[type.replace("/", "/msg/")];
    found.set(type, definition);
    for (const field of definition.definitions) if (field.isComplex) add(field.type);
  };
  add(name);
  const [main, ...others] = found.values();
  return [{ ...main, name: undefined }, ...others];
}

const time = (ns) => ({ sec: Number(ns / 1_000_000_000n), nsec: Number(ns % 1_000_000_000n) });

// ---- LCM to sensor_msgs, the reverse of lib/sensor_msgs -----------------------------------------

const header = (message, frame_id) => ({ seq: 0, stamp: time(message.utime * 1000n), frame_id });

export function cloudToRos(message) {
  return { header: header(message, message.frame_id), ...message, is_bigendian: false, is_dense: true };
}

export function compressedToRos(message) {
  return { header: header(message, "camera"), format: "jpeg", data: message.data };
}

export function rawToRos(message, encoding) {
  const { width, height, row_stride: step, data } = message;
  return { header: header(message, "camera"), width, height, step, encoding, is_bigendian: 0, data };
}

// ---- Messages: {topic, type, logTimeNs, message} in order of time ----------------------------------

/**
 * As `ros2 bag record` writes them. `options` go to McapWriter (chunkSize, compressChunk, ...); with `isKilled` the recorder
 * does not come to write the end.
 */
export async function writeMcap(path, messages, { isKilled = false, ...options } = {}) {
  const file = await open(path, "w");
  const writer = new McapWriter({ writable: new FileHandleWritable(file), ...options });
  await writer.start({ profile: "ros2", library: "voqcal test" });
  const channels = new Map();
  for (const { topic, type, logTimeNs, message } of messages) {
    if (!channels.has(topic)) {
      const definitions = definitionsOf(ros2humble, type);
      const schemaId = await writer.registerSchema({
        name: type.replace("/", "/msg/"),
        encoding: "ros2msg",
        data: Buffer.from(stringify(definitions)),
      });
      const id = await writer.registerChannel({
        topic,
        schemaId,
        messageEncoding: "cdr",
        metadata: new Map(),
      });
      channels.set(topic, { id, writer: new Ros2Writer(definitions) });
    }
    const channel = channels.get(topic);
    await writer.addMessage({
      channelId: channel.id,
      sequence: 0,
      logTime: logTimeNs,
      publishTime: logTimeNs,
      data: channel.writer.writeMessage(message),
    });
  }
  if (!isKilled) await writer.end();
  await file.close();
}

/** A ROS 2 sqlite3 recording, by Python; `packs` what each message's bytes become. */
export function writeDb3(path, messages, pack = (bytes) => bytes) {
  const writers = new Map();
  const parts = messages.map(({ topic, type, logTimeNs, message }) => {
    if (!writers.has(topic)) writers.set(topic, new Ros2Writer(definitionsOf(ros2humble, type)));
    const data = pack(Buffer.from(writers.get(topic).writeMessage(message)));
    const names = Buffer.from(`${topic} ${type.replace("/", "/msg/")}`);
    return Buffer.concat([u32(names.length), names, u64(logTimeNs), u32(data.length), data]);
  });
  const script = fileURLToPath(new URL("write_db3.py", import.meta.url));
  execFileSync("python3", [script, path], { input: Buffer.concat(parts) });
}

/**
 * A bag as rosbag writes it: bag header, chunks, each with its index behind it, connections, chunk infos. In one chunk, or in
 * such of about `chunkBytes`; without what is behind the last chunk's index if `hasIndex` is false, as a recorder that is
 * killed leaves it.
 */
export function writeBag(path, messages, { hasIndex = true, chunkBytes = Infinity } = {}) {
  const connections = new Map();
  const chunks = [];
  for (const { topic, type, logTimeNs, message } of messages) {
    if (chunks.length === 0 || chunks.at(-1).numBytes >= chunkBytes) chunks.push(new BagChunk());
    const chunk = chunks.at(-1);
    if (!connections.has(topic)) {
      const definitions = definitionsOf(ros1, type);
      const id = connections.size;
      connections.set(topic, { id, record: connectionRecord(id, topic, type, definitions), writer: new Ros1Writer(definitions) });
      chunk.append(connections.get(topic).record);
    }
    const { id, writer } = connections.get(topic);
    chunk.appendMessage(id, logTimeNs, writer.writeMessage(message));
  }
  writeBagFile(path, chunks, [...connections.values()], hasIndex);
}

class BagChunk {
  numBytes = 0;
  #records = [];
  #indices = new Map(); // connection -> {logTimeNs, offset} of its messages

  append(bytes) {
    this.#records.push(bytes);
    this.numBytes += bytes.length;
  }

  appendMessage(connection, logTimeNs, bytes) {
    if (!this.#indices.has(connection)) this.#indices.set(connection, []);
    this.#indices.get(connection).push({ logTimeNs, offset: this.numBytes });
    this.append(record({ op: u8(2), conn: u32(connection), time: bagTime(logTimeNs) }, bytes));
  }

  /** The chunk and its index. */
  records() {
    const data = record({ op: u8(5), compression: Buffer.from("none"), size: u32(this.numBytes) }, Buffer.concat(this.#records));
    const indices = [...this.#indices].map(([connection, index]) =>
      record(
        { op: u8(4), ver: u32(1), conn: u32(connection), count: u32(index.length) },
        Buffer.concat(index.flatMap(({ logTimeNs, offset }) => [bagTime(logTimeNs), u32(offset)])),
      ),
    );
    return Buffer.concat([data, ...indices]);
  }

  info(position) {
    const times = [...this.#indices.values()].flat().map(({ logTimeNs }) => logTimeNs);
    const counts = [...this.#indices].flatMap(([connection, index]) => [u32(connection), u32(index.length)]);
    return record(
      {
        op: u8(6),
        ver: u32(1),
        chunk_pos: u64(position),
        start_time: bagTime(times[0]),
        end_time: bagTime(times.at(-1)),
        count: u32(this.#indices.size),
      },
      Buffer.concat(counts),
    );
  }
}

function writeBagFile(path, chunks, connections, hasIndex) {
  const magic = Buffer.from("#ROSBAG V2.0\n");
  const header = (indexPosition) =>
    paddedHeader({
      op: u8(3),
      index_pos: u64(indexPosition),
      conn_count: u32(hasIndex ? connections.length : 0),
      chunk_count: u32(hasIndex ? chunks.length : 0),
    });
  const file = openSync(path, "w");
  let position = 0;
  const write = (bytes) => (position += writeSync(file, bytes));
  write(magic);
  write(header(0));
  const infos = [];
  for (const chunk of chunks) {
    infos.push(chunk.info(position));
    write(chunk.records());
  }
  if (hasIndex) {
    const indexPosition = position;
    for (const { record: bytes } of connections) write(bytes);
    for (const info of infos) write(info);
    writeSync(file, header(indexPosition), 0, undefined, magic.length);
  }
  closeSync(file);
}

function connectionRecord(id, topic, type, definitions) {
  const text = stringify(definitions);
  const data = fields({
    topic: Buffer.from(topic),
    type: Buffer.from(type),
    md5sum: Buffer.from(md5(definitions)),
    message_definition: Buffer.from(text),
  });
  return record({ op: u8(7), conn: u32(id), topic: Buffer.from(topic) }, data);
}

/** The bag header is filled up to 4096 bytes with spaces. */
function paddedHeader(values) {
  const head = fields(values);
  return record(values, Buffer.alloc(4096 - 8 - head.length, " "));
}

function record(values, data) {
  const head = fields(values);
  return Buffer.concat([u32(head.length), head, u32(data.length), data]);
}

function fields(values) {
  return Buffer.concat(
    Object.entries(values).flatMap(([name, value]) => {
      const key = Buffer.from(`${name}=`);
      return [u32(key.length + value.length), key, value];
    }),
  );
}

function little(numBytes, write) {
  const buffer = Buffer.alloc(numBytes);
  write(buffer);
  return buffer;
}
const u8 = (value) => Buffer.from([value]);
const u32 = (value) => little(4, (buffer) => buffer.writeUInt32LE(value));
const u64 = (value) => little(8, (buffer) => buffer.writeBigUInt64LE(BigInt(value)));
const bagTime = (ns) => Buffer.concat([u32(time(ns).sec), u32(time(ns).nsec)]);
