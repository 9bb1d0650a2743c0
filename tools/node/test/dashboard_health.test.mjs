// What the dashboard's page says of faults: they stand first, nothing is ordered in vain, and nothing stale looks new.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const source = fileURLToPath(new URL("../../../modules/dashboard/page/src/health.ts", import.meta.url));
const { text } = buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false }).outputFiles[0];
const { healthView } = await import(`data:text/javascript,${encodeURIComponent(text)}`);

const FLOWING = { lidar: "flows", camera: "flows", lidar_board: "flows", camera_board: "flows" };
const told = (faults = [], flows = {}) => ({ kind: "modules", beat: 1, modules: [], faults, flows: { ...FLOWING, ...flows } });
const fault = (of, what, is_grave = true) => ({ of, what, cause: "why", remedy: "do this", is_grave });

test("a session in which all is well is live, and orders are given", () => {
  const view = healthView("live", told(), 400);
  assert.equal(view.headline, "Live");
  assert.equal(view.state, "live");
  assert.ok(view.mayOrder);
  assert.deepEqual(view.faults, []);
});

for (const stream of Object.keys(FLOWING)) {
  test(`no light is green and nothing is ordered while the ${stream} is silent`, () => {
    const silence = fault(stream, `The ${stream} has sent nothing for 2 s`);
    const view = healthView("live", told([silence], { [stream]: "silent" }), 400);
    assert.equal(view.state, "wrong");
    assert.equal(view.headline, `Wrong: ${stream}`);
    assert.ok(!view.mayOrder);
    assert.match(view.instead, /^Wait with the board\. The .* has sent nothing for 2 s\.$/);
    assert.deepEqual(view.faults, [silence]);
    assert.equal(view.flows[stream], "silent");
  });
}

test("a fault of another pair of the rig is told, and this one goes on", () => {
  const silence = { ...fault("camera rear", "The camera rear has sent nothing for 2 s"), is_of_others: true };
  const view = healthView("live", told([silence]), 400);
  assert.equal(view.state, "wrong");
  assert.equal(view.headline, "Wrong: camera rear");
  assert.ok(view.mayOrder);
  assert.deepEqual(view.faults, [silence]);
  const own = healthView("live", told([silence, fault("disk", "The disk is full")]), 400);
  assert.ok(!own.mayOrder);
  assert.equal(own.instead, "Wait with the board. The disk is full.");
});

test("a fault of another pair is no reason to wait for a sensor of this one", () => {
  const silence = { ...fault("camera rear", "The camera rear has sent nothing for 2 s"), is_of_others: true };
  const view = healthView("live", told([silence], { camera: "nothing yet" }), 400);
  assert.equal(view.headline, "Wrong: camera rear");
  assert.ok(!view.mayOrder);
  assert.equal(view.instead, "Waiting for the camera.");
});

test("clocks apart, two sessions and a full disk halt the orders although all streams flow", () => {
  for (const of of ["sample_collector", "network", "disk"]) {
    const view = healthView("live", told([fault(of, "It is so")]), 400);
    assert.equal(view.state, "wrong");
    assert.ok(!view.mayOrder);
  }
});

test("a dead recorder is wrong, but the board can be moved on", () => {
  const view = healthView("live", told([fault("recorder", "Nothing is recorded")]), 400);
  assert.equal(view.state, "wrong");
  assert.equal(view.headline, "Wrong: recorder");
  assert.ok(view.mayOrder);
});

test("what is over is told, and halts nothing", () => {
  const view = healthView("live", told([fault("network", "Messages were lost", false)]), 400);
  assert.equal(view.state, "live");
  assert.ok(view.mayOrder);
  assert.equal(view.faults.length, 1);
});

test("a server that says nothing more is a fault within 3 s, and what it said is stale", () => {
  const view = healthView("live", told(), 2600);
  assert.equal(view.state, "wrong");
  assert.match(view.faults[0].what, /told nothing for 3 s/);
  assert.equal(view.flows.camera, "silent");
  assert.ok(!view.mayOrder);
});

test("a lost connection is a fault, one that is only being made is none", () => {
  assert.deepEqual(healthView("connecting", null, 0).faults, []);
  assert.deepEqual(healthView("lost", null, 0).faults, []);
  const view = healthView("lost", told(), 0);
  assert.equal(view.faults[0].what, "This page hears nothing of its session");
  assert.ok(!view.mayOrder);
});

test("sensors that ended, or did not begin yet, are waited for without alarm", () => {
  const ended = { lidar: "ended", camera: "ended", lidar_board: "silent", camera_board: "silent" };
  assert.equal(healthView("live", told([], ended), 0).instead, "No more comes from the lidar and the camera.");
  assert.equal(healthView("live", told([], { camera: "nothing yet" }), 0).headline, "Waiting for the camera");
  assert.equal(healthView("live", told([], { camera: "nothing yet" }), 0).state, "waiting");
});
