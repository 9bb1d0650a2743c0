// dashboard_colours.mjs [FOLDER]: the sweep on the page in the image's colours, by a keyboard. The session is a script: a
// wall whose left half the image shows red, whose right half blue, and whose lower half the camera does not see. Ends
// with 1 and a line for each thing that is wrong. With FOLDER it leaves screenshots there. 77: no Chromium here.
import { join } from "node:path";
import { SIZES, demand, openBrowser, problems, say, until } from "./browser.mjs";
import { openScriptedPage } from "./scripted_page.mjs";

const [folder] = process.argv.slice(2);
const { context, close } = await openBrowser();
const { page, load, tell, tellFrame } = await openScriptedPage(context);

const RED = [200, 30, 30];
const BLUE = [30, 30, 200];
const SIZE = { width: 640, height: 400 };
const NOT_SEEN = -32768;
const UTIME = 5_000_000;

/** A wall of 2 x 2 m, 3 m ahead, in millimetres; and where the camera sees it. */
function wall() {
  const points = [];
  const pixels = [];
  for (let y = -1000; y < 1000; y += 20) {
    for (let z = -1000; z < 1000; z += 20) {
      points.push(3000, y, z);
      pixels.push(...(z < 0 ? [NOT_SEEN, NOT_SEEN] : [320 - 0.3 * y, 200 - 0.15 * z].map(Math.round)));
    }
  }
  return { numPoints: points.length / 3, bytes: Buffer.from(Int16Array.from([...points, ...pixels]).buffer) };
}

/** Runs in the page: a PNG of two halves. */
async function twoHalves({ width, height, left, right }) {
  const context = new OffscreenCanvas(width, height).getContext("2d");
  for (const [i, colour] of [left, right].entries()) {
    context.fillStyle = `rgb(${colour})`;
    context.fillRect((i * width) / 2, 0, width / 2, height);
  }
  const blob = await context.canvas.convertToBlob({ type: "image/png" });
  return [...new Uint8Array(await blob.arrayBuffer())];
}

/** Runs in the page: how many pixels of a screenshot have which colour, to 3 of 255. */
async function countPixels({ png, colours }) {
  const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
  const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
  return colours.map((colour) => {
    let num = 0;
    for (let i = 0; i < data.length; i += 4) num += colour.every((value, j) => Math.abs(data[i + j] - value) <= 3);
    return num;
  });
}

/** Runs in the page: what the style sheet gives to points that the camera does not see. */
function unseenColour() {
  const probe = document.body.appendChild(document.createElement("i"));
  probe.style.color = "var(--unseen)";
  const colour = getComputedStyle(probe).color.match(/\d+/g).map(Number);
  probe.remove();
  return colour;
}

async function shownColours(name) {
  await page.waitForTimeout(500); // the view is drawn at its own pace
  const png = (await page.locator("#scene").screenshot()).toString("base64");
  if (folder) await page.screenshot({ path: join(folder, `colours_${name}.png`) });
  const colours = [RED, BLUE, await page.evaluate(unseenColour)];
  const [red, blue, unseen] = await page.evaluate(countPixels, { png, colours });
  say(`${name}: ${red} red, ${blue} blue, ${unseen} unseen`);
  return { red, blue, unseen };
}

async function seeTheWall(scheme) {
  await page.emulateMedia({ colorScheme: scheme });
  await load();
  await tell({ kind: "rig", name: "test_rig", camera: { width_px: SIZE.width, height_px: SIZE.height, border: [] } });
  const png = Buffer.from(await page.evaluate(twoHalves, { ...SIZE, left: RED, right: BLUE }));
  await tellFrame({ kind: "image", utime: UTIME, ...SIZE, type: "image/png", board: null }, png);
  await until(page, () => document.getElementById("image").dataset.utime);
  const { numPoints, bytes } = wall();
  await tellFrame({ kind: "cloud", utime: UTIME, num_points: numPoints, scale_m: 0.001, has_pixels: true }, bytes);
  await until(page, () => document.getElementById("scene").dataset.utime);
  const byRange = await shownColours(`${scheme}_range`);
  demand(byRange.red + byRange.blue < 50, `${scheme}: by range, ${byRange.red} pixels are red, ${byRange.blue} blue`);
  const choice = page.getByRole("checkbox", { name: "image's colours" });
  await choice.focus();
  await page.keyboard.press("Space");
  const byImage = await shownColours(`${scheme}_image`);
  for (const [colour, num] of Object.entries(byImage)) {
    const numMore = num - byRange[colour];
    demand(numMore > 500, `${scheme}: by the image, ${numMore} more pixels are ${colour}`);
  }
  const { height } = await page.locator("label", { has: choice }).boundingBox();
  demand(height >= 32, `the choice is ${height} px high`);
  await page.keyboard.press("Space");
  demand((await shownColours(`${scheme}_range_again`)).red < 50, `${scheme}: by range again, and points are red`);
}

for (const [size, scheme] of [["phone", "dark"], ["desktop", "light"]]) {
  await page.setViewportSize(SIZES[size]);
  await seeTheWall(scheme);
}
await close();
for (const problem of problems) say(problem);
process.exitCode = problems.length === 0 ? 0 : 1;
