// Recordings of every kind behind one face:
//   topics    Map of name -> {type, count}; type without "msg/": "sensor_msgs/Image"
//   messages  async generator of {topic, logTimeNs, data, decode()} of the topics named, by their log times
//   remarks   what could not be read, in words; complete once `messages` came to its end
//   close
// One of several files is a part: the same, with startNs and isIndexed.

import { closeSync, mkdirSync, mkdtempSync, openSync, readSync, readdirSync, rmSync, statSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { UserError } from "../command.mjs";
import { BAG_MAGIC, openIndexedBag, scanBag } from "./bag.mjs";
import { SQLITE_MAGIC, openDb3 } from "./db3.mjs";
import { LCM_MAGIC, openLcmLog } from "./lcm.mjs";
import { MCAP_MAGIC, openIndexedMcap, scanMcap } from "./mcap.mjs";
import { merged } from "./merged.mjs";
import { ZSTD_MAGIC, unpackFile } from "./zstd.mjs";

const ENDINGS = /\.(bag|bag\.active|mcap|db3|lcm)(\.zstd|\.zst)?$/;
const OTHER_PACKERS = [
  { magic: Buffer.from([0x1f, 0x8b]), remedy: "gunzip" },
  { magic: Buffer.from("BZh"), remedy: "bunzip2" },
  { magic: Buffer.from([0xfd, 0x37, 0x7a, 0x58, 0x5a]), remedy: "unxz" },
  { magic: Buffer.from("PK\x03\x04", "latin1"), remedy: "unzip" },
];

/**
 * Opens one recording of one or more files, or folders of such (as `ros2 bag record` makes them).
 *
 * @param scratchParent  the folder in which files that are compressed are unpacked, as long as they are open.
 * @param isScanning     reads record by record although there is an index: it led to damage.
 * @param lcmTypes       of LCM logs, besides voqcal's own: LcmTypes or undefined.
 * @throws UserError naming file and cause.
 */
export async function openRecording(paths, scratchParent, isScanning = false, lcmTypes = undefined) {
  const scratch = new Scratch(scratchParent);
  const parts = [];
  try {
    for (const path of paths.flatMap(filesOf)) parts.push(await openFile(path, scratch, isScanning, lcmTypes));
  } catch (error) {
    for (const part of parts) await part.close();
    scratch.remove();
    throw error;
  }
  return merged(parts, () => scratch.remove());
}

/** The recording's files: itself, those of a folder, or those beside a metadata.yaml. */
function filesOf(path) {
  const there = statSync(path, { throwIfNoEntry: false });
  if (!there) throw new UserError(`${path}: no such file or folder`);
  if (basename(path) === "metadata.yaml") return filesOf(dirname(path));
  if (!there.isDirectory()) return [path];
  const names = readdirSync(path).filter((name) => ENDINGS.test(name) && !name.startsWith("."));
  // `ros2 bag play` leaves the unpacked file beside the packed one.
  const isUnpackedThere = (name) => names.includes(name.replace(/\.(zstd|zst)$/, "")) && /\.zstd?$/.test(name);
  const files = names.filter((name) => !isUnpackedThere(name));
  files.sort((a, b) => a.localeCompare(b, "en", { numeric: true }));
  if (files.length === 0) throw new UserError(`${path}: is a folder without .bag, .mcap, .db3 or .lcm files`);
  return files.map((name) => join(path, name));
}

async function openFile(path, scratch, isScanning, lcmTypes) {
  const magic = firstBytes(path);
  const startsWith = (wanted) => magic.subarray(0, wanted.length).equals(wanted);
  if (startsWith(ZSTD_MAGIC)) {
    return { ...(await openFile(scratch.unpack(path), scratch, isScanning, lcmTypes)), path };
  }
  const part = await openKind(path, startsWith, isScanning, lcmTypes);
  if (!part) throw new UserError(`${path}: ${whatElse(magic, startsWith)}`);
  if (part.topics.size === 0) {
    const why = (part.remarks ?? []).join("; ");
    throw new UserError(`${path}: has no topics${why === "" ? ": nothing was recorded" : `: it ${why}`}`);
  }
  return { remarks: [], ...part, path };
}

async function openKind(path, startsWith, isScanning, lcmTypes) {
  if (startsWith(BAG_MAGIC)) return (!isScanning && (await openIndexedBag(path))) || scanBag(path);
  if (startsWith(MCAP_MAGIC)) return (!isScanning && (await openIndexedMcap(path))) || scanMcap(path);
  if (startsWith(SQLITE_MAGIC)) return openDb3(path);
  if (startsWith(LCM_MAGIC)) return openLcmLog(path, lcmTypes);
  return undefined;
}

function whatElse(magic, startsWith) {
  if (magic.length === 0) return "is empty";
  const packer = OTHER_PACKERS.find((other) => startsWith(other.magic));
  if (packer) return `is compressed: unpack it first (${packer.remedy})`;
  return "is neither a ROS 1 bag nor a ROS 2 recording (MCAP, sqlite3) nor an LCM log";
}

function firstBytes(path) {
  let file;
  try {
    file = openSync(path);
    const buffer = Buffer.alloc(16);
    return buffer.subarray(0, readSync(file, buffer, 0, 16, 0));
  } catch (error) {
    throw new UserError(`${path}: ${error.message}`);
  } finally {
    if (file !== undefined) closeSync(file);
  }
}

/** A folder for unpacked files, made when the first one is. */
class Scratch {
  #parent;
  #folder;
  #numFiles = 0;

  constructor(parent) {
    this.#parent = parent;
  }

  unpack(path) {
    if (!this.#folder) {
      mkdirSync(this.#parent, { recursive: true });
      this.#folder = mkdtempSync(join(this.#parent, ".unpacked-"));
      process.once("exit", () => this.remove());
    }
    const to = join(this.#folder, String(this.#numFiles++));
    unpackFile(path, to);
    return to;
  }

  remove() {
    if (this.#folder) rmSync(this.#folder, { recursive: true, force: true });
  }
}
