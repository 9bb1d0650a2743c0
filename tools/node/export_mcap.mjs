// export_mcap: a calibrated session, or a rig's, as MCAP with Foxglove's schemas, for Foxglove and Rerun.

import { existsSync, readFileSync, renameSync, rmSync } from "node:fs";
import { open } from "node:fs/promises";
import { join } from "node:path";
import { McapWriter } from "@mcap/core";
import { FileHandleWritable } from "@mcap/nodejs";
import { UserError, runCommand } from "./lib/command.mjs";
import { boardLines, calibration, cloud, image, transform } from "./lib/foxglove_messages.mjs";
import { foxgloveType } from "./lib/foxglove_protobuf.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { isRigResult, readRigResult } from "./lib/rig_result.mjs";
import { readSession } from "./lib/session.mjs";

const command = {
  name: "export_mcap",
  numPositional: 1,
  required: ["out"],
  options: { out: { type: "string" }, rig: { type: "string" }, force: { type: "boolean", default: false } },
  usage: `usage: export_mcap RESULT --out FILE.mcap [--rig RIG] [--force]
  RESULT      the folder that calibrate wrote: result.json and samples.lcm; or that of a rig: rig_extrinsics.yaml and,
              of each pair that has a result, its folder
  --out FILE  MCAP with Foxglove's schemas (protobuf), for Foxglove and Rerun:
              /tf (camera in lidar), /lidar/points, /camera/image, /camera/calibration,
              /lidar/board and /camera/board (the board's outline as each sensor saw it);
              of a rig each sensor's name instead of lidar and camera, and all their poses in /tf;
              folders are made if missing
  --rig RIG   of a rig: the rig file, for lenses of cameras that no pair's folder has
  --force     overwrite the file if it is there`,
};

/** What readRigResult has, of one pair. */
function readPair(folder) {
  const path = join(folder, "result.json");
  if (!existsSync(path)) {
    throw new UserError(`${path}: no such file; wanted: the folder that calibrate or calibrate_rig wrote (--out)`);
  }
  const { result, rig } = JSON.parse(readFileSync(path, "utf8"));
  return {
    transforms: [{ parent: "lidar", child: "camera", T_parent_child: result.T_lidar_camera }],
    lenses: { camera: rig.camera },
    sessions: [{ lidar: "lidar", camera: "camera", samples: join(folder, "samples.lcm") }],
    cameras: ["camera"],
  };
}

/** Writes messages of Foxglove's types; each topic is announced by its first. What several pairs have is written once. */
class FoxgloveWriter {
  #writer;
  #channels = new Map();
  #written = new Set();

  constructor(file) {
    this.#writer = new McapWriter({ writable: new FileHandleWritable(file) });
  }

  async start() {
    await this.#writer.start({ profile: "", library: "voqcal" });
  }

  /** @param id  tells messages of one topic and time apart. */
  async write(topic, typeName, utime, message, id = "") {
    const key = `${topic} ${utime} ${id}`;
    if (this.#written.has(key)) return;
    this.#written.add(key);
    if (!this.#channels.has(topic)) {
      const type = foxgloveType(typeName);
      const schemaId = await this.#writer.registerSchema(type.schema);
      const channel = { topic, schemaId, messageEncoding: "protobuf", metadata: new Map() };
      this.#channels.set(topic, { id: await this.#writer.registerChannel(channel), type });
    }
    const { id: channelId, type } = this.#channels.get(topic);
    const time = utime * 1000n;
    const data = type.encode(message);
    await this.#writer.addMessage({ channelId, sequence: 0, logTime: time, publishTime: time, data });
  }

  async end() {
    await this.#writer.end();
  }
}

/** The poses of all sensors, and their lenses. */
async function writeRig(writer, { transforms, lenses }, utime) {
  for (const each of transforms) {
    await writer.write("/tf", "FrameTransform", utime, transform(each, utime), each.child);
  }
  for (const [name, lens] of Object.entries(lenses)) {
    await writer.write(`/${name}/calibration`, "CameraCalibration", utime, calibration(name, lens, utime));
  }
}

async function writeSample(writer, { lidar, camera }, { sample, sweep, image: picture }) {
  const { utime } = sample;
  for (const [kind, frame] of Object.entries({ lidar, camera })) {
    const lines = boardLines(kind, frame, sample[kind].pose, utime);
    await writer.write(`/${frame}/board`, "SceneUpdate", utime, lines);
  }
  if (sweep) await writer.write(`/${lidar}/points`, "PointCloud", sweep.utime, cloud(lidar, sweep));
  if (picture) {
    const { type, message } = image(camera, picture);
    await writer.write(`/${camera}/image`, type, picture.utime, message);
  }
}

/** The samples of all sessions by their times: {session, scene} each. */
function* inOrderOfTime(sessions) {
  const open = sessions.map((session) => ({ session, scenes: readSession(session.samples) }));
  const advance = (source) => (source.scene = source.scenes.next().value);
  open.forEach(advance);
  for (;;) {
    const left = open.filter(({ scene }) => scene);
    if (left.length === 0) return;
    const first = left.reduce((least, source) => (source.scene.sample.utime < least.scene.sample.utime ? source : least));
    yield { session: first.session, scene: first.scene };
    advance(first);
  }
}

/** @returns how many samples there were. Without any, poses and lenses have the time 0. */
async function writeResult(writer, result) {
  let count = 0;
  for (const { session, scene } of inOrderOfTime(result.sessions)) {
    await writeRig(writer, result, scene.sample.utime);
    await writeSample(writer, session, scene);
    ++count;
  }
  if (count === 0) await writeRig(writer, result, 0n);
  return count;
}

await runCommand(command, async ({ out, rig, force }, [folder]) => {
  const result = isRigResult(folder) ? readRigResult(folder, rig) : readPair(folder);
  prepareOutput(out, force);
  const unfinished = `${out}.unfinished-${process.pid}`;
  const file = await open(unfinished, "w");
  try {
    const writer = new FoxgloveWriter(file);
    await writer.start();
    const count = await writeResult(writer, result);
    await writer.end();
    await file.close();
    renameSync(unfinished, out);
    for (const name of result.cameras.filter((camera) => !result.lenses[camera])) {
      process.stdout.write(`${name}: its lens is in no pair's folder, so not written (--rig RIG gives it)\n`);
    }
    process.stdout.write(`${count} samples\nwritten\n  ${out}\n`);
  } catch (error) {
    await file.close();
    rmSync(unfinished, { force: true });
    throw error;
  }
});
