// Which pair of a rig of several sensors the page shows, and what it says of each.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const source = fileURLToPath(new URL("../../../modules/dashboard/page/src/pairs.ts", import.meta.url));
const { text } = buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false }).outputFiles[0];
const { PairChoice, stateOf } = await import(`data:text/javascript,${encodeURIComponent(text)}`);

const row = (name, more = {}) => ({ name, silent: "", problem: "", grade: "", headline: "", num_samples: 0, ...more });
const told = (weakest) => ({ kind: "pairs", pairs: [row("roof_front"), row("roof_rear")], weakest, problem: "" });

test("who has chosen nothing sees the weakest, whichever it is by now", () => {
  const choice = new PairChoice(null);
  assert.equal(choice.wanted(told("roof_rear")), "roof_rear");
  assert.equal(choice.wanted(told("roof_front")), "roof_front");
  assert.ok(!choice.isOwn());
});

test("an own choice stays, until it is given up", () => {
  const choice = new PairChoice(null);
  choice.choose("roof_front");
  assert.equal(choice.wanted(told("roof_rear")), "roof_front");
  assert.ok(choice.isOwn());
  choice.choose(null);
  assert.equal(choice.wanted(told("roof_rear")), "roof_rear");
});

test("of an address that names no pair of this rig the weakest is shown", () => {
  assert.equal(new PairChoice("bumper_left").wanted(told("roof_rear")), "roof_rear");
});

test("a silent sensor is told before a problem, that before a verdict", () => {
  const said = { silent: "rear", problem: "not calibrated yet", headline: "Good." };
  assert.equal(stateOf(row("roof_rear", said)), "rear is silent");
  assert.equal(stateOf(row("roof_rear", { ...said, silent: "" })), "not calibrated yet");
  assert.equal(stateOf(row("roof_rear", { headline: "Good." })), "Good.");
  assert.equal(stateOf(row("roof_rear")), "not heard yet");
});
