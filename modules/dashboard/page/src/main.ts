// The page: what the server says goes to the views, what is clicked goes to the server.

import "uplot/dist/uPlot.min.css";
import "../dashboard.css";
import { Actions } from "./actions.ts";
import { Connection, type ConnectionState } from "./connection.ts";
import { Coverage } from "./coverage.ts";
import { byId, setText } from "./dom.ts";
import { ImageView } from "./image_view.ts";
import { showEvents, showGuidance, showModules, showResult, showSamples } from "./panels.ts";
import type { CameraBoard, ImageFrame, LidarBoard, Message } from "./protocol.ts";
import { SceneView } from "./scene_view.ts";

const STATES: Record<ConnectionState, string> = {
  connecting: "Connecting",
  live: "Live",
  lost: "Connection lost: trying again",
  expired: "This address is no longer valid: open the one that the dashboard prints",
};
const STALE_MS = 3000;

const image = new ImageView(byId("image"), byId("has-points"));
const coverage = new Coverage();
const scene = makeSceneView();
const connection = new Connection(take, (state) => {
  byId("connection").dataset.state = state;
  setText("connection", STATES[state]);
  actions.setLive(state === "live");
});
const actions = new Actions((request) => connection.send(request));
let imageAt = 0;

/** Null where the browser has no WebGL: all else works without. */
function makeSceneView(): SceneView | null {
  try {
    return new SceneView(byId("scene"));
  } catch {
    setText("scene", "This browser cannot draw in three dimensions (no WebGL).");
    return null;
  }
}

async function showImage(frame: ImageFrame): Promise<void> {
  imageAt = performance.now();
  try {
    await image.show(frame);
  } finally {
    connection.send({ shown: "image" });
  }
}

function showCameraBoard(board: CameraBoard): void {
  image.showBoard(board);
  const found = ["board found", ...(board.warnings ?? [])].join(", ");
  setText("camera-state", board.miss ? `${board.miss}${board.detail ? `: ${board.detail}` : ""}` : found);
}

function showLidarBoard(board: LidarBoard): void {
  scene?.showBoard(board);
  setText("lidar-state", board.miss || `board found, ${board.num_points} points`);
}

function take(message: Message): void {
  switch (message.kind) {
    case "image":
      void showImage(message);
      break;
    case "cloud":
      image.showCloud(message);
      scene?.showCloud(message);
      requestAnimationFrame(() => connection.send({ shown: "cloud" }));
      break;
    case "camera_board":
      showCameraBoard(message);
      break;
    case "lidar_board":
      showLidarBoard(message);
      break;
    case "rig":
      document.title = `${message.name}: calibration`;
      setText("rig", message.name);
      coverage.showRig(message);
      break;
    case "samples":
      showSamples(message, (id) => actions.send({ command: "discard", sample_id: id }));
      scene?.showSamples(message);
      coverage.showSamples(message.samples);
      actions.takeSamples(message);
      break;
    case "result":
      showResult(message);
      break;
    case "guidance":
      showGuidance(message);
      image.showGuidance(message);
      scene?.showGuidance(message);
      break;
    case "events":
      showEvents(message);
      actions.takeEvents(message);
      break;
    case "modules":
      showModules(message);
      break;
    case "refused":
      actions.say(`Refused: ${message.reason}`);
      break;
  }
}

setInterval(() => {
  const age = performance.now() - imageAt;
  byId("stale").hidden = imageAt > 0 && age < STALE_MS;
  setText("stale", imageAt === 0 ? "No image yet" : `No image for ${Math.round(age / 1000)} s`);
}, 500);
byId("look-along").addEventListener("click", () => scene?.lookAlong());
connection.open();
