// The page: what the server says goes to the views, what is clicked goes to the server.

import "uplot/dist/uPlot.min.css";
import "../dashboard.css";
import { Actions } from "./actions.ts";
import { Connection, type ConnectionState } from "./connection.ts";
import { Coverage } from "./coverage.ts";
import { byId, setText } from "./dom.ts";
import { healthView, type HealthView } from "./health.ts";
import { ImageView } from "./image_view.ts";
import { PairChoice, pairOfHash, pairText, scrollToPair, showPairs } from "./pairs.ts";
import { showEvents, showFaults, showFirstGuidance, showGuidance, showModules, showNoGuidance, showReport, showResult, showSamples } from "./panels.ts";
import type { CameraBoard, Guidance, ImageFrame, LidarBoard, Message, Modules, PairName, Pairs } from "./protocol.ts";
import { SceneView } from "./scene_view.ts";

const STALE_MS = 3000;

const image = new ImageView(byId("image"), byId("has-points"));
const coverage = new Coverage();
const scene = makeSceneView();
const connection = new Connection(take, (state) => {
  connectionState = state;
  // A new connection shows the first pair until it is asked for another.
  if (state === "live") asked = pair && connection.send({ watch: pair.name }) ? pair.name : null;
  showHealth();
});
const actions = new Actions((request) => connection.send(request));
let connectionState: ConnectionState = "connecting";
let modules: Modules | null = null;
let modulesAt = 0;
let guidance: Guidance | null = null;
let shownOrder: Guidance | null = null;
let imageAt = 0;
/** Of a rig of several sensors: its pairs, the one that is shown, and the one that the server was asked for last. */
let pairs: Pairs | null = null;
let pair: PairName | null = null;
let asked: string | null = null;
const choice = new PairChoice(pairOfHash(location.hash));

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

/** What is told of the session's health holds for all else on the page. */
function showHealth(): void {
  const health = healthView(connectionState, modules, performance.now() - modulesAt);
  byId("connection").dataset.state = health.state;
  setText("connection", health.headline);
  showFaults(health.faults);
  actions.setLive(connectionState === "live", health.mayOrder);
  showOrder(health.mayOrder ? guidance : null);
  if (!health.mayOrder) showNoGuidance(health.instead);
  for (const stream of ["camera", "lidar"] as const) showFlow(stream, health.flows);
  const age = performance.now() - imageAt;
  byId("stale").hidden = imageAt > 0 && age < STALE_MS && health.flows.camera !== "silent";
  setText("stale", imageAt === 0 ? "No image yet" : `No image for ${Math.round(age / 1000)} s`);
}

/** Null: nothing would come of one. */
function showOrder(order: Guidance | null): void {
  if (order === shownOrder) return;
  shownOrder = order;
  if (order) showGuidance(order);
  image.showGuidance(order);
  scene?.showGuidance(order);
  showEnough();
}

/** What is stale looks stale: its picture is grey, and what was said of it is said to be over. */
function showFlow(sensor: "camera" | "lidar", flows: HealthView["flows"]): void {
  byId(`${sensor === "camera" ? "image" : "scene"}-panel`).dataset.flow = flows[sensor];
  const flow = flows[sensor] === "flows" ? flows[`${sensor}_board`] : flows[sensor];
  byId(`${sensor}-state`).dataset.flow = flow;
  const isOver = flow === "silent" || flow === "ended";
  setText(`${sensor}-flow`, isOver ? `${flow}; before: ` : "");
}

/** Of several pairs all must have. */
function showEnough(): void {
  actions.setEnough((shownOrder?.is_enough ?? false) && (pairs?.is_enough ?? true));
}

/** Null: the next, whichever it is. */
function choosePair(name: string | null): void {
  choice.choose(name);
  history.replaceState(null, "", name === null ? location.pathname : `#${encodeURIComponent(name)}`);
  followPair();
}

function takePairs(message: Pairs): void {
  pairs = message;
  actions.takePairs(message);
  showPairs(message, pair?.name ?? "", choosePair);
  followPair();
  showPairName();
  showEnough();
}

/** Asks for the pair that is to be shown, if it is another than was asked for last. */
function followPair(): void {
  if (!pairs) return;
  const wanted = choice.wanted(pairs, asked, actions.isBusy(), performance.now());
  byId<HTMLInputElement>("follows").checked = !choice.isOwn();
  if (wanted === asked || !connection.send({ watch: wanted })) return;
  asked = wanted;
  scrollToPair(wanted);
}

function showPairName(): void {
  if (!pair) return;
  const isNext = pairs?.next === pair.name;
  byId("order-of").hidden = false;
  setText("order-of", isNext ? `Next: ${pairText(pair)}` : pairText(pair));
  setText("result-of", pairText(pair));
  setText("image-title", `Camera ${pair.camera}`);
  setText("scene-title", `Lidar ${pair.lidar}`);
}

/** From now on all that comes is of this pair: nothing of another is left. */
function showPair(shown: PairName): void {
  asked ??= shown.name;
  if (pair?.name === shown.name) return;
  pair = shown;
  imageAt = 0;
  guidance = shownOrder = null;
  image.clear();
  scene?.clear();
  showFirstGuidance();
  setText("camera-state", "nothing heard");
  setText("lidar-state", "nothing heard");
  actions.setPair(shown, choice.isOwn() && shown.name === asked);
  take({ kind: "samples", revision: 0, is_finished: false, samples: [] });
  take({ kind: "result", working_on: "" });
  take({ kind: "report", state: "", file: "", folder: "" });
  if (pairs) showPairs(pairs, shown.name, choosePair);
  showPairName();
  showHealth();
}

const folderOfPair = () => (pair ? `${pair.name}/` : "");

function showCameraBoard(board: CameraBoard): void {
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
    case "pairs":
      takePairs(message);
      break;
    case "rig":
      if (message.pair) showPair(message.pair);
      document.title = `${message.name}: calibration`;
      setText("rig", message.name);
      coverage.showRig(message);
      scene?.showRig(message);
      break;
    case "samples":
      showSamples(message, (id) => actions.sendOfPair({ command: "discard", sample_id: id }));
      scene?.showSamples(message);
      coverage.showSamples(message.samples);
      actions.takeSamples(message);
      break;
    case "result":
      showResult(message, folderOfPair());
      scene?.showResult(message);
      break;
    case "report":
      showReport(message, folderOfPair());
      break;
    case "guidance":
      guidance = message;
      showHealth();
      break;
    case "events":
      showEvents(message);
      if (actions.takeEvents(message)) choice.hold(performance.now());
      break;
    case "modules":
      modules = message;
      modulesAt = performance.now();
      showModules(message);
      showHealth();
      break;
    case "refused":
      actions.takeRefusal(message.reason);
      break;
  }
}

setInterval(() => {
  showHealth();
  followPair();
}, 500);
const isColoured = byId<HTMLInputElement>("is-coloured");
const chooseColours = () => scene?.colourBy((cloud) => (isColoured.checked ? image.pixelsFor(cloud) : "range"));
isColoured.addEventListener("change", chooseColours);
chooseColours();
byId("follows").addEventListener("change", (event) => {
  choosePair((event.target as HTMLInputElement).checked ? null : (pair?.name ?? null));
});
addEventListener("hashchange", () => choosePair(pairOfHash(location.hash)));
byId("look-along").addEventListener("click", () => scene?.lookAlong());
connection.open();
