// Topics beside those of lidars' packets, each to the lidar that it is of: RoboSense's of the sensor's state (DIFOP), which its
// decoders learn from, and Ouster's metadata.

import { UserError } from "./command.mjs";
import { LCM_PACKETS } from "./sensor_msgs/from_lcm.mjs";
import { PACKETS, isBesidePackets } from "./sensor_msgs/packets.mjs";

const KINDS = {
  state: {
    isOne: (name, type) => PACKETS.includes(type) && /difop/i.test(name),
    isOf: (type) => !/^(velodyne|ouster|hesai|pandar)/.test(type),
  },
  metadata: {
    isOne: (name, type) => type === "std_msgs/String" && /metadata$/.test(name),
    isOf: (type) => /\/PacketMsg$/.test(type),
  },
};

const namesOf = ({ topics }, isOne) => [...topics].filter(([name, { type }]) => isOne(name, type)).map(([name]) => name);

/** All of them in the recording. */
export const topicsBeside = (recording) => Object.values(KINDS).flatMap(({ isOne }) => namesOf(recording, isOne));

/**
 * @param sensors  those that are taken.
 * @returns {state, metadata}, names of topics, by sensor, for each whose own topic is of packets.
 */
export function siblingsOf(recording, sensors) {
  const senders = sensors.filter(({ topic }) => PACKETS.includes(recording.topics.get(topic).type));
  const odd = sensors.find((sensor) => sensor.beside && !senders.includes(sensor));
  if (odd) throw new UserError(`--topic ${odd.name}=${odd.beside[0]}: ${odd.topic}, which is ${odd.name}'s, is not of packets`);
  const found = new Map(senders.map((sender) => [sender, {}]));
  for (const kind of Object.keys(KINDS)) {
    const owned = ownedOfKind(recording, senders, KINDS[kind]);
    for (const sender of senders) found.get(sender)[kind] = owned.get(sender.topic) ?? [];
  }
  return found;
}

/** Names of one kind by the topic of their sender's packets. */
function ownedOfKind(recording, senders, { isOne, isOf }) {
  const given = new Map(senders.flatMap(({ topic, beside = [] }) => beside.map((name) => [name, topic])));
  const owners = packetTopics(recording, senders).filter((topic) => isOf(recording.topics.get(topic).type));
  const owned = new Map();
  const give = (owner, name) => owned.set(owner, [...(owned.get(owner) ?? []), name]);
  const unclear = [];
  for (const name of namesOf(recording, isOne)) {
    const nearest = given.has(name) ? [given.get(name)] : nearestTo(name, owners);
    if (nearest.length === 1) give(nearest[0], name);
    else unclear.push({ name, nearest });
  }
  for (const each of unclear) requireUnneeded(each, senders, owned);
  return owned;
}

/** Those with points, whether they are taken or not; of LCM, where all bytes are packets, those that are taken. */
function packetTopics(recording, senders) {
  const isTaken = (name) => senders.some(({ topic }) => topic === name);
  const isSender = (name, type) => PACKETS.includes(type) && type !== LCM_PACKETS && !isBesidePackets(name);
  return namesOf(recording, (name, type) => isTaken(name) || isSender(name, type));
}

/** One that may be of several lidars matters if one of those is taken and has none of its own. */
function requireUnneeded({ name, nearest }, senders, owned) {
  const lacking = senders.filter(({ topic }) => nearest.includes(topic) && !owned.has(topic));
  if (lacking.length === 0) return;
  throw new UserError(
    `which lidar's ${name} is, that of ${nearest.join(" or ")}, is not clear: ` +
      `--topic SENSOR=${name} says it, beside --lidar and --camera`,
  );
}

/** The topics that have the longest beginning in common with this name: of whole parts, then of words in the next one. */
function nearestTo(name, topics) {
  const lengths = topics.map((topic) => commonLength(name, topic));
  const longest = Math.max(...lengths);
  return topics.filter((_, i) => lengths[i] === longest);
}

const PART = 1000; // outweighs the words of a part

function commonLength(a, b) {
  const [partsA, partsB] = [a, b].map((name) => name.replace(/^\//, "").split("/"));
  const numParts = numEqual(partsA, partsB);
  const [wordsA, wordsB] = [partsA, partsB].map((parts) => wordsOf(parts[numParts] ?? ""));
  return PART * numParts + numEqual(wordsA, wordsB);
}

/** Not letters: the r of rear_packets does not make it rslidar_difop's, nor is lidar10 one more letter than lidar1. */
const wordsOf = (part) => part.match(/\d+|[A-Z]*[a-z]+|[A-Z]+/g) ?? [];

function numEqual(a, b) {
  const at = a.findIndex((each, i) => each !== b[i]);
  return at < 0 ? a.length : at;
}
