// ROS 1 bags: by their index where they have one, else record by record (wiki.ros.org/Bags/Format/2.0).

import { createRequire } from "node:module";
import { loadDecompressHandlers } from "@mcap/support";
import { Damage } from "./damage.mjs";
import { FileWindow } from "./file_window.mjs";
import { plainType, ros1Decoder } from "./message_decoders.mjs";

const require = createRequire(import.meta.url);
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");

export const BAG_MAGIC = Buffer.from("#ROSBAG V2.0\n");
const OP = { MESSAGE: 2, CHUNK: 5, CONNECTION: 7 };

const nanoseconds = ({ sec, nsec }) => BigInt(sec) * 1_000_000_000n + BigInt(nsec);

/** Opens by the index; undefined where the recorder left none. */
export async function openIndexedBag(path) {
  if (!hasIndex(path)) return undefined;
  const reader = new FileReader(path);
  try {
    const bag = new Bag(reader, { decompress: await loadDecompressHandlers(), parse: false });
    await bag.open();
    if (bag.chunkInfos.length > 0) return indexedBag(bag, reader, path);
  } catch {
    // The scan says what is wrong.
  }
  await reader.close();
  return undefined;
}

/** Whether the bag's header tells of an index: without one, the library would hold the whole file to look for it. */
function hasIndex(path) {
  const file = new FileWindow(path, { isReused: true });
  try {
    const header = recordAt((from, length) => file.at(from, length), BAG_MAGIC.length);
    const position = Number(header?.fields.index_pos?.readBigUInt64LE(0) ?? 0);
    return position > 0 && position < file.numBytes;
  } catch {
    return false;
  } finally {
    file.close();
  }
}

/** Whether the chunks lie in the file in the order of their times, none before the last one's end. */
function isInOrder(chunkInfos) {
  const byPlace = [...chunkInfos].sort((a, b) => a.chunkPosition - b.chunkPosition);
  return byPlace.every(({ startTime }, i) => i === 0 || nanoseconds(startTime) >= nanoseconds(byPlace[i - 1].endTime));
}

function indexedBag(bag, reader, path) {
  const connections = new Connections();
  for (const [id, { topic, type, messageDefinition }] of bag.connections) {
    connections.add({ id, topic, type, definition: messageDefinition });
  }
  for (const chunk of bag.chunkInfos) {
    for (const { conn, count } of chunk.connections) connections.count(conn, count);
  }
  return {
    topics: connections.topics,
    startNs: nanoseconds(bag.startTime),
    isIndexed: true,
    // Front to back where that is the order of time: twice as fast.
    messages: (names) => (isInOrder(bag.chunkInfos) ? inFilesOrder(path, connections, names) : byIndex(bag, connections, names)),
    close: () => reader.close(),
  };
}

async function* byIndex(bag, connections, names) {
  for await (const { connectionId, timestamp, data } of bag.messageIterator({ topics: names })) {
    yield connections.message(connectionId, nanoseconds(timestamp), data);
  }
}

/** @throws where there is damage, which the index knows nothing of. */
async function* inFilesOrder(path, connections, names) {
  const file = new FileWindow(path);
  const remarks = [];
  try {
    const decompress = await loadDecompressHandlers();
    for (const { id, logTimeNs, data } of scannedMessages(file, decompress, connections, remarks)) {
      if (names.includes(connections.topicOf(id))) yield connections.message(id, logTimeNs, data);
    }
  } finally {
    file.close();
  }
  if (remarks.length > 0) throw new Error(remarks.join("; "));
}

/** Reads what is there up to where the file ends or is damaged; a damaged chunk is left out. */
export async function scanBag(path) {
  const decompress = await loadDecompressHandlers();
  const connections = new Connections();
  const part = { topics: connections.topics, startNs: undefined, isIndexed: false, remarks: [] };
  const counted = new FileWindow(path, { isReused: true });
  for (const { id, logTimeNs } of scannedMessages(counted, decompress, connections, part.remarks)) {
    connections.count(id, 1);
    if (part.startNs === undefined || logTimeNs < part.startNs) part.startNs = logTimeNs;
  }
  counted.close();
  const file = new FileWindow(path);
  part.close = () => file.close();
  part.messages = async function* messages(names) {
    for (const { id, logTimeNs, data } of scannedMessages(file, decompress, connections, [])) {
      if (names.includes(connections.topicOf(id))) yield connections.message(id, logTimeNs, data);
    }
  };
  return part;
}

/** Connections by their number, and the topics that they make. */
class Connections {
  topics = new Map();
  #connections = new Map();

