// export_mcap: a calibrated session as MCAP with Foxglove's schemas, for Foxglove and Rerun.

import { existsSync, readFileSync, renameSync, rmSync } from "node:fs";
import { open } from "node:fs/promises";
import { join } from "node:path";
import { McapWriter } from "@mcap/core";
import { FileHandleWritable } from "@mcap/nodejs";
import { UserError, runCommand } from "./lib/command.mjs";
import { boardLines, calibration, cloud, image, lidarToCamera } from "./lib/foxglove_messages.mjs";
import { foxgloveType } from "./lib/foxglove_protobuf.mjs";
import { prepareOutput } from "./lib/output_file.mjs";
import { readSession } from "./lib/session.mjs";

const command = {
  name: "export_mcap",
  numPositional: 1,
  required: ["out"],
  options: { out: { type: "string" }, force: { type: "boolean", default: false } },
  usage: `usage: export_mcap RESULT --out FILE.mcap [--force]
  RESULT      the folder that calibrate wrote: result.json and samples.lcm
  --out FILE  MCAP with Foxglove's schemas (protobuf), for Foxglove and Rerun:
              /tf (camera in lidar), /lidar/points, /camera/image, /camera/calibration,
              /lidar/board and /camera/board (the board's outline as each sensor saw it);
              folders are made if missing
  --force     overwrite the file if it is there`,
};

function readResult(folder) {
  const path = join(folder, "result.json");
  if (!existsSync(path)) {
    throw new UserError(`${path}: no such file; wanted: the folder that calibrate wrote (--out)`);
  }
  return JSON.parse(readFileSync(path, "utf8"));
}

/** Writes messages of Foxglove's types; each topic is announced by its first. */
class FoxgloveWriter {
  #writer;
  #channels = new Map();

  constructor(file) {
    this.#writer = new McapWriter({ writable: new FileHandleWritable(file) });
  }

  async start() {
    await this.#writer.start({ profile: "", library: "voqcal" });
  }

  async write(topic, typeName, utime, message) {
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

async function writeSample(writer, result, { sample, sweep, image: picture }) {
  const { utime } = sample;
  await writer.write("/tf", "FrameTransform", utime, lidarToCamera(result.result, utime));
  await writer.write(
    "/camera/calibration",
    "CameraCalibration",
    utime,
    calibration(result.rig.camera, utime),
  );
  const boards = { lidar: sample.lidar.pose, camera: sample.camera.pose };
  for (const [frame, pose] of Object.entries(boards)) {
    await writer.write(`/${frame}/board`, "SceneUpdate", utime, boardLines(frame, pose, utime));
  }
  if (sweep) await writer.write("/lidar/points", "PointCloud", sweep.utime, cloud(sweep));
  if (picture) {
    const { type, message } = image(picture);
    await writer.write("/camera/image", type, picture.utime, message);
  }
}

await runCommand(command, async ({ out, force }, [folder]) => {
  const result = readResult(folder);
  const samples = readSession(join(folder, "samples.lcm"));
  prepareOutput(out, force);
  const unfinished = `${out}.unfinished-${process.pid}`;
  const file = await open(unfinished, "w");
  try {
    const writer = new FoxgloveWriter(file);
    await writer.start();
    let count = 0;
    for (const each of samples) {
      await writeSample(writer, result, each);
      ++count;
    }
    await writer.end();
    await file.close();
    renameSync(unfinished, out);
    process.stdout.write(`${count} samples\nwritten\n  ${out}\n`);
  } catch (error) {
    await file.close();
    rmSync(unfinished, { force: true });
    throw error;
  }
});
