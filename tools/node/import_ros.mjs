// import_ros: a recording of ROS (1 or 2) to an LCM log.

import { tmpdir } from "node:os";
import { dirname } from "node:path";
import { judgeClocks } from "./lib/clocks.mjs";
import { UserError, runCommand } from "./lib/command.mjs";
import { LogWriter } from "./lib/lcm_log.mjs";
import { voqcalTypes } from "./lib/lcm_types.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { Progress } from "./lib/progress.mjs";
import { DamagedIndex } from "./lib/recordings/merged.mjs";
import { openRecording } from "./lib/recordings/open.mjs";
import { cameraSection, cameraToLcm, isRectifiedTopic } from "./lib/sensor_msgs/cameras.mjs";
import { asCloud, cloudToLcm, timeKind } from "./lib/sensor_msgs/clouds.mjs";
import { bitsUsed, imageToLcm } from "./lib/sensor_msgs/images.mjs";
import { CAMERA_INFOS, CLOUDS, IMAGES, stampOf } from "./lib/sensor_msgs/messages.mjs";
import { Tally } from "./lib/tally.mjs";

const command = {
  name: "import_ros",
  minPositional: 1,
  required: [],
  options: {
    "lidar-topic": { type: "string" },
    "image-topic": { type: "string" },
    "camera-info-topic": { type: "string" },
    times: { type: "string", default: "auto" },
    out: { type: "string" },
    force: { type: "boolean", default: false },
    "lidar-channel": { type: "string", default: "LIDAR_POINTS" },
    "image-channel": { type: "string", default: "CAMERA_IMAGE" },
    "camera-info-channel": { type: "string", default: "CAMERA_INFO" },
    "print-camera": { type: "boolean", default: false },
  },
  usage: `usage: import_ros RECORDING... --out LOG [--force] [--lidar-topic NAME] [--image-topic NAME]
  RECORDING                    ROS 1: .bag; ROS 2: .mcap, .db3, or the folder that ros2 bag made; also cut off, without
                               index, split (several files, or their folder), compressed by zstd
  --out LOG                    the LCM log to write; folders are made if missing
  --force                      overwrite the log if it is there
  --lidar-topic NAME           of type PointCloud2 or Livox' CustomMsg; may be left out if there is one only
  --image-topic NAME           of type Image or CompressedImage; the same
  --camera-info-topic NAME     of type CameraInfo: goes into the log too
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
  const isRight = (name) => types.includes(topics.get(name)?.type) && !name.endsWith("/compressedDepth");
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

/** What to do with each topic. `toLcm` makes a message of what `decode` gave. */
function conversions(recording, flags) {
  const plan = new Map();
  const add = (kind, types, type, steps) => {
    const flag = `${kind}-topic`;
    const topic = chooseTopic(recording, flag, flags[flag], types);
    const rosType = recording.topics.get(topic).type;
    const channel = flags[`${kind}-channel`];
    plan.set(topic, { kind, channel, type, rosType, ...steps(topic), tally: new Tally(`topic ${topic}`) });
    return topic;
  };
  add("lidar", CLOUDS, "pointcloud2_t", () => ({ prepare: asCloud, toLcm: cloudToLcm }));
  const imageTopic = add("image", IMAGES, "image_t", () => ({ prepare: (message) => message, toLcm: imageToLcm }));
  if (flags["camera-info-topic"] !== undefined) {
    const isRectified = isRectifiedTopic(imageTopic);
    const toLcm = (message, utime, seq) => cameraToLcm(message, utime, seq, isRectified);
    add("camera-info", CAMERA_INFOS, "camera_info_t", () => ({ prepare: (message) => message, toLcm }));
  }
  return plan;
}

/** The first messages of clouds and images: {message, stampNs, logTimeNs} by kind. Broken ones are passed over. */
async function firstMessages(recording, plan) {
  const first = { lidar: [], image: [] };
  const names = [...plan].filter(([, { kind }]) => kind in first).map(([name]) => name);
  let numBytes = 0;
  for await (const { topic, logTimeNs, data, decode } of recording.messages(names)) {
    const { kind, prepare, rosType } = plan.get(topic);
    numBytes += data.length;
    const isEnough = Object.values(first).every((messages) => messages.length >= NUM_SAMPLED);
    if (isEnough || numBytes > MAX_SAMPLED_BYTES) break;
    if (first[kind].length >= NUM_SAMPLED) continue;
    try {
      const message = prepare(decode(), rosType);
      first[kind].push({ message, logTimeNs, stampNs: stampOf(message) });
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
  const times = timeKind(first.lidar.map(({ message }) => message));
  if (times) words.push(times.words);
  const bits = bitsUsed(first.image.map(({ message }) => message));
  if (bits) words.push(`images have ${bits} bits of 16: the upper 8 of these are taken`);
  return { useLogTimes, lidar: times, image: bits };
}

async function writeLog(recording, plan, settled, out, progress) {
  const types = voqcalTypes();
  const names = [...plan.keys()];
  const total = names.reduce((sum, name) => sum + recording.topics.get(name).count, 0);
  const log = new LogWriter(out);
  try {
    let num = 0;
    for await (const event of inFixedOrder(recording.messages(names), names)) {
      writeMessage(event, plan.get(event.topic), settled, types, log);
      progress.add(event.data.length, ++num / total);
    }
    for (const { tally } of plan.values()) tally.requireSome();
  } catch (error) {
    log.abandon();
    throw error;
  }
  log.finish();
}

/** One message; a broken one is counted and left out. */
function writeMessage({ logTimeNs, decode }, target, settled, types, log) {
  let bytes;
  try {
    const message = target.prepare(decode(), target.rosType);
    const utime = (settled.useLogTimes ? logTimeNs : stampOf(message)) / 1000n; // LCM knows no finer
    const converted = target.toLcm(message, utime, target.tally.numTaken, settled[target.kind]);
    bytes = types.encode(target.type, converted);
  } catch (error) {
    target.tally.leaveOut(error.message);
    return;
  }
  ++target.tally.numTaken;
  log.write(logTimeNs / 1000n, target.channel, bytes);
}

async function importRecording(recording, flags) {
  if (flags.out === undefined) throw new UserError("--out is required: the LCM log to write");
  if (!["auto", "stamps", "log"].includes(flags.times)) {
    throw new UserError(`--times must be auto, stamps or log, is ${flags.times}`);
  }
  const plan = conversions(recording, flags);
  prepareOutput(flags.out, flags.force);
  const words = [];
  const settled = await settle(recording, plan, flags, words);
  const progress = new Progress("importing");
  await writeLog(recording, plan, settled, flags.out, progress);
  progress.end();
  const say = (line) => process.stdout.write(`${line}\n`);
  for (const line of [...recording.remarks, ...words]) say(line);
  for (const [topic, { channel, tally }] of plan) {
    say(`${channel}: ${tally.numTaken} messages of ${topic}`);
    if (tally.words()) say(`${channel}: ${tally.words()}`);
  }
  say(`${progress.rate()}\nwritten\n  ${flags.out}`);
}

/** Runs `use` on the recording; anew without its index, should that lead to damage. */
async function withRecording(paths, scratchParent, use) {
  for (const isScanning of [false, true]) {
    const recording = await openRecording(paths, scratchParent, isScanning);
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
  await withRecording(paths, scratchParent, (recording) => use(recording, flags));
});
