// Which topic of a recording is which sensor's: {name, kind, channel, topic} each, of a pair or of a rig's several; with
// `beside`, the topics without points that were given to it by name.

import { UserError } from "./command.mjs";
import { topicsBeside } from "./packet_siblings.mjs";
import { CLOUDS, IMAGES } from "./sensor_msgs/messages.mjs";
import { PACKETS, isBesidePackets } from "./sensor_msgs/packets.mjs";

const KIND_WORDS = { lidar: "lidars", image: "cameras" };

/** The topic that was asked for, or the only one of these types. */
export function chooseTopic(recording, flag, wanted, types, preferred) {
  const candidates = topicsOfTypes(recording, types);
  for (const name of [wanted, wanted && `/${wanted}`]) if (candidates.includes(name)) return name;
  if (wanted === undefined && candidates.length === 1) return candidates[0];
  if (wanted === undefined && candidates.includes(preferred)) return preferred;
  const what = wanted === undefined ? `${candidates.length} topics` : `no topic ${wanted}`;
  throw new UserError(
    `has ${what} of type ${types.join(" or ")} (--${flag} names one); it has ${topicsThere(recording)}`,
  );
}

function topicsOfTypes({ topics }, types) {
  const isAside = (name) => PACKETS.includes(topics.get(name).type) && isBesidePackets(name);
  const isRight = (name) => types.includes(topics.get(name).type) && !name.endsWith("/compressedDepth") && !isAside(name);
  return [...topics.keys()].filter(isRight);
}

const topicsThere = ({ topics }) =>
  [...topics].map(([name, { type, count }]) => `${name} (${type}, ${count})`).sort().join(", ");

/** The sensors that the flags name, each with its topic; lidars first. */
export function sensorsOf(recording, flags) {
  return flags.lidar || flags.camera ? sensorsByName(recording, flags) : pairOf(recording, flags);
}

function pairOf(recording, flags) {
  if (flags.topic) throw new UserError("--topic is of a sensor that --lidar or --camera names");
  const sensor = (kind, name, types) => {
    const channel = flags[`${kind}-channel`];
    return { kind, name, channel, topic: chooseTopic(recording, `${kind}-topic`, flags[`${kind}-topic`], types, channel) };
  };
  const lidars = flags["images-only"] ? [] : [sensor("lidar", "lidar", lidarTypes(recording, flags["lidar-topic"]))];
  return [...lidars, sensor("image", "camera", IMAGES)];
}

/** Clouds; packets where there are none, or a topic is asked for by name. */
function lidarTypes(recording, wanted) {
  if (wanted !== undefined) return [...CLOUDS, ...PACKETS];
  const there = [...recording.topics.values()].map(({ type }) => type);
  const hasPackets = there.some((type) => PACKETS.includes(type));
  return there.some((type) => CLOUDS.includes(type)) || !hasPackets ? CLOUDS : PACKETS;
}

function sensorsByName(recording, flags) {
  for (const flag of ["lidar-topic", "image-topic", "images-only"]) {
    if (flags[flag]) throw new UserError(`--${flag} is of a pair: beside --lidar and --camera, --topic SENSOR=NAME says it`);
  }
  if (flags["camera-info-topic"]) {
    throw new UserError("--camera-info-topic is of a pair: beside --lidar and --camera no CameraInfo goes into the log (--print-camera prints it)");
  }
  const sensors = [
    ...namedBy("lidar", flags.lidar).map(([name, channel]) => ({ kind: "lidar", name, channel })),
    ...namedBy("camera", flags.camera).map(([name, channel]) => ({ kind: "image", name, channel })),
  ];
  giveTopics(recording, sensors, namedBy("topic", flags.topic));
  for (const kind of Object.keys(KIND_WORDS)) matchTopics(recording, sensors, kind);
  return sensors;
}

/** Of flags NAME=VALUE. */
function namedBy(flag, values = []) {
  return values.map((value) => {
    const [, name, rest] = /^([^=]+)=(.+)$/.exec(value) ?? [];
    if (name === undefined) throw new UserError(`--${flag} must be SENSOR=NAME, is ${value}`);
    return [name, rest];
  });
}

function giveTopics(recording, sensors, given) {
  for (const [name, topic] of given) {
    const sensor = sensors.find((each) => each.name === name);
    if (!sensor) {
      throw new UserError(`--topic ${name}=${topic}: no sensor ${name}; there are ${sensors.map((each) => each.name).join(", ")}`);
    }
    const taken = giveTopic(recording, sensor, topic);
    const other = sensors.find((each) => each !== sensor && [each.topic, ...(each.beside ?? [])].includes(taken));
    if (other) throw new UserError(`--topic ${name}=${topic}: ${taken} is given to ${other.name} too`);
  }
}

/** @returns the topic's full name. */
function giveTopic(recording, sensor, topic) {
  const beside = topicsBeside(recording).find((each) => each === topic || each === `/${topic}`);
  if (sensor.kind === "lidar" && beside !== undefined) {
    (sensor.beside ??= []).push(beside);
    return beside;
  }
  const types = sensor.kind === "lidar" ? [...CLOUDS, ...PACKETS] : IMAGES;
  sensor.topic = chooseTopic(recording, `topic ${sensor.name}=NAME`, topic, types);
  return sensor.topic;
}

/** The sensors of this kind that have no topic yet get the one of their channel's or their own name. */
function matchTopics(recording, all, kind) {
  const sensors = all.filter((sensor) => sensor.kind === kind && sensor.topic === undefined);
  const types = kind === "lidar" ? lidarTypes(recording) : IMAGES;
  const isFree = (topic) => all.every((sensor) => sensor.topic !== topic);
  for (const sensor of sensors) {
    const isThere = topicsOfTypes(recording, types).includes(sensor.channel);
    if (isThere && isFree(sensor.channel)) sensor.topic = sensor.channel;
  }
  const without = sensors.filter(({ topic }) => topic === undefined);
  if (without.length === 0) return;
  const free = topicsOfTypes(recording, types).filter(isFree);
  const found = without.length === free.length ? matches(without.map(({ name }) => name), free) : undefined;
  if (!found) throw new UserError(unclear(recording, kind, without, free, types));
  for (const sensor of without) sensor.topic = found.get(sensor.name);
}

/** The topic of each name, where each topic has one of them in it; undefined where that is not clear. */
function matches(names, topics) {
  if (names.length === 1) return new Map([[names[0], topics[0]]]);
  const nameIn = (topic) => {
    const within = names.filter((name) => topic.toLowerCase().includes(name.toLowerCase()));
    const [longest] = within.sort((a, b) => b.length - a.length); // front_left, not left
    const isClear = within.every((name) => longest.toLowerCase().includes(name.toLowerCase()));
    return isClear ? longest : undefined;
  };
  const found = new Map(topics.map((topic) => [nameIn(topic), topic]));
  return names.every((name) => found.has(name)) ? found : undefined;
}

function unclear(recording, kind, sensors, free, types) {
  const names = sensors.map(({ name }) => name);
  const flags = names.map((name) => `--topic ${name}=NAME`).join(" ");
  const taken = topicsOfTypes(recording, types).filter((topic) => !free.includes(topic));
  const others = taken.length > 0 ? `none left: ${taken.join(", ")} is another sensor's already` : `none of type ${types.join(" or ")}, but ${topicsThere(recording)}`;
  const there = free.length > 0 ? free.join(", ") : others;
  return `which topics are those of the ${KIND_WORDS[kind]} ${names.join(", ")} is not clear (${flags} says it); there are ${there}`;
}
