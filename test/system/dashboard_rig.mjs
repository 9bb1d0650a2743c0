// dashboard_rig.mjs SESSION [FOLDER]: a live session of a rig of several sensors in a browser: the pairs, the next
// and the operator's own choice, a camera that falls silent, the end. Ends with 1 and a line for each thing that is
// wrong. With FOLDER it leaves screenshots there. 77: no Chromium here.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { SIZES, demand, openSession, say } from "./browser.mjs";

const [session, folder] = process.argv.slice(2);
const { page, url, text, until, supervisorctl, killServer, end } = await openSession(session);
const button = (name) => page.locator(`[data-pair="${name}"]`);
const shown = () => page.locator('#pairs [aria-pressed="true"]').getAttribute("data-pair");
const titleOf = (name) => name.replace("_", " → ");

async function look(name, what) {
  await page.setViewportSize(SIZES[name]);
  await page.evaluate(() => scrollTo(0, 0));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  demand(wide <= 0, `${name}, ${what}: the page is ${wide} px too wide`);
  const body = await page.evaluate(() => document.body.innerText);
  demand(!/NaN|undefined|null/.test(body), `${name}, ${what}: the text has NaN, undefined or null`);
  const list = await page.locator("#pairs").boundingBox();
  const image = await page.locator("#image-panel").boundingBox();
  demand(list.y >= 0 && list.y < image.y, `${name}, ${what}: the pairs are at ${list.y} px, the image at ${image.y} px`);
  if (folder) await page.screenshot({ path: join(folder, `rig_${what}_${name}.png`), timeout: 120_000 });
}

async function lookAtAll(what) {
  for (const size of ["desktop", "landscape", "phone"]) await look(size, what);
}

async function seeAllPairs() {
  await until(() => document.getElementById("pairs").children.length === 6);
  await until(() => document.getElementById("image").dataset.utime);
  await until(() => document.getElementById("scene").dataset.utime);
  demand((await text("rig")) === "simulated_several", `the rig is called ${await text("rig")}`);
}

/** Who chose nothing sees the weakest that can be sampled, and what to do for it. */
async function followTheNext() {
  await until(() => document.querySelectorAll('#pairs [data-grade]:not([data-grade="none"])').length >= 3);
  await until(() => {
    const pair = document.querySelector('#pairs [aria-pressed="true"]');
    return pair.dataset.isNext === "true" && document.getElementById("order-of").textContent === `Next: ${pair.children[0].textContent}`;
  });
  await until(() => document.getElementById("advice").textContent !== "");
  say(`${await text("order-of")}: ${await text("advice")}`);
}

/** It has samples of its own; what is clicked is of it. */
async function choose(name) {
  await button(name).click();
  await seeAnew(name, {});
  await until(() => document.getElementById("stale").hidden);
  demand((await text("order-of")).endsWith(titleOf(name)), `${name} is chosen, the order is of ${await text("order-of")}`);
  demand((await text("result-of")) === titleOf(name), `${name} is chosen, the result is of ${await text("result-of")}`);
  demand((await text("image-title")) === `Camera ${name.split("_")[1]}`, `the image is of ${await text("image-title")}`);
  demand(!(await page.locator("#follows").isChecked()), "an own choice is not kept");
}

async function keepTheChoice(name) {
  await page.reload();
  await until((name) => document.querySelector('#pairs [aria-pressed="true"]')?.dataset.pair === name, name);
  await until((name) => document.querySelector(`[data-pair="${name}"] .figures`).textContent.startsWith(document.getElementById("sample-count").textContent + " "), name);
}

/** What is shown is of this pair, was drawn after `before`, and its samples are as many as the table says. */
async function seeAnew(name, before) {
  await until(
    ({ name, title, before }) => {
      const { dataset } = document.querySelector('#pairs [aria-pressed="true"]');
      const [image, scene] = ["image", "scene"].map((id) => document.getElementById(id).dataset.utime);
      const figures = document.querySelector(`[data-pair="${name}"] .figures`).textContent;
      const isNew = image && scene && image !== before.image && scene !== before.scene;
      const ofSamples = `${document.getElementById("sample-count").textContent} sample`;
      return dataset.pair === name && document.getElementById("result-of").textContent === title && isNew && figures.startsWith(ofSamples);
    },
    { name, title: titleOf(name), before },
  );
}

