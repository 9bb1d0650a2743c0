// dashboard_session.mjs SESSION [FOLDER]: a live session in a browser, from its first samples to the export, by
// clicks and keys alone; the server is killed in between. Ends with 1 and a line for each thing that is wrong.
// With FOLDER it leaves screenshots there. 77: no Chromium here.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { SIZES, demand, openSession, problems, say } from "./browser.mjs";

const [session, folder] = process.argv.slice(2);
const { context, page, url, text, until, supervisorctl, killServer, end } = await openSession(session);
page.on("request", (request) => {
  const asked = request.url();
  if (!asked.startsWith(url) && !/^(blob|data):/.test(asked)) problems.push(`asks for ${asked}`);
});

const numSamples = () => page.locator("#samples > li").count();
const untilSamples = (least) =>
  until((least) => document.querySelectorAll("#samples > li").length >= least, least);
const untilAnswered = () => until(() => document.getElementById("waiting").hidden);

/** Runs in the page: what is wrong with it for a hand, a keyboard or a screen reader. */
function inspect() {
  const found = [];
  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth) found.push(`the page is ${root.scrollWidth} px wide`);
  const isShown = (element) => element.checkVisibility();
  for (const button of [...document.querySelectorAll("button")].filter(isShown)) {
    const name = button.getAttribute("aria-label") ?? button.textContent;
    if (!name.trim()) found.push("a button has no name");
    const { height, width } = button.getBoundingClientRect();
    if (height < 32 || width < 32) found.push(`button ${name} is ${width} x ${height} px`);
  }
  const { bottom, top } = document.getElementById("capture").getBoundingClientRect();
  if (top < 0 || bottom > innerHeight) found.push("the capture button is not in sight");
  for (const picture of document.querySelectorAll("canvas, [role=img]")) {
    const hasName = picture.hasAttribute("aria-label") || picture.hasAttribute("aria-labelledby");
    if (!hasName && !picture.closest("[role=img][aria-label]")) found.push("a picture has no name");
  }
  if (/NaN|undefined|null/.test(document.body.innerText)) found.push("the text has NaN, undefined or null");
  return found;
}

async function look(name) {
  await page.setViewportSize(SIZES[name]);
  for (const problem of await page.evaluate(inspect)) problems.push(`${name}: ${problem}`);
  if (folder) await page.screenshot({ path: join(folder, `dashboard_${name}.png`), timeout: 120_000 });
}

async function seeTheSensors() {
  await until(() => document.getElementById("connection").dataset.state === "live");
  await untilSamples(6);
  await until(() => document.getElementById("image").dataset.utime);
  await until(() => document.getElementById("scene").dataset.utime);
  await until(() => document.getElementById("camera-state").textContent.startsWith("board found"));
  await until(() => document.getElementById("guidance").dataset.state);
  say(`guidance: ${await text("advice")}`);
}

async function discardOne() {
  const oldest = page.locator("#samples > li").last();
  const id = await oldest.getAttribute("data-sample");
  await oldest.getByRole("button", { name: `Discard sample ${id}` }).click();
  await until((id) => !document.querySelector(`[data-sample="${id}"]`), id);
  say(`discarded sample ${id}`);
}

// The stop whose sample was discarded may have given another by itself since: "Not taken".
async function captureByKey() {
  await until(() => !document.getElementById("capture").disabled);
  await page.locator("body").press("c");
  await until(() => /^(Sample \d+|Not) taken/.test(document.getElementById("said").textContent));
}

async function surviveTheServer() {
  const before = await numSamples();
  await killServer();
  await untilSamples(before);
  say("found the server again");
}

// The board is laid down first: a sample taken meanwhile would make the exported result that of an earlier set.
async function finish() {
  supervisorctl("stop", "lidar_driver", "camera_driver");
  await until(() => !document.getElementById("stale").hidden);
  await page.getByRole("button", { name: "Finish" }).click();
  await until(() => document.getElementById("finished").textContent !== "");
  await until(() => document.getElementById("verdict").dataset.grade !== "none");
  await until(() => document.getElementById("progress").hidden);
  await untilAnswered();
  say(`verdict: ${await text("verdict")}`);
}

/** A page of its own, as it lies in the session's folder. */
async function readTheReport() {
  await until(() => document.getElementById("report").dataset.state === "made");
  const [report] = await Promise.all([
    context.waitForEvent("page"),
    page.getByRole("link", { name: "The report" }).click(),
  ]);
  report.on("console", (message) => {
    if (message.type() === "error") problems.push(`report: ${message.text()}`);
  });
  await report.reload();
  demand(
    (await (await context.request.get(report.url())).text()) === readFileSync(join(session, "report.html"), "utf8"),
    "the report is not the session's",
  );
  const headline = await report.locator(".verdict strong").innerText();
  demand(headline === (await text("verdict")), `the report says "${headline}", the page ${await text("verdict")}`);
  const width = await report.evaluate(() => getComputedStyle(document.querySelector("main")).maxWidth);
  demand(width !== "none", "the report has no style");
  if (folder) await report.screenshot({ path: join(folder, "dashboard_report.png") });
  await report.close();
  say("the report is there");
}

async function download(name) {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name, exact: true }).click(),
  ]);
  return readFileSync(await file.path(), "utf8");
}

async function exportAll() {
  await page.getByRole("button", { name: "Export" }).click();
  const names = await page.locator("#exports a").allInnerTexts();
  demand(names.length >= 8, `only these can be exported: ${names}`);
  for (const name of names) {
    const bytes = await download(name);
    demand(bytes.length > 100, `${name} has ${bytes.length} bytes`);
    if (name !== "extrinsic.yaml") continue;
    demand(bytes === readFileSync(join(session, name), "utf8"), `${name} is not the session's`);
  }
  await page.getByRole("button", { name: "Close" }).click();
  say(`exported ${names.length} files`);
}

async function reset() {
  await page.getByRole("button", { name: "Reset" }).click();
  await page.getByRole("button", { name: "Keep them" }).click();
  demand((await numSamples()) > 0, "samples were taken away although they were to be kept");
  await page.getByRole("button", { name: "Reset" }).click();
  await page.locator("#confirm-reset").getByRole("button", { name: "Reset" }).click();
  await until(() => /taken away/.test(document.getElementById("said").textContent));
}

await page.setViewportSize(SIZES.phone);
await page.goto(url);
await seeTheSensors();
await look("phone");
await discardOne();
await captureByKey();
await surviveTheServer();
await finish();
await readTheReport();
await look("desktop");
await exportAll();
await reset();
await end();
