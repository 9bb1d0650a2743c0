// Which pair of a rig of several sensors the page shows, and what it says of each.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const source = fileURLToPath(new URL("../../../modules/dashboard/page/src/pairs.ts", import.meta.url));
const { text } = buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false }).outputFiles[0];
const { PairChoice, pairOfHash, stateOf } = await import(`data:text/javascript,${encodeURIComponent(text)}`);

const row = (name, more = {}) => ({ name, silent: "", unheard: "", is_current: true, problem: "", grade: "", headline: "", num_samples: 0, ...more });
const told = (next) => ({ kind: "pairs", pairs: [row("roof_front"), row("roof_rear")], next, problem: "" });

const wanted = (choice, next, shown = null, isBusy = false, nowMs = 0) => choice.wanted(told(next), shown, isBusy, nowMs);

test("who has chosen nothing sees the next, whichever it is by now", () => {
  const choice = new PairChoice(null);
  assert.equal(wanted(choice, "roof_rear"), "roof_rear");
  assert.equal(wanted(choice, "roof_front", "roof_rear", false, 5000), "roof_front");
  assert.ok(!choice.isOwn());
});

test("the page does not turn to and fro, nor away from a sample that was just taken", () => {
  const choice = new PairChoice(null);
  assert.equal(wanted(choice, "roof_front", "roof_rear", false, 1000), "roof_front");
  assert.equal(wanted(choice, "roof_rear", "roof_front", false, 5999), "roof_front");
  choice.hold(5999);
  assert.equal(wanted(choice, "roof_rear", "roof_front", false, 10_998), "roof_front");
  assert.equal(wanted(choice, "roof_rear", "roof_front", false, 10_999), "roof_rear");
});

test("samples that go on coming do not hold the page for ever while another pair is next", () => {
  const choice = new PairChoice(null);
  for (let nowMs = 0; nowMs < 10_000; nowMs += 2000) {
    choice.hold(nowMs);
    assert.equal(wanted(choice, "roof_rear", "roof_front", false, nowMs), "roof_front");
  }
  choice.hold(10_000);
  assert.equal(wanted(choice, "roof_rear", "roof_front", false, 10_000), "roof_rear");
});

test("the page does not turn while a question is open or a command waits for its answer", () => {
  const choice = new PairChoice(null);
  assert.equal(wanted(choice, "roof_rear", "roof_front", true, 1e6), "roof_front");
  assert.equal(wanted(choice, "roof_rear", "roof_front", false, 1e6), "roof_rear");
});

test("while it is not known which is next, the page stays where it is", () => {
  assert.equal(wanted(new PairChoice(null), "", "roof_rear"), "roof_rear");
  assert.equal(wanted(new PairChoice(null), ""), "roof_front");
});

test("an own choice stays, until it is given up", () => {
  const choice = new PairChoice(null);
  choice.choose("roof_front");
  assert.equal(wanted(choice, "roof_rear", "roof_rear", true), "roof_front");
  assert.ok(choice.isOwn());
  choice.hold(0);
  choice.choose(null);
  assert.equal(wanted(choice, "roof_rear", "roof_front"), "roof_rear");
});

test("of an address that names no pair of this rig the next is shown", () => {
  const choice = new PairChoice("bumper_left");
  assert.equal(wanted(choice, "roof_rear"), "roof_rear");
  assert.ok(!choice.isOwn());
});

test("a fragment names a pair, or is no text at all", () => {
  assert.equal(pairOfHash("#roof_rear"), "roof_rear");
  assert.equal(pairOfHash("#d%C3%A9j%C3%A0_rear"), "déjà_rear");
  assert.equal(pairOfHash(""), null);
  assert.equal(pairOfHash("#100%"), null);
});

test("a silent sensor is told before a problem, that before a verdict", () => {
  const said = { silent: "rear", problem: "not calibrated yet", headline: "Good." };
  assert.equal(stateOf(row("roof_rear", said)), "rear is silent");
  assert.equal(stateOf(row("roof_rear", { ...said, silent: "" })), "not calibrated yet");
  assert.equal(stateOf(row("roof_rear", { ...said, silent: "", unheard: "rear" })), "rear has sent nothing yet");
  assert.equal(stateOf(row("roof_rear", { headline: "Good." })), "Good.");
  assert.equal(stateOf(row("roof_rear", { headline: "Good.", is_current: false })), "Good. (being renewed)");
  assert.equal(stateOf(row("roof_rear")), "no samples yet");
  assert.equal(stateOf(row("roof_rear", { num_samples: 1 })), "being calibrated");
});
