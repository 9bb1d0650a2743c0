// The dashboard's page without its server: what that would say is put into the page as a WebSocket would.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { problems } from "./browser.mjs";

const require = createRequire(new URL("../../tools/node/package.json", import.meta.url));
const pageFolder = fileURLToPath(new URL("../../modules/dashboard/page", import.meta.url));

/** The page as bundle.mjs makes it, in memory: by name. */
function pageFiles() {
  const { outputFiles } = require("esbuild").buildSync({
    entryPoints: [join(pageFolder, "src/main.ts")],
    outfile: "/dashboard.js",
    nodePaths: [fileURLToPath(new URL("../../tools/node/node_modules", import.meta.url))],
    bundle: true,
    format: "esm",
    target: "es2022",
    write: false,
  });
  const files = { "index.html": readFileSync(join(pageFolder, "index.html")) };
  for (const { path, contents } of outputFiles) files[path.split("/").at(-1)] = Buffer.from(contents);
  return files;
}

/** Runs in the page before its script: a server that says what the test puts into window.say. */
function standInForTheServer() {
  window.WebSocket = class {
    static OPEN = 1;
    readyState = 1;
    constructor() {
      window.say = (data) => this.onmessage({ data });
      setTimeout(() => this.onopen());
    }
    send() {}
  };
}

/** A header with bytes behind it, as modules/dashboard/slot.hpp has it. */
function frameOf(header, payload) {
  const json = Buffer.from(JSON.stringify(header));
  const length = Buffer.alloc(4);
  length.writeUInt32LE(json.length);
  return Buffer.concat([length, json, payload]);
}

/** A page; `load` loads it anew, `tell` and `tellFrame` say something to it. */
export async function openScriptedPage(context) {
  const page = await context.newPage();
  page.on("pageerror", (error) => problems.push(error.message));
  const files = pageFiles();
  await page.route("http://session.test/**", (route) => {
    const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
    const type = { html: "text/html", js: "text/javascript", css: "text/css" }[name.split(".").at(-1)];
    return files[name] ? route.fulfill({ body: files[name], contentType: type }) : route.fulfill({ status: 404 });
  });
  await page.addInitScript(standInForTheServer);
  const load = async () => {
    await page.goto("http://session.test/");
    while (!(await page.evaluate(() => typeof window.say === "function"))) await page.waitForTimeout(20);
  };
  const tell = (message) => page.evaluate((text) => window.say(text), JSON.stringify(message));
  const tellFrame = (header, payload) =>
    page.evaluate(
      (base64) => window.say(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer),
      frameOf(header, payload).toString("base64"),
    );
  return { page, load, tell, tellFrame };
}
