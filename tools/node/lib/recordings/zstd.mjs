// zstd: files are unpacked by its own program, messages by the library that MCAP's chunks need too.

import { spawnSync } from "node:child_process";
import { rmSync } from "node:fs";
import { UserError } from "../command.mjs";

export const ZSTD_MAGIC = Buffer.from([0x28, 0xb5, 0x2f, 0xfd]);

/** The size of what a frame holds, by its header (RFC 8878, 3.1.1.1). */
export function zstdContentBytes(bytes) {
  const flags = bytes[4];
  const isSingleSegment = (flags & 0x20) !== 0;
  const at = 5 + (isSingleSegment ? 0 : 1) + [0, 1, 2, 4][flags & 3];
  switch (flags >> 6) {
    case 0:
      if (!isSingleSegment) throw new UserError("a message is compressed without telling its size");
      return bytes[at];
    case 1:
      return bytes.readUInt16LE(at) + 256;
    case 2:
      return bytes.readUInt32LE(at);
    default:
      return Number(bytes.readBigUInt64LE(at));
  }
}

/** Unpacks a file to `to`. Throws UserError naming the cause; nothing is left then. */
export function unpackFile(path, to) {
  const done = spawnSync("zstd", ["-dqf", path, "-o", to], { encoding: "utf8" });
  if (done.status === 0) return;
  rmSync(to, { force: true });
  const cause = done.error
    ? "is compressed by zstd, which is not installed: `apt install zstd`"
    : `cannot be unpacked: ${done.stderr.trim()}`;
  throw new UserError(`${path}: ${cause}`);
}
