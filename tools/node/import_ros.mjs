// import_ros: a recording of ROS (1 or 2), or an LCM log of other types, to an LCM log.

import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { judgeClocks } from "./lib/clocks.mjs";
import { UserError, runCommand } from "./lib/command.mjs";
import { firstMessages } from "./lib/first_messages.mjs";
import { chooseTopic, sensorsOf } from "./lib/import_sensors.mjs";
import { cameraTarget, cloudTarget, imageTarget, packetTarget } from "./lib/import_targets.mjs";
import { LogWriter } from "./lib/lcm_log.mjs";
import { LcmTypes } from "./lib/lcm_types.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { DecoderFailed } from "./lib/packet_decoder.mjs";
import { siblingsOf } from "./lib/packet_siblings.mjs";
import { Progress } from "./lib/progress.mjs";
import { DamagedIndex } from "./lib/recordings/merged.mjs";
import { openRecording } from "./lib/recordings/open.mjs";
import { cameraSection, cameraToLcm, isRectifiedTopic } from "./lib/sensor_msgs/cameras.mjs";
import { positionDoubt, timeKind } from "./lib/sensor_msgs/clouds.mjs";
import { bitsUsed } from "./lib/sensor_msgs/images.mjs";
import { CAMERA_INFOS, IMAGES } from "./lib/sensor_msgs/messages.mjs";

const command = {
  name: "import_ros",
  minPositional: 1,
  required: [],
  options: {
    lidar: { type: "string", multiple: true },
    camera: { type: "string", multiple: true },
    topic: { type: "string", multiple: true },
    "lidar-topic": { type: "string" },
    "image-topic": { type: "string" },
    "camera-info-topic": { type: "string" },
    rig: { type: "string" },
    "lcm-types": { type: "string" },
    "lidar-model": { type: "string" },
    "lidar-calibration": { type: "string" },
    times: { type: "string", default: "auto" },
    out: { type: "string" },
    force: { type: "boolean", default: false },
    "lidar-channel": { type: "string", default: "LIDAR_POINTS" },
    "image-channel": { type: "string", default: "CAMERA_IMAGE" },
    "camera-info-channel": { type: "string", default: "CAMERA_INFO" },
    "images-only": { type: "boolean", default: false },
    "print-camera": { type: "boolean", default: false },
  },
  usage: `usage: import_ros RECORDING... --out LOG [--force] [--lidar-topic NAME] [--image-topic NAME]
  RECORDING                    ROS 1: .bag; ROS 2: .mcap, .db3, or the folder that ros2 bag made; also cut off, without
                               index, split (several files, or their folder), compressed by zstd. Or an LCM log whose
                               sensors' messages are packets (raw_t) or of other types than voqcal's
  --out LOG                    the LCM log to write; folders are made if missing
  --force                      overwrite the log if it is there
  --lidar-topic NAME           of type PointCloud2, Livox' CustomMsg or a lidar's packets; may be left out if there is one
                               only, or one is called as the rig's channel
  --image-topic NAME           of type Image or CompressedImage; the same
  --images-only                no lidar is looked for: the recording is of the camera alone (calibrate_lens)
  --camera-info-topic NAME     of type CameraInfo: goes into the log too
  --lidar-model NAME           whose packets they are (decode_lidar --help lists them), where they do not tell
  --lidar-calibration FILE     the vendor's file on this very unit, for packets; Ouster's is taken from the recording
  --lcm-types FOLDER           .lcm files that define an LCM log's types, where they are not those of lcmtypes/
  --rig RIG                    the rig file, whose lidar_driver says the same and how to decode
  --times auto|stamps|log      a message's time: its stamp, or when it was recorded; auto (the default) takes stamps
                               unless they are of different clocks, and says so
  --lidar-channel, --image-channel, --camera-info-channel NAME
                               the rig's channels, where they are not LIDAR_POINTS, CAMERA_IMAGE, CAMERA_INFO
or     import_ros RECORDING... --out LOG --lidar SENSOR=CHANNEL... --camera SENSOR=CHANNEL... [--topic SENSOR=NAME]...
  a rig of several sensors, each onto a channel of its own (calibrate_rig --bag does it by the rig file); --rig as above.
  --topic SENSOR=NAME          the sensor's topic. May be left out where a topic is called as the sensor's channel, or
                               there are as many topics as sensors of its kind, with the sensors' names in theirs. Once more for a
                               topic beside the lidar's packets (DIFOP, metadata), where names do not tell whose it is
or     import_ros RECORDING... --print-camera [--camera-info-topic NAME] [--image-topic NAME]
  prints CameraInfo as the camera section of a rig file; for a topic of rectified images (image_rect...), of those`,
};

/** The image's topic, if it was named or there is only one: it says whose CameraInfo, and if it is rectified. */
function imageTopicIfClear(recording, flags) {
  if (flags["image-topic"] !== undefined) return flags["image-topic"];
  const images = [...recording.topics].filter(([, { type }]) => IMAGES.includes(type));
  return images.length === 1 ? images[0][0] : undefined;
}

