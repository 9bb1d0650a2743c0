// MCAP files: by their index where they have one, else record by record (mcap.dev/spec).

import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import zlib from "node:zlib";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";
import { UserError } from "../command.mjs";
import { Damage } from "./damage.mjs";
import { FileWindow } from "./file_window.mjs";
import { plainType, ros1Decoder, ros2Decoder } from "./message_decoders.mjs";

// Node.js' own from version 20.15 on is ten times as fast.
const crc32 = zlib.crc32 ?? createRequire(import.meta.url)("@foxglove/crc").crc32;

export const MCAP_MAGIC = Buffer.from("\x89MCAP0\r\n", "latin1");
const MESSAGE_HEAD_BYTES = 22;
const MIN_BYTES = 14; // of a schema, the shortest of what is looked for
const OP = { SCHEMA: 3, CHANNEL: 4, MESSAGE: 5, CHUNK: 6, DATA_END: 15 };

/** Opens by the index; undefined where there is none, or it lacks chunks, channels or their types. */
export async function openIndexedMcap(path) {
  const file = await open(path);
  try {
    const decompressHandlers = await loadDecompressHandlers();
    const readable = new FileHandleReadable(file);
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    if (hasWholeIndex(reader)) return indexedMcap(reader, file, path);
  } catch {
    // The scan says what is wrong.
  }
  await file.close();
  return undefined;
}

function hasWholeIndex({ chunkIndexes, channelsById, schemasById }) {
  const channels = [...channelsById.values()];
  const isKnown = ({ schemaId }) => schemaId === 0 || schemasById.has(schemaId);
  return chunkIndexes.length > 0 && channels.length > 0 && channels.every(isKnown);
}

/** Whether the chunks lie in the file in the order of their times, none before the last one's end. */
function isInOrder(chunkIndexes) {
  const byPlace = [...chunkIndexes].sort((a, b) => Number(a.chunkStartOffset - b.chunkStartOffset));
  return byPlace.every(({ messageStartTime }, i) => i === 0 || messageStartTime >= byPlace[i - 1].messageEndTime);
}

function indexedMcap(reader, file, path) {
  const counts = reader.statistics?.channelMessageCounts ?? new Map();
  const channels = new Channels();
  for (const schema of reader.schemasById.values()) channels.addSchema(schema);
  for (const channel of reader.channelsById.values()) {
    channels.add(channel, Number(counts.get(channel.id) ?? 0));
  }
  return {
    topics: channels.topics,
    startNs: reader.chunkIndexes.reduce(
      (least, { messageStartTime: time }) => (time < least ? time : least),
      reader.chunkIndexes[0].messageStartTime,
    ),
    isIndexed: true,
    // Front to back where that is the order of time: twice as fast.
    messages: (names) => (isInOrder(reader.chunkIndexes) ? inFilesOrder(path, channels, names) : byIndex(reader, channels, names)),
    close: () => file.close(),
  };
}

async function* byIndex(reader, channels, names) {
  for await (const { channelId, logTime, data } of reader.readMessages({ topics: names })) {
    yield channels.message(channelId, logTime, data);
  }
}

/** @throws where there is damage, which the index knows nothing of. */
async function* inFilesOrder(path, channels, names) {
  const file = new FileWindow(path);
  const remarks = [];
  try {
    const decompress = await loadDecompressHandlers();
    for (const { channelId, logTime, data } of scannedMessages(file, decompress, channels, remarks, false)) {
      if (names.includes(channels.topicOf(channelId))) yield channels.message(channelId, logTime, data);
    }
  } finally {
    file.close();
  }
  if (remarks.length > 0) throw new Error(remarks.join("; "));
}

/** Reads what is there up to where the file ends or is damaged; a damaged chunk is left out. */
export async function scanMcap(path) {
  const decompress = await loadDecompressHandlers();
  const channels = new Channels();
  const part = { topics: channels.topics, startNs: undefined, isIndexed: false, remarks: [] };
  const counted = new FileWindow(path, { isReused: true });
  for (const { channelId, logTime } of scannedMessages(counted, decompress, channels, part.remarks, true)) {
    channels.count(channelId);
    if (part.startNs === undefined || logTime < part.startNs) part.startNs = logTime;
  }
  counted.close();
  const file = new FileWindow(path);
  part.close = () => file.close();
  part.messages = async function* messages(names) {
    for (const { channelId, logTime, data } of scannedMessages(file, decompress, channels, [], false)) {
      if (names.includes(channels.topicOf(channelId))) yield channels.message(channelId, logTime, data);
    }
  };
  return part;
}

