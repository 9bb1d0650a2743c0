// LCM logs of any types: those of lcmtypes/, and those that a folder of .lcm files defines. What a message is, is told
// by its members; it is handed on as the message of ROS that says the same.

import { voqcalTypes } from "../lcm_types.mjs";
import { lcmKind, lcmToRos } from "../sensor_msgs/from_lcm.mjs";
import { Damage } from "./damage.mjs";
import { FileWindow } from "./file_window.mjs";

export const LCM_MAGIC = Buffer.from([0xed, 0xa1, 0xda, 0x01]);
const HEADER_BYTES = 28; // sync word, number i64, time i64 us, lengths of channel and data u32
const MAX_CHANNEL_BYTES = 64;
const SEARCH_BYTES = 1 << 20;

/** Reads what is there up to where the log is cut off; damaged places are left out. @param ownTypes  LcmTypes or undefined. */
export function openLcmLog(path, ownTypes) {
  const known = new KnownTypes([voqcalTypes(), ...(ownTypes ? [ownTypes] : [])]);
  const part = { topics: new Map(), startNs: undefined, isIndexed: false, remarks: [] };
  const counted = new FileWindow(path, { isReused: true });
  for (const { channel, timeUs, data } of events(counted, part.remarks)) {
    const topic = part.topics.get(channel) ?? { type: known.kindOf(data), count: 0 };
    part.topics.set(channel, { ...topic, count: topic.count + 1 });
    part.startNs ??= timeUs * 1000n;
  }
  counted.close();
  const file = new FileWindow(path);
  part.close = () => file.close();
  part.messages = async function* messages(names) {
    for (const { channel, timeUs, data } of events(file, [])) {
      if (!names.includes(channel)) continue;
      yield { topic: channel, logTimeNs: timeUs * 1000n, data, decode: () => known.decode(data) };
    }
  };
  return part;
}

class KnownTypes {
  #byFingerprint = new Map(); // fingerprint -> {types, name}

  constructor(collections) {
    for (const types of collections) {
      for (const name of types.names()) this.#add(types, name);
    }
  }

  /** Of the first message of a channel: a type of ROS, or words. */
  kindOf(data) {
    if (data.length < 8) return "no LCM message";
    const known = this.#byFingerprint.get(data.readBigUInt64BE(0));
    if (!known) return `LCM type 0x${data.toString("hex", 0, 8)}, which is not known: --lcm-types FOLDER defines it`;
    return lcmKind(known.types, known.name) ?? `LCM type ${known.name}`;
  }

  decode(data) {
    const known = data.length < 8 ? undefined : this.#byFingerprint.get(data.readBigUInt64BE(0));
    if (!known) throw new Error("the message is of another type than the channel's first");
    return lcmToRos(known.types.decode(known.name, data));
  }

  #add(types, name) {
    try {
      this.#byFingerprint.set(types.fingerprint(name), { types, name });
    } catch {
      // It has members of a type that is not there.
    }
  }
}

/** Yields {channel, timeUs, data} of each event. */
function* events(file, remarks) {
  const damage = new Damage();
  for (let at = 0; at < file.numBytes; ) {
    const event = eventAt(file, at);
    if (event?.isCut) {
      remarks.push(`is cut off at byte ${at} of ${file.numBytes}: what is before it is read`);
      break;
    }
    if (event) {
      yield event;
      at = event.end;
      continue;
    }
    damage.note("place", at, "no event begins there");
    at = nextSyncWord(file, at + 1);
  }
  remarks.push(...damage.words());
}

/** undefined where none begins. */
function eventAt(file, at) {
  const header = file.at(at, HEADER_BYTES);
  if (!header) return { isCut: true };
  const timeUs = header.readBigInt64BE(12);
  const [channelBytes, dataBytes] = [header.readUInt32BE(20), header.readUInt32BE(24)];
  if (!header.subarray(0, 4).equals(LCM_MAGIC) || channelBytes > MAX_CHANNEL_BYTES) return undefined;
  const rest = file.at(at + HEADER_BYTES, channelBytes + dataBytes);
  if (!rest) return nextSyncWord(file, at + 1) < file.numBytes ? undefined : { isCut: true };
  const end = at + HEADER_BYTES + rest.length;
  return { channel: rest.toString("utf8", 0, channelBytes), timeUs, data: rest.subarray(channelBytes), end };
}

function nextSyncWord(file, from) {
  for (let at = from; at < file.numBytes; at += SEARCH_BYTES) {
    const found = file.at(at, Math.min(SEARCH_BYTES + 3, file.numBytes - at)).indexOf(LCM_MAGIC);
    if (found >= 0) return at + found;
  }
  return file.numBytes;
}
