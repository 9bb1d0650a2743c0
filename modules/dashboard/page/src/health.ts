// What the page may say of the session's health: a fault first, nothing stale as if it were new, no orders in vain.

import type { ConnectionState } from "./connection.ts";
import type { Fault, Flow, Modules, StreamName } from "./protocol.ts";

export interface HealthView {
  /** Of the light in the header. */
  state: "connecting" | "live" | "waiting" | "wrong" | "lost" | "expired";
  headline: string;
  /** The gravest first. */
  faults: Fault[];
  /** What the operator does comes to something. */
  mayOrder: boolean;
  /** Said in place of an order while there is none; empty if there may be one. */
  instead: string;
  /** What comes of each stream; a page that is told nothing knows nothing. */
  flows: Record<StreamName, Flow>;
}

const HEADLINES: Record<Exclude<ConnectionState, "live">, string> = {
  connecting: "Connecting",
  lost: "Connection lost: trying again",
  expired: "This address is no longer valid: open the one that the dashboard prints",
};
/** The server says something each second. */
const UNTOLD_MS = 2500;
/** The board can be moved on while these are mended. */
const BESIDE_THE_BOARD = ["recorder", "supervisor"];
const NOTHING: Record<StreamName, Flow> = {
  lidar: "nothing yet",
  camera: "nothing yet",
  lidar_board: "nothing yet",
  camera_board: "nothing yet",
};

/** @param toldMs  how long ago `modules` came. */
export function healthView(connection: ConnectionState, modules: Modules | null, toldMs: number): HealthView {
  if (connection !== "live") return cutOff(connection, modules !== null);
  if (!modules) return halted("waiting", "Waiting for the session", [], NOTHING);
  if (toldMs > UNTOLD_MS) return halted("wrong", "Nothing new", [untold(toldMs)], silent(modules.flows));
  const grave = modules.faults.filter((fault) => fault.is_grave);
  const flows = modules.flows;
  const allFlow = Object.values(flows).every((flow) => flow === "flows");
  if (allFlow && grave.every(isBesideTheBoard)) {
    return {
      state: grave.length === 0 ? "live" : "wrong",
      headline: grave.length === 0 ? "Live" : headlineOf(grave),
      faults: modules.faults,
      mayOrder: true,
      instead: "",
      flows,
    };
  }
  if (grave.length > 0) return halted("wrong", headlineOf(grave), modules.faults, flows, waitingFor(flows));
  return halted("waiting", waitingFor(flows), modules.faults, flows);
}

function isBesideTheBoard({ of, is_of_others }: Fault): boolean {
  return BESIDE_THE_BOARD.includes(of) || is_of_others === true;
}

function headlineOf(grave: Fault[]): string {
  return grave.length === 1 ? `Wrong: ${grave[0]!.of}` : `${grave.length} things are wrong`;
}

/** @param waiting  said where no fault is the reason to wait. */
function halted(
  state: HealthView["state"],
  headline: string,
  faults: Fault[],
  flows: Record<StreamName, Flow>,
  waiting = headline,
): HealthView {
  const reason = faults.find((fault) => fault.is_grave && !isBesideTheBoard(fault));
  const instead = reason ? `Wait with the board. ${reason.what}.` : `${waiting}.`;
  return { state, headline, faults, mayOrder: false, instead, flows };
}

function cutOff(connection: Exclude<ConnectionState, "live">, wasLive: boolean): HealthView {
  const fault: Fault = {
    of: "dashboard",
    what: "This page hears nothing of its session",
    cause: "the dashboard or the network between does not answer",
    remedy: "It is found again by itself once it runs; tools/status tells whether it does.",
    is_grave: true,
  };
  const isFault = connection === "lost" && wasLive;
  return halted(connection, HEADLINES[connection], isFault ? [fault] : [], NOTHING);
}

function untold(toldMs: number): Fault {
  return {
    of: "dashboard",
    what: `This page has been told nothing for ${Math.round(toldMs / 1000)} s`,
    cause: "the dashboard hangs, or its computer is too busy",
    remedy: "tools/status tells more.",
    is_grave: true,
  };
}

function silent(flows: Record<StreamName, Flow>): Record<StreamName, Flow> {
  const dead = (flow: Flow): Flow => (flow === "flows" ? "silent" : flow);
  return {
    lidar: dead(flows.lidar),
    camera: dead(flows.camera),
    lidar_board: dead(flows.lidar_board),
    camera_board: dead(flows.camera_board),
  };
}

function waitingFor(flows: Record<StreamName, Flow>): string {
  const sensors = (["lidar", "camera"] as const).filter((sensor) => flows[sensor] !== "flows");
  if (sensors.length === 0) return "Waiting for the board detectors";
  const names = sensors.map((sensor) => `the ${sensor}`).join(" and ");
  return sensors.every((sensor) => flows[sensor] === "ended")
    ? `No more comes from ${names}`
    : `Waiting for ${names}`;
}
