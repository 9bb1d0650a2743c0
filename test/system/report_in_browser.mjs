// report_in_browser.mjs REPORT [FOLDER]: opens a report as people do, in a browser at the sizes of a desk and a
// phone, and ends with 1 and a line for each thing that is wrong. With FOLDER it leaves screenshots there.
// 77: no Chromium here.
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { SIZES, openBrowser } from "./browser.mjs";

const SECTIONS = {
  "report.html": ["transform", "coloured", "errors", "sets", "lidar", "scene", "diagnosis", "poses", "rejected", "made-from"],
  "no_result.html": ["counts", "misses"],
};
const MAX_PICTURE_HEIGHT = 12_000;

/** Runs in the page: what is wrong with it. */
function inspect(sections) {
  const problems = [];
  const demand = (is_met, problem) => {
    if (!is_met) problems.push(problem);
  };
  const root = document.documentElement;
  demand(root.scrollWidth <= root.clientWidth, `the page is ${root.scrollWidth} px wide`);
  for (const block of document.querySelectorAll("pre")) {
    demand(block.scrollWidth <= block.clientWidth, `"${block.textContent.trim().slice(0, 20)}..." is cut off`);
  }
  for (const id of sections) {
    const section = document.getElementById(id);
    demand(section && section.textContent.trim().length > 40, `section ${id} is missing or empty`);
  }
  for (const figure of document.querySelectorAll("figure")) {
    demand(figure.querySelector("figcaption")?.textContent.length > 5, "a figure has no caption");
  }
  for (const chart of document.querySelectorAll("svg")) {
    const name = chart.getAttribute("aria-label");
    demand(name, "a chart has no name");
    const numLabels = chart.querySelectorAll(".label").length;
    demand(numLabels === 2 || chart.querySelector(".cell"), `chart ${name}: ${numLabels} axes are named`);
    demand(!/NaN|Infinity|undefined/.test(chart.outerHTML), `chart ${name} has no numbers`);
  }
  for (const picture of document.images) {
    demand(picture.alt && picture.naturalWidth > 0, `a picture is broken or unnamed: ${picture.alt}`);
  }
  demand(!/NaN|None|undefined|\{\{/.test(document.body.innerText), "the text has NaN, None or undefined");
  return problems;
}

const [report, folder] = process.argv.slice(2);
const url = pathToFileURL(resolve(report)).href;
const { context, close } = await openBrowser(["--disable-gpu"]);
const problems = [];
for (const [name, size] of Object.entries(SIZES)) {
  const page = await context.newPage();
  await page.setViewportSize(size);
  page.on("console", (message) => problems.push(`${name}: console ${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => problems.push(`${name}: ${error.message}`));
  page.on("request", (request) => {
    const asked = request.url();
    if (asked !== url && !asked.startsWith("data:")) problems.push(`${name}: asks for ${asked}`);
  });
  await page.goto(url);
  for (const problem of await page.evaluate(inspect, SECTIONS[basename(report)])) problems.push(`${name}: ${problem}`);
  const loadMs = await page.evaluate(() => performance.getEntriesByType("navigation")[0].loadEventEnd);
  process.stdout.write(`${name}: shown after ${Math.round(loadMs)} ms\n`);
  if (folder) {
    const fullHeight = await page.evaluate(() => document.documentElement.scrollHeight);
    const clip = { x: 0, y: 0, width: size.width, height: Math.min(fullHeight, MAX_PICTURE_HEIGHT) };
    await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true, clip });
  }
  await page.close();
}
await close();
for (const problem of problems) process.stdout.write(`${problem}\n`);
process.exitCode = problems.length === 0 ? 0 : 1;
