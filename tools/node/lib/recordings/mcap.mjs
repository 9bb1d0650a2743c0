// MCAP files: by their index where they have one, else record by record (mcap.dev/spec).

import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";
import { UserError } from "../command.mjs";
import { FileWindow } from "./file_window.mjs";
import { plainType, ros1Decoder, ros2Decoder } from "./message_decoders.mjs";

const { crc32 } = createRequire(import.meta.url)("@foxglove/crc");

export const MCAP_MAGIC = Buffer.from("\x89MCAP0\r\n", "latin1");
const OP = { SCHEMA: 3, CHANNEL: 4, MESSAGE: 5, CHUNK: 6, DATA_END: 15 };

/** Opens by the index; undefined where there is none, or it lacks chunks, channels or their types. */
export async function openIndexedMcap(path) {
  const file = await open(path);
  try {
    const decompressHandlers = await loadDecompressHandlers();
    const readable = new FileHandleReadable(file);
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    if (hasWholeIndex(reader)) return indexedMcap(reader, file);
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

function indexedMcap(reader, file) {
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
    async *messages(names) {
      for await (const { channelId, logTime, data } of reader.readMessages({ topics: names })) {
        yield channels.message(channelId, logTime, data);
      }
    },
    close: () => file.close(),
  };
}

/** Reads what is there up to where the file ends or is damaged; a damaged chunk is left out. */
export async function scanMcap(path) {
  const decompress = await loadDecompressHandlers();
  const file = new FileWindow(path);
  const channels = new Channels();
  const part = {
    topics: channels.topics,
    startNs: undefined,
    isIndexed: false,
    remarks: [],
    close: () => file.close(),
  };
  for (const { channelId, logTime } of scannedMessages(file, decompress, channels, part.remarks, true)) {
    channels.count(channelId);
    if (part.startNs === undefined || logTime < part.startNs) part.startNs = logTime;
  }
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
  const inChunk = (bytes, at, isCut) =>
    inOrder(chunkMessages(bytes, at, isCut, decompress, channels, remarks));
  for (let at = MCAP_MAGIC.length; ; ) {
    const head = file.at(at, 9);
    const opcode = head?.readUInt8(0);
    if (opcode === OP.DATA_END) return;
    const length = head && Number(head.readBigUInt64LE(1));
    if (head === undefined || opcode === 0 || at + 9 + length > file.numBytes) {
      remarks.push(
        at === file.numBytes
          ? "was not closed by its recorder: all of it is read"
          : `is cut off or damaged at byte ${at} of ${file.numBytes}: what is before it is read`,
      );
      if (opcode === OP.CHUNK) yield* inChunk(file.at(at + 9, file.numBytes - at - 9), at, true);
      return;
    }
    const begin = at + 9;
    at = begin + length;
    if (opcode === OP.CHUNK) yield* inChunk(file.at(begin, length), begin, false);
    else if (opcode === OP.MESSAGE && isCounting) yield messageOf(file.at(begin, Math.min(length, 22)));
    else if (opcode <= OP.MESSAGE) yield* take(opcode, file.at(begin, length), channels);
  }
}

const inOrder = (messages) => [...messages].sort((a, b) => Number(a.logTime - b.logTime));

/** Schema id, channel or message of one record. */
function* take(opcode, bytes, channels) {
  if (opcode === OP.SCHEMA) channels.addSchema(schemaOf(bytes));
  if (opcode === OP.CHANNEL) channels.add(channelOf(bytes), 0);
  if (opcode !== OP.MESSAGE) return;
  const message = messageOf(bytes);
  if (channels.topicOf(message.channelId) !== undefined) yield message;
}

/** Of a chunk that is cut off: what is before the cut, where it is not compressed. */
function* chunkMessages(bytes, offset, isCut, decompress, channels, remarks) {
  let records;
  try {
    records = chunkRecords(bytes, decompress, isCut);
  } catch (error) {
    if (!isCut) remarks.push(`the chunk at byte ${offset} is damaged and left out (${error.message})`);
    return;
  }
  for (let at = 0; at + 9 <= records.length; ) {
    const length = Number(records.readBigUInt64LE(at + 1));
    if (at + 9 + length > records.length) return;
    yield* take(records[at], records.subarray(at + 9, at + 9 + length), channels);
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
  return { value: bytes.toString("utf8", at + 4, end), end };
}

function schemaOf(bytes) {
  const name = text(bytes, 2);
  const encoding = text(bytes, name.end);
  const data = bytes.subarray(encoding.end + 4, encoding.end + 4 + bytes.readUInt32LE(encoding.end));
  return { id: bytes.readUInt16LE(0), name: name.value, encoding: encoding.value, data };
}

function channelOf(bytes) {
  const topic = text(bytes, 4);
  const messageEncoding = text(bytes, topic.end).value;
  return { id: bytes.readUInt16LE(0), schemaId: bytes.readUInt16LE(2), topic: topic.value, messageEncoding };
}

const messageOf = (bytes) => ({
  channelId: bytes.readUInt16LE(0),
  logTime: bytes.readBigUInt64LE(6),
  data: bytes.subarray(22),
});
