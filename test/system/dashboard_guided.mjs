// dashboard_guided.mjs SESSION [FOLDER]: a live session whose board is held where the page asks, until the page says
// that it is enough; finished and exported by clicks. The sensors are switched on (in SESSION/sensors) once the page is
// open. Prints what the page said, and ends with 1 and a line for each thing that is wrong. With FOLDER it leaves
// screenshots there. 77: no Chromium here.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { SIZES, demand, openSession, say } from "./browser.mjs";

const [session, folder] = process.argv.slice(2);
const { page, url, text, until, end } = await openSession(session);

function switchSensorsOn() {
  const up = fileURLToPath(new URL("../../tools/up", import.meta.url));
  const sensors = join(session, "sensors");
  execFileSync(up, [join(session, "rig.yaml"), "--session", sensors, "--only", "lidar_driver,camera_driver"]);
}

async function look(name, size) {
  if (!folder) return;
  await page.setViewportSize(SIZES[size]);
  await page.screenshot({ path: join(folder, `guided_${name}_${size}.png`), timeout: 120_000 });
}

/** Every advice that was given, with how many samples there were then. */
async function followTheGuidance() {
  const said = [];
  while ((await page.locator("#guidance").getAttribute("data-state")) !== "enough") {
    const advice = await text("advice");
    if (said.at(-1) !== advice) {
      said.push(advice);
      say(`${await text("sample-count")} samples: ${advice} ${await text("advice-why")}`);
      if (said.length === 5) for (const size of ["phone", "desktop"]) await look("under_way", size);
    }
    await page.waitForTimeout(200);
  }
  say(`${await text("sample-count")} samples: ${await text("advice")}`);
  demand(said.length >= 3, `only this was asked: ${said}`);
  demand(/^Enough/.test(await text("advice")), `it ended in: ${await text("advice")}`);
}

async function finish() {
  await page.getByRole("button", { name: "Finish" }).click();
  await until(() => document.getElementById("finished").textContent !== "");
  await until(() => document.getElementById("verdict").dataset.grade !== "none");
  await until(() => document.getElementById("progress").hidden);
  say(`verdict: ${await text("verdict")}`);
}

async function exportResult() {
  await until(() => !document.getElementById("export").disabled);
  await page.getByRole("button", { name: "Export" }).click();
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "extrinsic.yaml", exact: true }).click(),
  ]);
  const bytes = readFileSync(await file.path(), "utf8");
  demand(bytes === readFileSync(join(session, "extrinsic.yaml"), "utf8"), "what was exported is not the session's");
  await page.getByRole("button", { name: "Close" }).click();
}

await page.setViewportSize(SIZES.phone);
await page.goto(url);
await until(() => document.getElementById("connection").dataset.state !== "connecting");
switchSensorsOn();
await followTheGuidance();
await finish();
await exportResult();
for (const size of ["phone", "desktop"]) await look("end", size);
await end();