  add(connection) {
    if (this.#connections.has(connection.id)) return;
    this.#connections.set(connection.id, connection);
    const { topic, type } = connection;
    if (!this.topics.has(topic)) this.topics.set(topic, { type: plainType(type), count: 0 });
  }

  topicOf(id) {
    return this.#connections.get(id)?.topic;
  }

  count(id, num) {
    const topic = this.topics.get(this.topicOf(id));
    if (topic) topic.count += num;
  }

  message(id, logTimeNs, data) {
    const connection = this.#connections.get(id);
    const decode = () => (connection.decode ??= ros1Decoder(connection.definition))(data);
    return { topic: connection.topic, logTimeNs, data, decode };
  }
}

/** What there is of the record at a file's end; undefined where not even its header is whole. */
function cutRecordAt(file, at) {
  try {
    return recordAt((from, length) => file.at(from, Math.min(length, file.numBytes - from)), at);
  } catch {
    return undefined;
  }
}

/** Every message in the order of the file, each chunk's by time. */
function* scannedMessages(file, decompress, connections, remarks) {
  const damage = new Damage();
  for (let at = BAG_MAGIC.length; at < file.numBytes; ) {
    const record = recordAt((from, length) => file.at(from, length), at);
    if (record === undefined) {
      remarks.push(`is cut off or damaged at byte ${at} of ${file.numBytes}: what is before it is read`);
      const cut = cutRecordAt(file, at);
      if (cut?.op === OP.CHUNK) yield* inOrder(chunkMessages(cut, at, decompress, connections, new Damage()));
      break;
    }
    if (record.op === OP.CHUNK) yield* inOrder(chunkMessages(record, at, decompress, connections, damage));
    else yield* take(record, at, connections, damage);
    at = record.end;
  }
  remarks.push(...damage.words());
}

const inOrder = (messages) => [...messages].sort((a, b) => Number(a.logTimeNs - b.logTimeNs));

/** Connection or message of one record, which may be damaged. */
function* take({ op, fields, data }, at, connections, damage) {
  let message;
  try {
    if (op === OP.CONNECTION) connections.add(connectionOf(fields, data));
    if (op === OP.MESSAGE) message = messageOf(fields, data);
  } catch (error) {
    damage.note("record", at, error.message);
    return;
  }
  if (message && connections.topicOf(message.id) !== undefined) yield message;
}

function requireFields(fields, names) {
  const missing = names.filter((name) => fields[name] === undefined);
  if (missing.length > 0) throw new Error(`it has no ${missing.join(", ")}`);
}

function connectionOf(fields, data) {
  const about = fieldsOf(data) ?? {};
  requireFields({ ...about, ...fields }, ["conn", "topic", "type", "message_definition"]);
  return {
    id: fields.conn.readUInt32LE(0),
    topic: fields.topic.toString(),
    type: about.type.toString(),
    definition: about.message_definition.toString(),
  };
}

function messageOf(fields, data) {
  requireFields(fields, ["conn", "time"]);
  const time = { sec: fields.time.readUInt32LE(0), nsec: fields.time.readUInt32LE(4) };
  return { id: fields.conn.readUInt32LE(0), logTimeNs: nanoseconds(time), data };
}

/** Of a chunk that is damaged: what is before the damage. */
function* chunkMessages({ fields, data }, offset, decompress, connections, damage) {
  try {
    const compression = fields.compression.toString();
    const bytes = compression === "none" ? data : decompress[compression](data, fields.size.readUInt32LE(0));
    const records = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const slice = (from, length) =>
      from + length > records.length ? undefined : records.subarray(from, from + length);
    for (let at = 0; at < records.length; ) {
      const record = recordAt(slice, at);
      if (record === undefined) throw new Error(`ends within a record, at its byte ${at}`);
      yield* take(record, offset, connections, damage);
      at = record.end;
    }
  } catch (error) {
    damage.note("chunk", offset, error.message);
  }
}

/** Length u32 and header, length u32 and data; undefined where they are cut off or none. */
function recordAt(bytesAt, at) {
  const headBytes = bytesAt(at, 4)?.readUInt32LE(0);
  if (headBytes === undefined) return undefined;
  const head = bytesAt(at + 4, headBytes);
  const fields = fieldsOf(head && Buffer.from(head)); // its place may be read anew for the data
  const dataBytes = bytesAt(at + 4 + headBytes, 4)?.readUInt32LE(0);
  if (fields?.op?.length !== 1 || dataBytes === undefined) return undefined;
  const data = bytesAt(at + 8 + headBytes, dataBytes);
  return data && { op: fields.op[0], fields, data, end: at + 8 + headBytes + dataBytes };
}

/** Fields: length u32, then "name=value"; undefined if they are none. */
function fieldsOf(bytes) {
  const fields = {};
  for (let at = 0; bytes && at < bytes.length; ) {
    const end = at + 4 <= bytes.length ? at + 4 + bytes.readUInt32LE(at) : Infinity;
    const equals = bytes.indexOf("=", at + 4);
    if (end > bytes.length || equals < 0 || equals >= end) return undefined;
    fields[bytes.toString("latin1", at + 4, equals)] = bytes.subarray(equals + 1, end);
    at = end;
  }
  return bytes && fields;
}
