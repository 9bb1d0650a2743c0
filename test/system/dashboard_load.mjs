// dashboard_load.mjs SESSION SECONDS: opens the page under fast sensors whose times are those of the wall clock, and
// prints how many images and sweeps a second it shows and how old what it shows is. 77: no Chromium here.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { SIZES, openBrowser, until } from "./browser.mjs";

const [session, seconds] = process.argv.slice(2);
const { context, close } = await openBrowser();
const page = await context.newPage();
await page.setViewportSize(SIZES.phone);
await page.goto(readFileSync(join(session, "dashboard_url.txt"), "utf8").trim());
for (const id of ["image", "scene"]) {
  await until(page, (id) => document.getElementById(id).dataset.utime, id);
}
const figures = await page.evaluate(async (seconds) => {
  const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  const seen = { image: new Set(), scene: new Set() };
  const ages = { image: [], scene: [] };
  const end = performance.now() + 1000 * seconds;
  while (performance.now() < end) {
    for (const id of ["image", "scene"]) {
      const { utime } = document.getElementById(id).dataset;
      seen[id].add(utime);
      ages[id].push(Date.now() / 1000 - Number(utime) / 1e6);
    }
    await wait(20);
  }
  const of = (id) => {
    const late = ages[id].slice(ages[id].length / 2).sort((a, b) => a - b);
    return { rate_hz: seen[id].size / seconds, median_age_s: late[late.length >> 1], largest_age_s: late.at(-1) };
  };
  return { image: of("image"), cloud: of("scene") };
}, Number(seconds));
process.stdout.write(`${JSON.stringify(figures)}\n`);
await close();
