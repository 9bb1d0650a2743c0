// LCM logs: events of sync word u32, number i64, time i64 us, channel length u32, data length u32,
// channel, data; all big-endian (LCM 1.3.1, lcm/eventlog.c).

import { closeSync, openSync, readSync, renameSync, rmSync, statSync, writeSync, writevSync } from "node:fs";
import { UserError } from "./command.mjs";

const SYNC_WORD = 0xeda1da01;
const HEADER_BYTES = 28;

/** Yields {utime: BigInt, channel, bytes} of each event. */
export function* readLog(path) {
  const file = open(path, "r");
  const numBytes = statSync(path).size;
  const read = (length, offset) => {
    const buffer = Buffer.alloc(length);
    if (offset + length > numBytes || readSync(file, buffer, 0, length, offset) < length) {
      throw new UserError(`${path}: byte ${offset}: the LCM log is cut off here`);
    }
    return buffer;
  };
  try {
    for (let offset = 0; offset < numBytes; ) {
      const header = read(HEADER_BYTES, offset);
      if (header.readUInt32BE(0) !== SYNC_WORD) {
        throw new UserError(`${path}: byte ${offset}: no LCM log event begins here`);
      }
      const channelBytes = header.readUInt32BE(20);
      const dataBytes = header.readUInt32BE(24);
      const rest = read(channelBytes + dataBytes, offset + HEADER_BYTES);
      offset += HEADER_BYTES + rest.length;
      yield {
        utime: header.readBigInt64BE(12),
        channel: rest.subarray(0, channelBytes).toString(),
        bytes: rest.subarray(channelBytes),
      };
    }
  } finally {
    closeSync(file);
  }
}

/** Writes a log whole or not at all: it has its name only once `finish` was called. */
export class LogWriter {
  #path;
  #file;
  #numEvents = 0n;
  #remove = () => rmSync(this.#unfinished(), { force: true });

  constructor(path) {
    this.#path = path;
    this.#file = open(this.#unfinished(), "w");
    process.once("exit", this.#remove);
  }

  /** @param bytes  the encoded message, in one piece or several. */
  write(utime, channel, bytes) {
    const pieces = [bytes].flat();
    const name = Buffer.from(channel);
    const header = Buffer.alloc(HEADER_BYTES);
    header.writeUInt32BE(SYNC_WORD, 0);
    header.writeBigInt64BE(this.#numEvents++, 4);
    header.writeBigInt64BE(utime, 12);
    header.writeUInt32BE(name.length, 20);
    header.writeUInt32BE(pieces.reduce((sum, { length }) => sum + length, 0), 24);
    this.#writeAll([Buffer.concat([header, name]), ...pieces]);
  }

  finish() {
    closeSync(this.#file);
    renameSync(this.#unfinished(), this.#path);
    process.off("exit", this.#remove);
  }

  abandon() {
    closeSync(this.#file);
    this.#remove();
    process.off("exit", this.#remove);
  }

  #writeAll(pieces) {
    let done = writevSync(this.#file, pieces);
    for (const piece of pieces) {
      while (done < piece.length) done += writeSync(this.#file, piece, done); // a disk that is nearly full
      done -= piece.length;
    }
  }

  #unfinished() {
    return `${this.#path}.unfinished-${process.pid}`;
  }
}

function open(path, flags) {
  try {
    return openSync(path, flags);
  } catch (error) {
    throw new UserError(`${path}: ${error.code === "ENOENT" ? "no such file or folder" : error.message}`);
  }
}