const infoTopicOf = (imageTopic) => imageTopic && `${dirname(imageTopic.replace(/\/compressed$/, ""))}/camera_info`;

async function printCamera(recording, flags) {
  const flag = "camera-info-topic";
  const imageTopic = imageTopicIfClear(recording, flags);
  const topic = chooseTopic(recording, flag, flags[flag], CAMERA_INFOS, infoTopicOf(imageTopic));
  const isRectified = isRectifiedTopic(imageTopic);
  for await (const message of recording.messages([topic])) {
    const section = cameraSection(cameraToLcm(message.decode(), 0, 0, isRectified));
    if (isRectified) process.stdout.write(`# of the rectified images ${imageTopic}: P of ${topic}\n`);
    process.stdout.write(section);
    return;
  }
  throw new UserError(`topic ${topic} has no message`);
}

/** Messages of one instant in the order of `names`: recordings do not say which came first. */
async function* inFixedOrder(messages, names) {
  const maxHeld = 64; // of a recording whose log times stand still
  let sameTime = [];
  const sorted = () => sameTime.sort((a, b) => names.indexOf(a.topic) - names.indexOf(b.topic));
  for await (const message of messages) {
    const isNew = sameTime.length > 0 && sameTime[0].logTimeNs !== message.logTimeNs;
    if (isNew || sameTime.length === maxHeld) {
      yield* sorted();
      sameTime = [];
    }
    sameTime.push(message);
  }
  yield* sorted();
}

/** What becomes of each topic that is taken. */
async function targetsOf(recording, sensors, flags) {
  const plan = new Map();
  const typeOf = (topic) => recording.topics.get(topic).type;
  const siblings = siblingsOf(recording, sensors);
  for (const sensor of sensors) {
    const { kind, topic, channel } = sensor;
    if (siblings.has(sensor)) await addPackets(plan, recording, sensor, siblings.get(sensor), flags);
    else plan.set(topic, (kind === "lidar" ? cloudTarget : imageTarget)(topic, typeOf(topic), channel));
  }
  if (flags["camera-info-topic"] !== undefined) addCameraInfo(plan, recording, sensors, flags);
  return plan;
}

function addCameraInfo(plan, recording, sensors, flags) {
  const flag = "camera-info-topic";
  const channel = flags["camera-info-channel"];
  const topic = chooseTopic(recording, flag, flags[flag], CAMERA_INFOS, channel);
  const { topic: imageTopic } = sensors.find(({ kind }) => kind === "image");
  plan.set(topic, cameraTarget(topic, recording.topics.get(topic).type, channel, imageTopic));
}

/** The packets' topic, and those of the sensor's state, which RoboSense's decoders learn from. */
async function addPackets(plan, recording, { name, topic, channel }, siblings, flags) {
  const metadata = await metadataFile(recording, siblings.metadata);
  const rig = flags.rig && flags.lidar ? `${flags.rig}#${name}` : flags.rig;
  const args = { rig, model: flags["lidar-model"], calibration: flags["lidar-calibration"], metadata };
  const given = Object.entries(args).filter(([, value]) => value !== undefined);
  const target = packetTarget(
    topic,
    recording.topics.get(topic).type,
    channel,
    given.flatMap(([flag, value]) => [`--${flag}`, value]),
  );
  for (const each of siblings.state) plan.set(each, target);
  plan.set(topic, target);
}

/** Ouster's driver records its sensor's metadata beside the packets, as text. */
async function metadataFile(recording, topics) {
  if (topics.length === 0) return undefined;
  for await (const message of recording.messages(topics)) {
    const folder = mkdtempSync(join(tmpdir(), "voqcal-metadata-"));
    process.once("exit", () => rmSync(folder, { recursive: true, force: true }));
    const path = join(folder, "metadata.json");
    writeFileSync(path, message.decode().data);
    return path;
  }
  return undefined;
}

/**
 * What only the recording tells: clocks, the times of points, the bits of pixels. Adds the words for them.
 * @returns {useLogTimes, told}: `told` by topic.
 */
async function settle(recording, plan, sensors, flags, words) {
  const first = await firstMessages(recording, plan, sensors);
  const clocks = clocksOf(sensors, first);
  if (flags.times === "auto") words.push(...clocks.words);
  const useLogTimes = flags.times === "log" || (flags.times === "auto" && clocks.useLogTimes);
  const told = new Map();
  for (const sensor of sensors) {
    const messages = first.get(sensor.topic).map(({ message }) => message).filter(Boolean);
    const say = (line) => words.push(flags.lidar ? `${sensor.name}: ${line}` : line);
    const isOfPackets = plan.get(sensor.topic).hasPackets;
    if (!isOfPackets) told.set(sensor.topic, (sensor.kind === "lidar" ? toldOfClouds : toldOfImages)(messages, say));
  }
  return { useLogTimes, told };
}