/** The server that is started again begins with its first pair. */
async function surviveTheServer(name) {
  const utime = (id) => page.locator(`#${id}`).getAttribute("data-utime");
  const before = {};
  await killServer(async () => {
    for (const id of ["image", "scene"]) before[id] = await utime(id);
  });
  await seeAnew(name, before);
}

async function discardOne(name) {
  await until(() => document.querySelectorAll("#samples > li").length > 0);
  const oldest = page.locator("#samples > li").last();
  const id = await oldest.getAttribute("data-sample");
  await oldest.getByRole("button", { name: `Discard sample ${id}` }).click();
  await until((id) => !document.querySelector(`[data-sample="${id}"]`), id);
  say(`discarded sample ${id} of ${name}`);
}

/** Said first, by its name; who works at a pair without it goes on. */
async function loseACamera() {
  supervisorctl("signal", "STOP", "camera_driver_rear");
  await until(() => /camera rear has sent nothing/.test(document.getElementById("faults").innerText));
  await until(() => document.querySelector('[data-pair="roof_rear"] .state').textContent === "rear is silent");
  demand(!/^Wait with the board/.test(await text("advice")), `of roof_front: ${await text("advice")}`);
  await lookAtAll("silent");
  await page.locator("#follows").check();
  await followTheNext();
  demand(!(await shown()).endsWith("_rear"), `who follows is sent to ${await shown()}, whose camera is silent`);
  demand(!/^Wait with the board/.test(await text("advice")), `who follows is told: ${await text("advice")}`);
  await button("roof_rear").click();
  await until(() => /^Wait with the board\. The camera rear/.test(document.getElementById("advice").textContent));
  supervisorctl("signal", "CONT", "camera_driver_rear");
  // A busy machine may have lost messages, which stays said.
  await until(() => !/camera rear/.test(document.getElementById("faults").innerText));
  await until(() => document.querySelector('[data-pair="roof_rear"] .state').textContent !== "rear is silent");
  say("a silent camera was told");
}

async function finish() {
  await button("roof_front").click();
  await page.getByRole("button", { name: "Finish" }).click();
  await until(() => document.getElementById("finished").textContent !== "");
  await until(() => document.getElementById("rig-verdict").dataset.grade !== "none");
  await until(() => document.getElementById("report").dataset.state === "made");
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page
      .getByRole("button", { name: "Export" })
      .click()
      .then(() => page.getByRole("link", { name: "roof_front/extrinsic.yaml", exact: true }).click()),
  ]);
  demand(download.suggestedFilename() === "roof_front_extrinsic.yaml", `the file is called ${download.suggestedFilename()}`);
  const file = readFileSync(join(session, "roof_front", "extrinsic.yaml"), "utf8");
  demand(readFileSync(await download.path(), "utf8") === file, "the export is not the session's");
  await page.getByRole("button", { name: "Close" }).click();
  say(await text("rig-verdict"));
}

async function resetAll() {
  await page.getByRole("button", { name: "Reset" }).click();
  if (folder) await page.screenshot({ path: join(folder, "rig_reset.png") });
  await page.getByRole("button", { name: "Reset all pairs" }).click();
  await until(() => [...document.querySelectorAll("#pairs .figures")].every(({ textContent }) => /^0 samples/.test(textContent)));
}

await page.setViewportSize(SIZES.phone);
await page.goto(url);
await seeAllPairs();
await look("phone", "begin");
await followTheNext();
await lookAtAll("next");
await choose("bumper_left");
await surviveTheServer("bumper_left");
await choose("roof_front");
await keepTheChoice("roof_front");
await discardOne("roof_front");
await loseACamera();
await page.locator("#follows").check();
await followTheNext();
await finish();
await lookAtAll("finished");
// The sensors are laid down first: what they still see would be a sample of the new session.
supervisorctl("stop", ...["roof", "bumper"].map((name) => `lidar_driver_${name}`));
await resetAll();
await end();
