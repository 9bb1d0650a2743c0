// What the server says (modules/dashboard/page_state.hpp, sensor_frames.hpp) and what it is told.

export type Point2 = [number, number];
export type Point3 = [number, number, number];
export type Quaternion = [number, number, number, number];

/** A lidar and a camera of a rig of several sensors. */
export interface PairName {
  name: string;
  lidar: string;
  camera: string;
}

export interface Rig {
  kind: "rig";
  name: string;
  /** What all that follows is of; missing where there is but one pair. */
  pair?: PairName;
  camera: {
    width_px: number;
    height_px: number;
    /** Directions of sight round the image's border, in the camera's frame: as many of each side, its corner first. */
    border: Point3[];
  };
}

export interface PairRow extends PairName {
  num_samples: number;
  /** Which of its sensors sends nothing any more; which has sent nothing yet. */
  silent: string;
  unheard: string;
  /** What follows is of the newest samples. */
  is_current: boolean;
  problem: string;
  grade: Grade | "";
  headline: string;
  worst_error?: number | null;
  unit?: string;
  is_enough?: boolean;
}

/** Of a rig of several sensors. */
export interface Pairs {
  kind: "pairs";
  pairs: PairRow[];
  /** Where samples help most, of what can be sampled; empty: not known. */
  next: string;
  /** The rig needs no more samples. */
  is_enough: boolean;
  /** All results are of the newest samples. */
  is_current: boolean;
  /** Why the pairs do not hold the rig together. */
  problem: string;
  /** Of the rig that they are joined to. */
  verdict?: Verdict;
}

export interface Sample {
  id: number;
  num_frames: number;
  distance_m: number;
  e_dim_mm: number | null;
  faces_right_deg: number;
  faces_up_deg: number;
  corners_lidar_m: Point3[];
  outline_px: Point2[] | null;
  warnings: string[];
  left_out?: string;
  held_out_mm?: number | null;
}

export interface Samples {
  kind: "samples";
  revision: number;
  is_finished: boolean;
  samples: Sample[];
}

export type Grade = "good" | "look" | "bad";

export interface Check {
  name: string;
  grade: Grade;
  text: string;
}

export interface Verdict {
  grade: Grade;
  headline: string;
  checks: Check[];
}

export interface Spread {
  mean: number | null;
  std: number | null;
  max: number | null;
}

export interface Result {
  kind: "result";
  working_on: string;
  problem?: string;
  is_current?: boolean;
  method?: string;
  num_samples?: number;
  translation_m?: Point3;
  quaternion_xyzw?: Quaternion;
  sigma_deg?: (number | null)[];
  sigma_mm?: (number | null)[];
  /** Of where the lidar is, as lens and board of the rig file may be off. */
  place_sigma_deg?: (number | null)[];
  place_sigma_mm?: (number | null)[];
  held_out?: { centre_px: Spread; centre_mm: Spread };
  predicted?: { range_m: number; corner_mm: number | null }[];
  verdict?: Verdict;
  exports?: string[];
}

export interface Report {
  kind: "report";
  state: "" | "making" | "made" | "failed";
  file: string;
  /** On the session's host. */
  folder: string;
}

export interface Guidance {
  kind: "guidance";
  problem: string;
  advice: string;
  /** The board's corners from where they are asked to be; null while the board is not seen. */
  away_m: number | null;
  unit: string;
  tolerance: number;
  min_range_m: number;
  max_range_m: number;
  min_samples: number;
  worst_error: number | null;
  predicted_worst_error: number | null;
  is_enough: boolean;
  corners_px?: (number | null)[][];
  corners_lidar_m?: Point3[];
}

export interface Events {
  kind: "events";
  events: { seq: number; event: string; sample_id: number; reason: string; count: number }[];
}

export interface Modules {
  kind: "modules";
  beat: number;
  modules: { name: string; state: string; health: "good" | "ended" | "silent" | "failed" }[];
  faults: Fault[];
  flows: Record<StreamName, Flow>;
}

/** What samples are made of. */
export type StreamName = "lidar" | "camera" | "lidar_board" | "camera_board";
export type Flow = "nothing yet" | "flows" | "silent" | "ended";

export interface Fault {
  of: string;
  what: string;
  cause: string;
  remedy: string;
  is_grave: boolean;
  /** The pair that is shown can work all the same. */
  is_of_others?: boolean;
}

export interface LidarBoard {
  kind: "lidar_board";
  utime: number;
  miss: string;
  corners_lidar_m?: Point3[];
  num_points?: number;
}

export interface CameraBoard {
  kind: "camera_board";
  utime: number;
  miss: string;
  detail: string;
  outline_px?: Point2[] | null;
  corners_px?: Point2[];
  warnings?: string[];
}

export interface ImageFrame {
  kind: "image";
  utime: number;
  width: number;
  height: number;
  /** What was found in this very image; null: not known. */
  board: CameraBoard | null;
  data: Blob;
}

export interface CloudFrame {
  kind: "cloud";
  utime: number;
  num_points: number;
  /** x, y, z of each point in the lidar frame. */
  positions_m: Float32Array;
  /** u, v of each point in the image; null while no extrinsic is known. */
  pixels: Int16Array | null;
}

export interface Refused {
  kind: "refused";
  reason: string;
}

export type Message =
  | Rig
  | Pairs
  | Samples
  | Result
  | Report
  | Guidance
  | Events
  | Modules
  | LidarBoard
  | CameraBoard
  | ImageFrame
  | CloudFrame
  | Refused;

/** A point that the camera does not see. */
export const NOT_SEEN = -32768;

export type CommandName = "capture" | "discard" | "finish" | "reset";
export type Request =
  | { command: CommandName; sample_id?: number; pair?: string }
  | { watch: string }
  | { shown: "image" | "cloud" };

/** A message of the server, whose large ones are a header in JSON with bytes behind it. */
export function decode(data: string | ArrayBuffer): Message {
  if (typeof data === "string") return JSON.parse(data) as Message;
  const length = new DataView(data).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
  const payload = data.slice(4 + length);
  return header.kind === "cloud" ? decodeCloud(header, payload) : decodeImage(header, payload);
}

function decodeImage(header: ImageFrame & { type: string }, payload: ArrayBuffer): ImageFrame {
  return { ...header, data: new Blob([payload], { type: header.type }) };
}

function decodeCloud(
  header: CloudFrame & { scale_m: number; has_pixels: boolean },
  payload: ArrayBuffer,
): CloudFrame {
  const num = header.num_points;
  const units = new Int16Array(payload, 0, 3 * num);
  const positions_m = Float32Array.from(units, (unit) => unit * header.scale_m);
  const pixels = header.has_pixels ? new Int16Array(payload, 6 * num, 2 * num) : null;
  return { ...header, positions_m, pixels };
}
