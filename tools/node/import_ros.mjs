// import_ros: a recording of ROS (1 or 2), or an LCM log of other types, to an LCM log.

import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { judgeClocks } from "./lib/clocks.mjs";
import { UserError, runCommand } from "./lib/command.mjs";
import { cameraTarget, cloudTarget, imageTarget, packetTarget } from "./lib/import_targets.mjs";
import { LogWriter } from "./lib/lcm_log.mjs";
import { LcmTypes } from "./lib/lcm_types.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { DecoderFailed } from "./lib/packet_decoder.mjs";
import { Progress } from "./lib/progress.mjs";
import { DamagedIndex } from "./lib/recordings/merged.mjs";
import { openRecording } from "./lib/recordings/open.mjs";
import { cameraSection, cameraToLcm, isRectifiedTopic } from "./lib/sensor_msgs/cameras.mjs";
import { positionDoubt, timeKind } from "./lib/sensor_msgs/clouds.mjs";
import { bitsUsed } from "./lib/sensor_msgs/images.mjs";
import { CAMERA_INFOS, CLOUDS, IMAGES } from "./lib/sensor_msgs/messages.mjs";
import { PACKETS, isBesidePackets } from "./lib/sensor_msgs/packets.mjs";

const command = {
  name: "import_ros",
  minPositional: 1,
  required: [],
  options: {
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
or     import_ros RECORDING... --print-camera [--camera-info-topic NAME] [--image-topic NAME]
  prints CameraInfo as the camera section of a rig file; for a topic of rectified images (image_rect...), of those`,
};

const NUM_SAMPLED = 20; // messages of each topic that clocks, times and bits are told by
const MAX_SAMPLED_BYTES = 1 << 28;

/** The topic that was asked for, or the only one of these types. */
function chooseTopic(recording, flag, wanted, types, preferred) {
  const { topics } = recording;
  const isAside = (name) => PACKETS.includes(topics.get(name).type) && isBesidePackets(name);
  const isRight = (name) =>
    types.includes(topics.get(name)?.type) && !name.endsWith("/compressedDepth") && !isAside(name);
  for (const name of [wanted, wanted && `/${wanted}`]) if (isRight(name)) return name;
  const candidates = [...topics.keys()].filter(isRight);
  if (wanted === undefined && candidates.length === 1) return candidates[0];
  if (wanted === undefined && candidates.includes(preferred)) return preferred;
  const there = [...topics].map(([name, { type, count }]) => `${name} (${type}, ${count})`).sort();
  const what = wanted === undefined ? `${candidates.length} topics` : `no topic ${wanted}`;
  throw new UserError(
    `has ${what} of type ${types.join(" or ")} (--${flag} names one); it has ${there.join(", ")}`,
  );
}

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
async function targetsOf(recording, flags) {
  const plan = new Map();
  const choose = (kind, types) =>
    chooseTopic(recording, `${kind}-topic`, flags[`${kind}-topic`], types, flags[`${kind}-channel`]);
  const typeOf = (topic) => recording.topics.get(topic).type;
  const lidarTopic = flags["images-only"] ? undefined : choose("lidar", lidarTypes(recording, flags));
  const imageTopic = choose("image", IMAGES);
  if (lidarTopic !== undefined) {
    if (PACKETS.includes(typeOf(lidarTopic))) await addPackets(plan, recording, lidarTopic, flags);
    else plan.set(lidarTopic, cloudTarget(lidarTopic, typeOf(lidarTopic), flags["lidar-channel"]));
  }
  plan.set(imageTopic, imageTarget(imageTopic, typeOf(imageTopic), flags["image-channel"]));
  if (flags["camera-info-topic"] !== undefined) {
    const topic = choose("camera-info", CAMERA_INFOS);
    plan.set(topic, cameraTarget(topic, typeOf(topic), flags["camera-info-channel"], imageTopic));
  }
  return plan;
}

/** Clouds; packets where there are none, or they are asked for. */
function lidarTypes(recording, flags) {
  if (flags["lidar-topic"] !== undefined) return [...CLOUDS, ...PACKETS];
  const there = [...recording.topics.values()].map(({ type }) => type);
  const hasPackets = there.some((type) => PACKETS.includes(type));
  return there.some((type) => CLOUDS.includes(type)) || !hasPackets ? CLOUDS : PACKETS;
}

/** The packets' topic, and those of the sensor's state, which RoboSense's decoders learn from. */
async function addPackets(plan, recording, topic, flags) {
  const metadata = await metadataFile(recording);
  const args = { rig: flags.rig, model: flags["lidar-model"], calibration: flags["lidar-calibration"], metadata };
  const given = Object.entries(args).filter(([, value]) => value !== undefined);
  const target = packetTarget(
    topic,
    recording.topics.get(topic).type,
    flags["lidar-channel"],
    given.flatMap(([name, value]) => [`--${name}`, value]),
  );
  const isState = ([name, { type }]) => PACKETS.includes(type) && /difop/i.test(name);
  for (const [name] of [...recording.topics].filter(isState)) plan.set(name, target);
  plan.set(topic, target);
}

/** Ouster's driver records its sensor's metadata beside the packets, as text. */
async function metadataFile(recording) {
  const isMetadata = ([name, { type }]) => type === "std_msgs/String" && /metadata$/.test(name);
  const topics = [...recording.topics].filter(isMetadata).map(([name]) => name);
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

/** The first messages of clouds and images: {message, stampNs, logTimeNs} by kind. Broken ones are passed over. */
async function firstMessages(recording, plan) {
  const first = { lidar: [], image: [] };
  const names = [...plan].filter(([, { kind }]) => kind in first).map(([name]) => name);
  let numBytes = 0;
  for await (const { topic, logTimeNs, data, decode } of recording.messages(names)) {
    const { kind, prepare, stampNs } = plan.get(topic);
    numBytes += data.length;
    const kinds = [...plan.values()].map((target) => target.kind).filter((each) => each in first);
    const isEnough = kinds.every((each) => first[each].length >= NUM_SAMPLED);
    if (isEnough || numBytes > MAX_SAMPLED_BYTES) break;
    if (first[kind].length >= NUM_SAMPLED) continue;
    try {
      const message = prepare(decode());
      first[kind].push({ message, logTimeNs, stampNs: stampNs(message, logTimeNs) });
    } catch {
      // Counted when it is imported.
    }
  }
  return first;
}

/** What only the recording tells: clocks, the times of points, the bits of pixels. Adds the words for them. */
async function settle(recording, plan, flags, words) {
  const first = await firstMessages(recording, plan);
  const clocks = judgeClocks(first.lidar, first.image);
  const useLogTimes = flags.times === "log" || (flags.times === "auto" && clocks.useLogTimes);
  if (flags.times === "auto" && clocks.words) words.push(clocks.words);
  const hasPackets = [...plan.values()].some((target) => target.hasPackets);
  const clouds = hasPackets ? [] : first.lidar.map(({ message }) => message);
  const times = timeKind(clouds);
  if (times) words.push(times.words);
  const doubt = positionDoubt(clouds);
  if (doubt) words.push(doubt);
  const bits = bitsUsed(first.image.map(({ message }) => message));
  if (bits) words.push(`images have ${bits} bits of 16: the upper 8 of these are taken`);
  return { useLogTimes, lidar: times, image: bits };
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
async function writeMessage({ logTimeNs, decode }, target, settled, log) {
  let encoded;
  try {
    encoded = await target.encode(target.prepare(decode()), logTimeNs, settled);
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
  const plan = await targetsOf(recording, flags);
  prepareOutput(flags.out, flags.force);
  const words = [];
  const progress = new Progress("importing");
  try {
    const settled = await settle(recording, plan, flags, words);
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
