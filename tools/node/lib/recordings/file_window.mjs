// A file read front to back in large pieces, of which short parts are asked for: one system call in
// megabytes, and constant memory.

import { closeSync, openSync, readSync, statSync } from "node:fs";

const WINDOW_BYTES = 4 << 20;

export class FileWindow {
  #file;
  #begin = 0;
  #bytes = Buffer.alloc(0);
  #reused;

  /** @param isReused  bytes hold until others are asked for: nothing is left to be collected. */
  constructor(path, { isReused = false } = {}) {
    this.#file = openSync(path);
    this.numBytes = statSync(path).size;
    if (isReused) this.#reused = Buffer.alloc(0);
  }

  /** The bytes from `offset`, which may be kept unless they are reused; undefined where the file ends before them. */
  at(offset, length) {
    if (offset + length > this.numBytes) return undefined;
    const isHeld = offset >= this.#begin && offset + length <= this.#begin + this.#bytes.length;
    if (!isHeld) this.#read(offset, Math.max(length, WINDOW_BYTES));
    const from = offset - this.#begin;
    return this.#bytes.length < from + length ? undefined : this.#bytes.subarray(from, from + length);
  }

  close() {
    closeSync(this.#file);
  }

  // Into new memory each time, where parts of the old piece may be kept.
  #read(offset, length) {
    const bytes = this.#memory(Math.min(length, this.numBytes - offset));
    let done = 0;
    while (done < bytes.length) {
      const num = readSync(this.#file, bytes, done, bytes.length - done, offset + done);
      if (num === 0) break;
      done += num;
    }
    this.#begin = offset;
    this.#bytes = bytes.subarray(0, done);
  }

  #memory(length) {
    if (!this.#reused) return Buffer.allocUnsafe(length);
    if (this.#reused.length < length) this.#reused = Buffer.allocUnsafe(length);
    return this.#reused.subarray(0, length);
  }
}
