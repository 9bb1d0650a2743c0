// What calibrate_rig or a live rig left in its folder: the tree of its sensors, and the sessions of its pairs.

import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { UserError } from "./command.mjs";
import { programPath } from "./program_path.mjs";

const RESULT = "rig_extrinsics.yaml";

export const isRigResult = (folder) => existsSync(join(folder, RESULT));

/**
 * @param rig  the rig file for the cameras' lenses, or undefined: as the sessions have them.
 * @returns {transforms, lenses, sessions}: {parent, child, T_parent_child} of each sensor but the reference, lenses by
 *     camera, and {lidar, camera, samples} of each pair that has a result of its own.
 */
export function readRigResult(folder, rig) {
  const { reference, sensors } = readTree(folder, rig);
  const named = Object.entries(sensors).map(([name, sensor]) => ({ name, ...sensor }));
  const namesOf = (wanted) => named.filter(({ kind }) => kind === wanted).map(({ name }) => name);
  const sessions = namesOf("lidar").flatMap((lidar) =>
    namesOf("camera").flatMap((camera) => sessionOf(folder, lidar, camera)),
  );
  const lenses = {};
  for (const { camera, lens } of sessions) lenses[camera] = lens;
  for (const { name, camera } of named) if (camera) lenses[name] = camera;
  const transforms = named
    .filter(({ name }) => name !== reference)
    .map(({ name, T_reference_sensor }) => ({ parent: reference, child: name, T_parent_child: T_reference_sensor }));
  return { transforms, lenses, sessions, cameras: namesOf("camera") };
}

/** By the program that reads such files. */
function readTree(folder, rig) {
  const file = join(folder, RESULT);
  const program = programPath("export_extrinsic");
  if (!program) throw new UserError(`${file} is read by the program export_extrinsic, which is not built yet (tools/build)`);
  const flags = rig === undefined ? [] : ["--rig", rig];
  const { status, stdout, stderr } = spawnSync(program, [file, "--format", "json", ...flags], { encoding: "utf8" });
  if (status !== 0) throw new UserError(stderr.trim().replace(/^export_extrinsic: /, ""));
  process.stderr.write(stderr);
  return JSON.parse(stdout);
}

/** None or one. */
function sessionOf(folder, lidar, camera) {
  const path = (name) => join(folder, `${lidar}_${camera}`, name);
  if (!existsSync(path("result.json")) || !existsSync(path("samples.lcm"))) return [];
  const { rig } = JSON.parse(readFileSync(path("result.json"), "utf8"));
  return [{ lidar, camera, lens: rig.camera, samples: path("samples.lcm") }];
}
