// dashboard_faults.mjs [FOLDER]: what the page says of each fault, at the size of a desktop and of a phone, upright and on its side. The session is
// a script: what its server says is put into the page as a WebSocket would. Ends with 1 and a line for each thing that is
// wrong. With FOLDER it leaves screenshots there. 77: no Chromium here.
import { join } from "node:path";
import { SIZES, demand, openBrowser, problems, say } from "./browser.mjs";
import { openScriptedPage } from "./scripted_page.mjs";

const [folder] = process.argv.slice(2);

const FLOWING = { lidar: "flows", camera: "flows", lidar_board: "flows", camera_board: "flows" };
/** Lines of sight through the corners of the image. */
const BORDER = [[-0.6, -0.4, 0.7], [0.6, -0.4, 0.7], [0.6, 0.4, 0.7], [-0.6, 0.4, 0.7]];
const NAMES = ["lidar_driver", "camera_driver", "lidar_board_detector", "camera_board_detector", "sample_collector"];
const fault = (of, what, cause, remedy) => ({ of, what, cause, remedy, is_grave: true });
const CHECK = "lidar_driver.txt in the session's folder says more.";
const CLOCKS = fault(
  "sample_collector",
  "The camera's clock is 3600.0 s (60 min) ahead of the lidar's, so that no two frames are of one time",
  "",
  "Set both by one clock (PTP or NTP) and start them again.",
);
/** Name, faults, what does not flow, and whether there may still be orders. */
const FAULTS = [
  ["lidar", [fault("lidar", "The lidar has sent nothing for 3 s", "lidar_driver ended (exit status 1); its last words: cannot bind 192.168.1.77:2368", `Check the lidar's power, cable and address in the rig file; ${CHECK}`)], { lidar: "silent", lidar_board: "silent" }, false],
  ["camera", [fault("camera", "The camera has sent nothing for 3 s", "camera_driver has not answered for 3 s", "Check the camera's power, cable and address in the rig file.")], { camera: "silent", camera_board: "silent" }, false],
  ["detector", [fault("camera_board_detector", "camera_board_detector has sent nothing for 2 s", "", CHECK)], { camera_board: "silent" }, false],
  ["disk", [fault("disk", "The disk is full", "samples and recording lie in the session's folder", "Make room there."), fault("recorder", "Nothing is recorded", "lcm-logger ended", "What is not recorded cannot be calibrated again.")], {}, false],
  ["recorder", [fault("recorder", "The recording has not grown for 4 s", "lcm-logger runs, and writes nothing", "lcm-logger.txt says more.")], {}, true],
  ["clocks", [CLOCKS], {}, false],
  ["two_sessions", [fault("network", "Two sessions run on one network", "assessor of a:/one and of b:/two runs on this network", "Stop one of them (tools/down), or give it another port in lcm.url.")], {}, false],
];

const { context, close } = await openBrowser();
const { page, tell, load } = await openScriptedPage(context);
const text = (id) => page.locator(`#${id}`).innerText();
const tellHealth = (faults, flows) =>
  tell({
    kind: "modules",
    beat: 0,
    modules: NAMES.map((name) => ({ name, state: "running", health: "good" })),
    faults,
    flows: { ...FLOWING, ...flows },
  });

async function begin() {
  await load();
  await tell({ kind: "rig", name: "test_rig", camera: { width_px: 640, height_px: 400, border: BORDER } });
  await tell({ kind: "result", working_on: "", translation_m: [0.06, -0.1, -0.04], quaternion_xyzw: [0.5, -0.5, 0.5, 0.5] });
  await tell({ kind: "camera_board", utime: 1, miss: "", detail: "", outline_px: null, corners_px: [], warnings: [] });
  await tell({ kind: "lidar_board", utime: 1, miss: "", num_points: 300 });
  await tell({
    kind: "guidance", problem: "", advice: "Move the board 40 cm to the right.", away_m: 0.4, unit: "mm", tolerance: 5, min_range_m: 2,
    max_range_m: 6, min_samples: 8, worst_error: 12, predicted_worst_error: 9, is_enough: false,
  });
}

/** Runs in the page: where the faults stand. */
const placeOfFaults = () => {
  const box = document.getElementById("faults").getBoundingClientRect();
  return { top: box.top, right: box.right, width: innerWidth, isFirst: box.top < document.getElementById("image-panel").getBoundingClientRect().top };
};

async function seeThatAllIsWell(size) {
  await tellHealth([], {});
  demand((await text("connection")) === "Live", `all is well, and the light says ${await text("connection")}`);
  demand(!(await page.locator("#faults").isVisible()), "faults are shown where there are none");
  demand(/^Move the board 40 cm/.test(await text("advice")), `the order is ${await text("advice")}`);
  demand(await page.locator("#capture").isEnabled(), "capture is off although all is well");
  if (folder) await page.screenshot({ path: join(folder, `well_${size}.png`) });
}

async function seeTheFault([name, faults, flows, mayOrder], size) {
  await tellHealth(faults, flows);
  const at = `${name}, ${size}`;
  const shown = await text("faults");
  for (const each of faults) {
    for (const part of [each.what, each.remedy]) demand(shown.includes(part), `${at}: not said: ${part}`);
  }
  const place = await page.evaluate(placeOfFaults);
  demand(place.isFirst && place.top >= 0 && place.top < 120, `${at}: the fault is at ${place.top} px`);
  demand(place.right <= place.width, `${at}: the fault is wider than the page`);
  demand((await text("connection")) !== "Live", `${at}: the light says Live`);
  demand(/^Move/.test(await text("advice")) === mayOrder, `${at}: the order is ${await text("advice")}`);
  demand((await page.locator("#capture").isEnabled()) === mayOrder, `${at}: capture is wrongly on or off`);
  for (const sensor of ["camera", "lidar"]) {
    const isStale = flows[sensor] === "silent" || flows[`${sensor}_board`] === "silent";
    const isSaid = /^silent; before: /.test(await text(`${sensor}-flow`));
    demand(isSaid === isStale, `${at}: ${sensor} is said to be "${await text(`${sensor}-flow`)}"`);
  }
  if (folder) await page.screenshot({ path: join(folder, `fault_${name}_${size}.png`) });
}

/** The server is there, and says nothing more. */
async function seeThatItHangs(size) {
  const start = Date.now();
  while (!/told nothing/.test(await text("faults")) && Date.now() < start + 5000) await page.waitForTimeout(50);
  const seconds = (Date.now() - start) / 1000;
  demand(seconds < 3.3, `${size}: a server that hangs is told after ${seconds} s`);
  demand(/^Wait with the board/.test(await text("advice")), `a server hangs, and the order is ${await text("advice")}`);
}

for (const size of ["phone", "landscape", "desktop"]) {
  await page.setViewportSize(SIZES[size]);
  await begin();
  await seeThatAllIsWell(size);
  for (const each of FAULTS) await seeTheFault(each, size);
  await seeThatAllIsWell(size);
}
await seeThatItHangs("desktop");
await close();
say(`${FAULTS.length} faults at three sizes`);
for (const problem of problems) say(problem);
process.exitCode = problems.length === 0 ? 0 : 1;
