// bundle.mjs FOLDER: makes the page: one script, one style sheet, one document.
import { copyFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const folder = dirname(fileURLToPath(import.meta.url));
const require = createRequire(new URL("../../../tools/node/package.json", import.meta.url));
const { build } = require("esbuild");

const out = process.argv[2];
await build({
  entryPoints: [join(folder, "src/main.ts")],
  outfile: join(out, "dashboard.js"),
  nodePaths: [dirname(dirname(require.resolve("uplot/package.json")))],
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "inline",
  logLevel: "warning",
});
copyFileSync(join(folder, "index.html"), join(out, "index.html"));
