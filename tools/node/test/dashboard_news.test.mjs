// The dashboard page's sense of what is news.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const source = fileURLToPath(new URL("../../../modules/dashboard/page/src/news.ts", import.meta.url));
const { text } = buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false }).outputFiles[0];
const { News } = await import(`data:text/javascript,${encodeURIComponent(text)}`);

/** Events of these numbers, the newest first. */
const events = (...numbers) => numbers.map((seq) => ({ seq, event: "accepted", sample_id: 0, reason: "", count: 1 }));
const numbers = (news) => news.map(({ seq }) => seq);

test("what was before the page was opened is no news", () => {
  const news = new News();
  assert.deepEqual(news.since(events(7, 6)), []);
  assert.deepEqual(numbers(news.since(events(9, 8, 7, 6))), [9, 8]);
  assert.deepEqual(numbers(news.since(events(9, 8, 7, 6))), []);
});

test("the first event of all is news to a page that was open before it", () => {
  const news = new News();
  assert.deepEqual(news.since([]), []);
  assert.deepEqual(numbers(news.since(events(0))), [0]);
});

test("a collector that was started again counts anew, and old events stay old", () => {
  const news = new News();
  news.since(events(12, 11, 10));
  assert.deepEqual(numbers(news.since(events(0, 12, 11, 10))), [0]);
  assert.deepEqual(numbers(news.since(events(1, 0, 12, 11, 10))), [1]);
  // One that was told may be gone: rejects for one reason are one line.
  assert.deepEqual(numbers(news.since(events(2, 0, 12, 11, 10))), [2]);
});
