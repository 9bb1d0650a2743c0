import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";

/** Where a C++ program is: VOQCAL_BIN, beside the tools of an installation, or as it is built; undefined if nowhere. */
export function programPath(name) {
  const root = new URL("../../../", import.meta.url);
  const folders = [new URL("bin/", root), new URL("build/release/bin/", root)].map((folder) => fileURLToPath(folder));
  const paths = [process.env.VOQCAL_BIN && `${process.env.VOQCAL_BIN}/`, ...folders].filter(Boolean).map((folder) => folder + name);
  return paths.find((path) => existsSync(path));
}
