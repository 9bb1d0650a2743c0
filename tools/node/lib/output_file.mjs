// The one file that a program writes, where its user said: --out FILE, and --force.

import { mkdirSync, statSync } from "node:fs";
import { dirname } from "node:path";
import { UserError } from "./command.mjs";

/** Makes the folders that `path` lies in; refuses a file that is there, unless `isForced`. */
export function prepareOutput(path, isForced) {
  const there = statSync(path, { throwIfNoEntry: false });
  if (there?.isDirectory()) throw new UserError(`${path}: is a folder`);
  if (there && !isForced) throw new UserError(`${path}: is there already (--force overwrites it)`);
  try {
    mkdirSync(dirname(path), { recursive: true });
  } catch (error) {
    throw new UserError(`${dirname(path)}: cannot make the folder: ${error.message}`);
  }
}
