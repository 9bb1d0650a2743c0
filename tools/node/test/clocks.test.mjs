// Clocks that agree are left alone; others are told, with what is done.

import assert from "node:assert/strict";
import { test } from "node:test";
import { judgeClocks } from "../lib/clocks.mjs";

const START_S = 1_700_000_000;
const ns = (seconds) => BigInt(Math.round(seconds * 1e6)) * 1000n;
/** Ten messages, 0.1 s apart. */
const messages = (stampOf, logOf = (s) => s) =>
  Array.from({ length: 10 }, (_, i) => START_S + 0.1 * i).map((s, i) => ({ logTimeNs: ns(logOf(s)), stampNs: ns(stampOf(s, i)) }));
const camera = messages((s) => s - 0.03);

test("one clock: nothing is said", () => {
  for (const stampOf of [(s) => s, (s) => s - 0.1, (s) => s - 0.4]) {
    assert.deepEqual(judgeClocks(messages(stampOf), camera), { useLogTimes: false });
  }
  // Both on another clock than the recorder's: a recording that was played and recorded again.
  const old = (s) => s - 86400;
  assert.deepEqual(judgeClocks(messages(old), messages((s) => old(s) - 0.05)), { useLogTimes: false });
});

test("clocks that differ: log times, and words", () => {
  const cases = [
    [(s) => s - START_S + 5, /clocks of lidar and camera differ by 53.9 years; log times agree within 0 ms: using them/],
    [(s) => s + 37, /differ by 37 s/],
    [(s) => s + 3600, /differ by 1 h/],
    [(s) => s + 0.08, /differ by 110 ms/],
    [() => 0, /the clouds have no stamps/],
    [() => START_S, /the stamps of the clouds stand still/],
    [(s) => 2 * START_S - s, /the stamps of the clouds run backwards/],
  ];
  for (const [stampOf, words] of cases) {
    const judged = judgeClocks(messages(stampOf), camera);
    assert.ok(judged.useLogTimes);
    assert.match(judged.words, words);
  }
});

test("log times that do not agree either: stamps stay, and that is said", () => {
  const standing = messages((s) => s - START_S, () => START_S);
  assert.equal(judgeClocks(standing, camera).useLogTimes, false);
  const apart = messages((s) => s + 37, (s) => s + 20);
  assert.match(judgeClocks(apart, camera).words, /nor do the times at which they were recorded agree \(\d+(\.\d)? s apart\)$/);
});