/** Channels by their number, and the topics that they make. */
class Channels {
  topics = new Map();
  #schemas = new Map();
  #channels = new Map();

  addSchema(schema) {
    this.#schemas.set(schema.id, schema);
  }

  add(channel, count) {
    if (this.#channels.has(channel.id)) return;
    const schema = this.#schemas.get(channel.schemaId);
    this.#channels.set(channel.id, { ...channel, schema });
    const there = this.topics.get(channel.topic);
    const type = plainType(schema?.name ?? "without a schema");
    this.topics.set(channel.topic, { type, count: (there?.count ?? 0) + count });
  }

  topicOf(id) {
    return this.#channels.get(id)?.topic;
  }

  count(id) {
    const topic = this.topics.get(this.topicOf(id));
    if (topic) ++topic.count;
  }

  message(id, logTimeNs, data) {
    const channel = this.#channels.get(id);
    return { topic: channel.topic, logTimeNs, data, decode: () => this.#decoder(channel)(data) };
  }

  #decoder(channel) {
    channel.decode ??= rosDecoder(channel);
    return channel.decode;
  }
}

function rosDecoder({ topic, messageEncoding, schema }) {
  const encoding = `${messageEncoding} with ${schema?.encoding ?? "no"} schema`;
  const definition = () => Buffer.from(schema.data).toString();
  if (encoding === "cdr with ros2msg schema") return ros2Decoder(schema.name, definition());
  if (encoding === "ros1 with ros1msg schema") return ros1Decoder(definition());
  throw new UserError(
    `topic ${topic} is encoded as ${encoding}; wanted: cdr with ros2msg or ros1 with ros1msg`,
  );
}

/** Every message in the order of the file, each chunk's by time. Without data if `isCounting`. */
function* scannedMessages(file, decompress, channels, remarks, isCounting) {
  const damage = new Damage();
  const inChunk = (bytes, at, isCut) =>
    inOrder(chunkMessages(bytes, at, isCut, decompress, channels, damage));
  for (let at = MCAP_MAGIC.length; ; ) {
    const { opcode, begin, end } = recordAt(file, at) ?? {};
    if (opcode === OP.DATA_END) break;
    if (begin === undefined) {
      const next = wholeRecordAfter(file, at, channels);
      if (next === undefined) {
        remarks.push(endsWithout(file, at));
        if (file.at(at, 9)?.readUInt8(0) === OP.CHUNK) yield* inChunk(file.at(at + 9, file.numBytes - at - 9), at, true);
        break;
      }
      damage.note("stretch", at, `${next - at} bytes are no record`);
      at = next;
      continue;
    }
    if (opcode === OP.CHUNK) yield* inChunk(file.at(begin, end - begin), at, false);
    else if (opcode <= OP.MESSAGE) {
      const isLight = isCounting && opcode === OP.MESSAGE;
      yield* take(opcode, file.at(begin, Math.min(end - begin, isLight ? MESSAGE_HEAD_BYTES : Infinity)), at, channels, damage);
    }
    at = end;
  }
  remarks.push(...damage.words());
}

/** What stands at `at`: a record whose end is in the file; undefined if none does. */
function recordAt(file, at) {
  const head = file.at(at, 9);
  const opcode = head?.readUInt8(0);
  const end = head && at + 9 + Number(head.readBigUInt64LE(1));
  return opcode > 0 && end <= file.numBytes ? { opcode, begin: at + 9, end } : undefined;
}

/** Where, after damage, records go on: at one whose sizes add up and that another follows. */
function wholeRecordAfter(file, damagedAt, channels) {
  const isInChunk = file.at(damagedAt, 1)?.readUInt8(0) === OP.CHUNK; // other records are no records of the file there
  for (let at = damagedAt + 1; at + 9 < file.numBytes; ++at) {
    const opcode = file.at(at, 1).readUInt8(0);
    if (opcode < OP.SCHEMA || opcode > OP.CHUNK || (isInChunk && opcode !== OP.CHUNK)) continue;
    const { begin, end } = recordAt(file, at) ?? {};
    if (begin === undefined || end - begin < MIN_BYTES) continue;
    const head = file.at(begin, Math.min(end - begin, 400)); // names are shorter
    if (isWhole(opcode, head, end - begin, channels) && isFollowed(file, end)) return at;
  }
  return undefined;
}

const isFollowed = (file, end) => end === file.numBytes || recordAt(file, end)?.opcode <= OP.DATA_END;

/** Whether a record's sizes add up to `numBytes`. */
function isWhole(opcode, head, numBytes, channels) {
  try {
    switch (opcode) {
      case OP.SCHEMA: // id, name, encoding, data
        return endOfTexts(head, 2, 3) === numBytes;
      case OP.CHANNEL: // id, schema, topic, encoding, metadata
        return endOfTexts(head, 4, 3) === numBytes;
      case OP.MESSAGE:
        return numBytes >= MESSAGE_HEAD_BYTES && channels.topicOf(head.readUInt16LE(0)) !== undefined;
      default: {
        const at = endOfTexts(head, 28, 1);
        return at + 8 + Number(head.readBigUInt64LE(at)) === numBytes;
      }
    }
  } catch {
    return false;
  }
}

function endOfTexts(bytes, at, num) {
  for (let i = 0; i < num; ++i) at += 4 + bytes.readUInt32LE(at);
  return at;
}

const endsWithout = (file, at) =>
  at === file.numBytes
    ? "was not closed by its recorder: all of it is read"
    : `is cut off or damaged at byte ${at} of ${file.numBytes}: what is before it is read`;

const inOrder = (messages) => [...messages].sort((a, b) => Number(a.logTime - b.logTime));

/** Schema, channel or message of one record, which may be damaged. */
function* take(opcode, bytes, at, channels, damage) {
  let message;
  try {
    if (opcode === OP.SCHEMA) channels.addSchema(schemaOf(bytes));
    if (opcode === OP.CHANNEL) channels.add(channelOf(bytes), 0);
    if (opcode === OP.MESSAGE) message = messageOf(bytes);
  } catch (error) {
    damage.note("record", at, error.message);
    return;
  }
  if (message && channels.topicOf(message.channelId) !== undefined) yield message;
}

/** Of a chunk that is cut off: what is before the cut, where it is not compressed. */
function* chunkMessages(bytes, offset, isCut, decompress, channels, damage) {
  let records;
  try {
    records = chunkRecords(bytes, decompress, isCut);
  } catch (error) {
    if (!isCut) damage.note("chunk", offset, error.message);
    return;
  }
  for (let at = 0; at + 9 <= records.length; ) {
    const length = Number(records.readBigUInt64LE(at + 1));
    if (at + 9 + length > records.length) return;
    yield* take(records[at], records.subarray(at + 9, at + 9 + length), offset, channels, damage);
    at += 9 + length;
  }
}

/** Chunk: start, end and size u64, CRC u32, name of the compression, records. */
function chunkRecords(bytes, decompress, isCut) {
  const numBytes = bytes.readBigUInt64LE(16);
  const crc = bytes.readUInt32LE(24);
  const compression = text(bytes, 28);
  const begin = compression.end + 8;
  const packed = bytes.subarray(begin, begin + Number(bytes.readBigUInt64LE(compression.end)));
  if (compression.value !== "" && !decompress[compression.value]) {
    throw new Error(`compressed by '${compression.value}'`);
  }
  const records = compression.value === "" ? packed : decompress[compression.value](packed, numBytes);
  if (!isCut && crc !== 0 && crc32(records) !== crc) throw new Error("its checksum is another");
  return Buffer.from(records.buffer, records.byteOffset, records.byteLength);
}

/** A text of MCAP, its length before it, and where it ends. */
function text(bytes, at) {
  const end = at + 4 + bytes.readUInt32LE(at);
  if (end > bytes.length) throw new Error("it names more bytes than it has");
  return { value: bytes.toString("utf8", at + 4, end), end };
}

function schemaOf(bytes) {
  const name = text(bytes, 2);
  const encoding = text(bytes, name.end);
  const data = bytes.subarray(encoding.end + 4, encoding.end + 4 + bytes.readUInt32LE(encoding.end));
  return { id: bytes.readUInt16LE(0), name: name.value, encoding: encoding.value, data: Buffer.from(data) };
}

function channelOf(bytes) {
  const topic = text(bytes, 4);
  const messageEncoding = text(bytes, topic.end).value;
  return { id: bytes.readUInt16LE(0), schemaId: bytes.readUInt16LE(2), topic: topic.value, messageEncoding };
}

const messageOf = (bytes) => ({
  channelId: bytes.readUInt16LE(0),
  logTime: bytes.readBigUInt64LE(6),
  data: bytes.subarray(MESSAGE_HEAD_BYTES),
});
