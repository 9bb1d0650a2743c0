// import_ros: a ROS 1 bag or a ROS 2 (MCAP) recording to an LCM log.

import { UserError, runCommand } from "./lib/command.mjs";
import { LogWriter } from "./lib/lcm_log.mjs";
import { voqcalTypes } from "./lib/lcm_types.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { openRecording } from "./lib/recordings.mjs";
import {
  CAMERA_INFO,
  IMAGES,
  POINT_CLOUD,
  cameraSection,
  cameraToLcm,
  cloudToLcm,
  imageToLcm,
} from "./lib/ros_to_lcm.mjs";

const command = {
  name: "import_ros",
  numPositional: 1,
  required: [],
  options: {
    "lidar-topic": { type: "string" },
    "image-topic": { type: "string" },
    "camera-info-topic": { type: "string" },
    out: { type: "string" },
    force: { type: "boolean", default: false },
    "lidar-channel": { type: "string", default: "LIDAR_POINTS" },
    "image-channel": { type: "string", default: "CAMERA_IMAGE" },
    "camera-info-channel": { type: "string", default: "CAMERA_INFO" },
    "print-camera": { type: "boolean", default: false },
  },
  usage: `usage: tools/import_ros RECORDING --out LOG [--force] [--lidar-topic NAME] [--image-topic NAME]
  RECORDING                    a ROS 1 bag (.bag) or a ROS 2 recording (.mcap)
  --out LOG                    the LCM log to write; folders are made if missing
  --force                      overwrite the log if it is there
  --lidar-topic NAME           of type PointCloud2; may be left out if there is one only
  --image-topic NAME           of type Image or CompressedImage; the same
  --camera-info-topic NAME     of type CameraInfo: goes into the log too
  --lidar-channel, --image-channel, --camera-info-channel NAME
                               the rig's channels, where they are not LIDAR_POINTS, CAMERA_IMAGE, CAMERA_INFO
or     tools/import_ros RECORDING --print-camera [--camera-info-topic NAME]
  prints CameraInfo as the camera section of a rig file`,
};

/** The topic that was asked for, or the only one of these types. */
function chooseTopic(path, topics, flag, wanted, types) {
  const there = [...topics].map(([name, { type, count }]) => `${name} (${type}, ${count})`).sort();
  const isRight = (name) => types.includes(topics.get(name)?.type);
  if (wanted !== undefined && isRight(wanted)) return wanted;
  const candidates = [...topics.keys()].filter(isRight);
  if (wanted === undefined && candidates.length === 1) return candidates[0];
  const what = wanted === undefined ? `${candidates.length} topics` : `no topic ${wanted}`;
  throw new UserError(
    `${path}: has ${what} of type ${types.join(" or ")} (--${flag} names one); ` +
      `it has ${there.length === 0 ? "no topics" : there.join(", ")}`,
  );
}

async function printCamera(path, recording, flags) {
  const flag = "camera-info-topic";
  const topic = chooseTopic(path, recording.topics, flag, flags[flag], [CAMERA_INFO]);
  for await (const { message } of recording.messages([topic])) {
    process.stdout.write(cameraSection(cameraToLcm(message, 0)));
    return;
  }
  throw new UserError(`${path}: topic ${topic} has no message`);
}

/** Messages of one instant in the order of `names`: recordings do not say which came first. */
async function* inFixedOrder(messages, names) {
  let sameTime = [];
  const sorted = () => sameTime.sort((a, b) => names.indexOf(a.topic) - names.indexOf(b.topic));
  for await (const message of messages) {
    if (sameTime.length > 0 && sameTime[0].logTimeNs !== message.logTimeNs) {
      yield* sorted();
      sameTime = [];
    }
    sameTime.push(message);
  }
  yield* sorted();
}

/** What to do with each topic: its channel, its LCM type and the conversion. */
function conversions(path, topics, flags) {
  const plan = new Map();
  const add = (kind, types, type, toLcm) => {
    const flag = `${kind}-topic`;
    const topic = chooseTopic(path, topics, flag, flags[flag], types);
    plan.set(topic, { channel: flags[`${kind}-channel`], type, toLcm, count: 0 });
  };
  add("lidar", [POINT_CLOUD], "pointcloud2_t", cloudToLcm);
  add("image", IMAGES, "image_t", imageToLcm);
  if (flags["camera-info-topic"] !== undefined) {
    add("camera-info", [CAMERA_INFO], "camera_info_t", cameraToLcm);
  }
  return plan;
}

async function writeLog(path, recording, plan, out) {
  const types = voqcalTypes();
  const names = [...plan.keys()];
  const log = new LogWriter(out);
  try {
    for await (const { topic, logTimeNs, message } of inFixedOrder(recording.messages(names), names)) {
      const target = plan.get(topic);
      const converted = target.toLcm(message, target.count++);
      log.write(logTimeNs / 1000n, target.channel, types.encode(target.type, converted));
    }
    for (const [topic, { count }] of plan) {
      if (count === 0) throw new UserError(`topic ${topic} has no message`);
    }
  } catch (error) {
    log.abandon();
    throw new UserError(`${path}: ${error.message}`);
  }
  log.finish();
}

async function importRecording(path, recording, flags) {
  if (flags.out === undefined) throw new UserError("--out is required: the LCM log to write");
  const plan = conversions(path, recording.topics, flags);
  prepareOutput(flags.out, flags.force);
  await writeLog(path, recording, plan, flags.out);
  for (const [topic, { channel, count }] of plan) {
    process.stdout.write(`${channel}: ${count} messages of ${topic}\n`);
  }
  process.stdout.write(`written\n  ${flags.out}\n`);
}

await runCommand(command, async (flags, [path]) => {
  const recording = await openRecording(path);
  try {
    if (flags["print-camera"]) await printCamera(path, recording, flags);
    else await importRecording(path, recording, flags);
  } finally {
    await recording.close();
  }
});
