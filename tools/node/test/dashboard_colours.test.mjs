// The colours of a sweep's points, and of the style sheet, on the dashboard's page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

function importSource(name) {
  const source = fileURLToPath(new URL(`../../../modules/dashboard/page/src/${name}`, import.meta.url));
  const { text } = buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false }).outputFiles[0];
  return import(`data:text/javascript,${encodeURIComponent(text)}`);
}
const { cloudColours } = await importSource("cloud_colours.ts");
const { themeColour } = await importSource("colours.ts");

const UNSEEN = [0.5, 0.25, 0.125]; // as a Float32Array has them
const NOT_SEEN = -32768;
/** A camera's image of 4 x 4 pixels at half its size: red, green; blue, white. */
const IMAGE = {
  data: [255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255],
  width: 2,
  height: 2,
  scale: 0.5,
};
/** Of points that are 1 m, 2 m, ... away. */
const cloud = (pixels) => ({
  positions_m: Float32Array.from({ length: 12 }, (_, i) => (i % 3 === 0 ? 1 + i / 3 : 0)),
  pixels: pixels && Int16Array.from(pixels),
});
const colours = (...of) => {
  const all = [...cloudColours(...of)];
  return [0, 3, 6, 9].map((i) => all.slice(i, i + 3));
};

test("a point has the colour of the image where the camera sees it", () => {
  const shown = colours(cloud([0, 0, 2, 1, 1, 3, 3, 2]), IMAGE, UNSEEN);
  assert.deepEqual(shown, [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]);
});

test("a point that the camera does not see is dim, not of its range's colour", () => {
  const shown = colours(cloud([NOT_SEEN, NOT_SEEN, 2, 1, NOT_SEEN, NOT_SEEN, 0, 0]), IMAGE, UNSEEN);
  assert.deepEqual(shown, [UNSEEN, [0, 1, 0], UNSEEN, [1, 0, 0]]);
});

test("by range, a point has the colour of its range", () => {
  const [near, , , far] = colours(cloud([0, 0, 2, 1, 1, 3, 3, 2]), "range", UNSEEN);
  assert.ok(near[0] > 0.9 && near[2] < 0.2, `at 1 m: ${near}`);
  assert.notDeepEqual(near, far);
});

test("without an image, or an extrinsic, all points are dim", () => {
  const dim = [UNSEEN, UNSEEN, UNSEEN, UNSEEN];
  assert.deepEqual(colours(cloud([0, 0, 2, 1, 1, 3, 3, 2]), null, UNSEEN), dim);
  assert.deepEqual(colours(cloud(null), IMAGE, UNSEEN), dim);
});

test("a colour of the style sheet is computed once for each scheme", () => {
  let isDark = false;
  let numComputed = 0;
  globalThis.matchMedia = () => ({ matches: isDark });
  globalThis.document = { createElement: () => ({ style: {}, remove() {} }), body: { append() {} } };
  globalThis.getComputedStyle = ({ style }) => {
    numComputed += 1;
    return { color: `${style.color} ${isDark ? "dark" : "light"}` };
  };
  const ask = () => [themeColour("unseen"), themeColour("accent"), themeColour("unseen")];
  assert.deepEqual(ask(), ["var(--unseen) light", "var(--accent) light", "var(--unseen) light"]);
  isDark = true;
  assert.deepEqual(ask(), ["var(--unseen) dark", "var(--accent) dark", "var(--unseen) dark"]);
  isDark = false;
  assert.equal(themeColour("unseen"), "var(--unseen) light");
  assert.equal(numComputed, 4);
});
