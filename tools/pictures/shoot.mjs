// shoot.mjs PAGE OUT: a picture of a page that draw_views' pictures lie beside (its <main>), of a report (its verdict and
// checks), or of a live session's dashboard (PAGE is the session's folder), once it has a result to show.
import { readFileSync, statSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, until } from "../../test/system/browser.mjs";

const [source, out] = process.argv.slice(2);
const isSession = statSync(source).isDirectory();
const { context, close } = await openBrowser(["--disable-gpu", "--font-render-hinting=none"]);
const page = await context.newPage();
await page.setViewportSize({ width: 1200, height: isSession ? 840 : 900 });

const kind = out.endsWith(".png") ? { type: "png" } : { type: "jpeg", quality: 82 };
if (isSession) {
  await page.goto(readFileSync(join(source, "dashboard_url.txt"), "utf8").trim());
  const untilSamples = (least) =>
    until(page, (least) => document.querySelectorAll("#samples > li").length >= least, least);
  await untilSamples(20);
  await until(page, () => document.getElementById("verdict").dataset.grade !== "none");
  // Points and image of one instant, as they are where the machine keeps up.
  const offsetUs = () => {
    const [image, scene] = ["image", "scene"].map((id) => Number(document.getElementById(id).dataset.utime));
    return Math.abs(image - scene);
  };
  const isOfOneInstant = async () => (await page.evaluate(offsetUs)) <= 150_000;
  for (let isTaken = false; !isTaken; ) {
    await page.waitForTimeout(50);
    if (!(await isOfOneInstant())) continue;
    await page.screenshot({ path: out, ...kind });
    isTaken = await isOfOneInstant();
  }
} else {
  await page.goto(pathToFileURL(resolve(source)).href);
  if (source.endsWith("report.html")) {
    const { y: height } = await page.locator("#transform").boundingBox();
    await page.screenshot({ path: out, ...kind, clip: { x: 0, y: 0, width: 1200, height } });
  } else {
    await page.locator("main").screenshot({ path: out, ...kind });
  }
}
await close();