/** Log times hold for all sensors where two of them need these. */
function clocksOf(sensors, first) {
  const pairs = new Map(); // by words
  let useLogTimes = false;
  const ofKind = (kind) => sensors.filter((sensor) => sensor.kind === kind);
  for (const lidar of ofKind("lidar")) {
    for (const camera of ofKind("image")) {
      const judged = judgeClocks(first.get(lidar.topic), first.get(camera.topic));
      useLogTimes ||= judged.useLogTimes;
      const names = [...(pairs.get(judged.words) ?? []), `${lidar.name} with ${camera.name}`];
      if (judged.words) pairs.set(judged.words, names);
    }
  }
  const isPair = sensors.length <= 2;
  const end = useLogTimes ? "" : ": stamps are used";
  return { useLogTimes, words: [...pairs].map(([words, names]) => (isPair ? "" : `${names.join(", ")}: `) + words + end) };
}

function toldOfClouds(clouds, say) {
  const times = timeKind(clouds);
  if (times) say(times.words);
  const doubt = positionDoubt(clouds);
  if (doubt) say(doubt);
  return times;
}

function toldOfImages(images, say) {
  const bits = bitsUsed(images);
  if (bits) say(`images have ${bits} bits of 16: the upper 8 of these are taken`);
  return bits;
}

async function writeLog(recording, plan, settled, out, progress, words) {
  const names = [...plan.keys()];
  const total = names.reduce((sum, name) => sum + recording.topics.get(name).count, 0);
  const log = new LogWriter(out);
  try {
    let num = 0;
    let lastTimeNs = 0n;
    for await (const event of inFixedOrder(recording.messages(names), names)) {
      await writeMessage(event, plan.get(event.topic), settled, log);
      lastTimeNs = event.logTimeNs;
      progress.add(event.data.length, ++num / total);
    }
    for (const target of new Set(plan.values())) {
      target.tally.requireSome();
      const left = await target.finish();
      for (const bytes of left.encoded) log.write(lastTimeNs / 1000n, target.channel, bytes);
      if (left.words) words.push(`${target.channel}: ${left.words}`);
    }
  } catch (error) {
    log.abandon();
    throw error;
  }
  log.finish();
}

/** One message; a broken one is counted and left out. */
async function writeMessage({ topic, logTimeNs, decode }, target, { useLogTimes, told }, log) {
  let encoded;
  try {
    encoded = await target.encode(target.prepare(decode()), logTimeNs, useLogTimes, told.get(topic));
  } catch (error) {
    if (error instanceof DecoderFailed) throw error;
    target.tally.leaveOut(error.message);
    return;
  }
  ++target.tally.numTaken;
  for (const bytes of encoded) log.write(logTimeNs / 1000n, target.channel, bytes);
}

async function importRecording(recording, flags) {
  if (flags.out === undefined) throw new UserError("--out is required: the LCM log to write");
  if (!["auto", "stamps", "log"].includes(flags.times)) {
    throw new UserError(`--times must be auto, stamps or log, is ${flags.times}`);
  }
  const sensors = sensorsOf(recording, flags);
  const plan = await targetsOf(recording, sensors, flags);
  prepareOutput(flags.out, flags.force);
  const words = [];
  const progress = new Progress("importing");
  try {
    const settled = await settle(recording, plan, sensors, flags, words);
    await writeLog(recording, plan, settled, flags.out, progress, words);
  } finally {
    for (const target of plan.values()) target.close?.();
  }
  progress.end();
  const say = (line) => process.stdout.write(`${line}\n`);
  for (const line of [...recording.remarks, ...words]) say(line);
  for (const target of new Set(plan.values())) {
    const { channel, tally } = target;
    const topics = [...plan.keys()].filter((topic) => plan.get(topic) === target);
    say(`${channel}: ${tally.numTaken} messages of ${topics.join(" and ")}`);
    if (tally.words()) say(`${channel}: ${tally.words()}`);
  }
  say(`${progress.rate()}\nwritten\n  ${flags.out}`);
}

function typesOf(folder) {
  try {
    return new LcmTypes(pathToFileURL(`${folder}/`));
  } catch (error) {
    throw new UserError(`--lcm-types ${folder}: ${error.message}`);
  }
}

/** Runs `use` on the recording; anew without its index, should that lead to damage. */
async function withRecording(paths, scratchParent, lcmTypes, use) {
  for (const isScanning of [false, true]) {
    const recording = await openRecording(paths, scratchParent, isScanning, lcmTypes);
    try {
      await use(recording);
      return;
    } catch (error) {
      if (!(error instanceof DamagedIndex)) throw new UserError(`${paths.join(", ")}: ${error.message}`);
    } finally {
      await recording.close();
    }
  }
}

await runCommand(command, async (flags, paths) => {
  const use = flags["print-camera"] ? printCamera : importRecording;
  const scratchParent = flags.out === undefined ? tmpdir() : dirname(flags.out);
  const lcmTypes = flags["lcm-types"] === undefined ? undefined : typesOf(flags["lcm-types"]);
  await withRecording(paths, scratchParent, lcmTypes, (recording) => use(recording, flags));
});
