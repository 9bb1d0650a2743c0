// ROS 1 bags and MCAP files behind one face:
//   topics    Map of name -> {type, count}; type without "msg/": "sensor_msgs/Image"
//   messages  async generator of {topic, logTimeNs, message}, in the order of their log times
//   close

import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";
import { UserError } from "./command.mjs";

// These packages are CommonJS.
const require = createRequire(import.meta.url);
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
const { parse: parseDefinition } = require("@foxglove/rosmsg");
const { MessageReader: Ros1Reader } = require("@foxglove/rosmsg-serialization");
const { MessageReader: Ros2Reader } = require("@foxglove/rosmsg2-serialization");

const BAG_MAGIC = Buffer.from("#ROSBAG V2.0\n");
const MCAP_MAGIC = Buffer.from("\x89MCAP0\r\n", "latin1");
const SQLITE_MAGIC = Buffer.from("SQLite format 3\0");

/** Opens a recording, told by its first bytes. Throws UserError naming file and cause. */
export async function openRecording(path) {
  const magic = await firstBytes(path);
  const startsWith = (wanted) => magic.subarray(0, wanted.length).equals(wanted);
  if (startsWith(BAG_MAGIC)) return closedOnError(path, new FileReader(path), openBag);
  if (startsWith(MCAP_MAGIC)) return closedOnError(path, await open(path), openMcap);
  const what = startsWith(SQLITE_MAGIC)
    ? "is a ROS 2 recording of the old sqlite kind: `ros2 bag convert` makes MCAP of it"
    : "is neither a ROS 1 bag nor an MCAP file";
  throw new UserError(`${path}: ${what}`);
}

async function closedOnError(path, file, openFile) {
  try {
    return await openFile(file);
  } catch (error) {
    await file.close();
    throw new UserError(`${path}: cannot be read: cut off or damaged? (${error.message})`);
  }
}

async function firstBytes(path) {
  let file;
  try {
    file = await open(path);
    const { buffer, bytesRead } = await file.read(Buffer.alloc(16), 0, 16, 0);
    return buffer.subarray(0, bytesRead);
  } catch (error) {
    const cause = { ENOENT: "no such file", EISDIR: "is a folder: name the file in it" }[error.code];
    throw new UserError(`${path}: ${cause ?? error.message}`);
  } finally {
    await file?.close();
  }
}

async function openBag(reader) {
  const bag = new Bag(reader, { decompress: await loadDecompressHandlers() });
  await bag.open();
  const counts = new Map();
  for (const chunk of bag.chunkInfos) {
    for (const { conn, count } of chunk.connections) counts.set(conn, (counts.get(conn) ?? 0) + count);
  }
  const topics = new Map();
  for (const [id, connection] of bag.connections) {
    const before = topics.get(connection.topic)?.count ?? 0;
    topics.set(connection.topic, { type: connection.type, count: before + (counts.get(id) ?? 0) });
  }
  return {
    topics,
    async *messages(names) {
      for await (const { topic, timestamp, message } of bag.messageIterator({ topics: names })) {
        yield { topic, logTimeNs: nanoseconds(timestamp), message };
      }
    },
    close: () => reader.close(),
  };
}

async function openMcap(file) {
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(file),
    decompressHandlers: await loadDecompressHandlers(),
  });
  const counts = reader.statistics?.channelMessageCounts ?? new Map();
  const topics = new Map();
  const decoders = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    const before = topics.get(channel.topic)?.count ?? 0;
    topics.set(channel.topic, {
      type: (schema?.name ?? "without a schema").replace("/msg/", "/"),
      count: before + Number(counts.get(channel.id) ?? 0),
    });
    decoders.set(channel.id, () => rosDecoder(channel, schema));
  }
  return {
    topics,
    async *messages(names) {
      const decode = new Map();
      for await (const { channelId, logTime, data } of reader.readMessages({ topics: names })) {
        if (!decode.has(channelId)) decode.set(channelId, decoders.get(channelId)());
        const { topic } = reader.channelsById.get(channelId);
        yield { topic, logTimeNs: logTime, message: decode.get(channelId)(data) };
      }
    },
    close: () => file.close(),
  };
}

/** What makes messages of a channel's bytes. Only called for topics that are wanted. */
function rosDecoder(channel, schema) {
  const encoding = `${channel.messageEncoding} with ${schema?.encoding ?? "no"} schema`;
  const text = () => Buffer.from(schema.data).toString();
  if (encoding === "cdr with ros2msg schema") {
    const reader = new Ros2Reader(parseDefinition(text(), { ros2: true }));
    return (data) => reader.readMessage(data);
  }
  if (encoding === "ros1 with ros1msg schema") {
    const reader = new Ros1Reader(parseDefinition(text()));
    return (data) => reader.readMessage(data);
  }
  throw new UserError(
    `topic ${channel.topic} is encoded as ${encoding}; wanted: cdr with ros2msg or ros1 with ros1msg`,
  );
}

/** Of a ROS time: {sec, nsec} in ROS 1, {sec, nanosec} in ROS 2 (the reader calls it nsec too). */
export const nanoseconds = (time) =>
  BigInt(time.sec) * 1_000_000_000n + BigInt(time.nsec ?? time.nanosec);
