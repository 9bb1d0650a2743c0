// PointCloud2 to pointcloud2_t. The layout stays; fields get the names that voqcal knows, and times become
// seconds after the stamp. What they count, and from when, is told by their range in a recording's first clouds.

import { UserError } from "../command.mjs";
import { LIVOX_CLOUDS, livoxToCloud } from "./livox.mjs";
import { buffer, stampOf } from "./messages.mjs";

// What a field is by its name in small letters; the first that is there counts.
const NAMES = {
  x: ["x"],
  y: ["y"],
  z: ["z"],
  intensity: ["intensity", "intensities", "reflectivity", "reflectance", "remission", "i", "scalar_intensity"],
  ring: ["ring", "channel", "line", "laser_id", "laserid", "beam", "scalar_ring"],
  time: ["time", "t", "timestamp", "time_stamp", "offset_time", "time_offset", "timeoffset", "scalar_time"],
  return_number: ["return_number", "returnnumber", "return_num", "echo_number", "echo", "scalar_returnnumber"],
};
/** Every name that a field of a point is looked for by. */
export const FIELD_NAMES = new Set(Object.values(NAMES).flat());
const READERS = ["Int8", "Uint8", "Int16", "Uint16", "Int32", "Uint32", "Float32", "Float64"]; // datatypes 1 to 8
const NUM_BYTES = [1, 1, 2, 2, 4, 4, 4, 8];
const FLOAT32 = 7;

const UNITS = [
  { name: "seconds", perSecond: 1 },
  { name: "milliseconds", perSecond: 1e3 },
  { name: "microseconds", perSecond: 1e6 },
  { name: "nanoseconds", perSecond: 1e9 },
];
const SWEEP_S = [0.004, 2.5]; // how long sweeps and Livox' frames take: distinct in each unit

/** A message of a cloud topic as a PointCloud2 whose sizes are mended where that is safe. */
export function asCloud(message, type) {
  if (LIVOX_CLOUDS.includes(type)) return livoxToCloud(message, type);
  const { width, point_step, data } = message;
  const height = message.height || 1; // some drivers leave it 0
  const rowBytes = width * point_step;
  const row_step = message.row_step < rowBytes ? rowBytes : message.row_step; // or 0, or points instead of bytes
  const numNeeded = width > 0 ? (height - 1) * row_step + rowBytes : 0;
  if (data.length < numNeeded) {
    throw new UserError(`the cloud of ${width} x ${height} points of ${point_step} bytes has ${data.length} bytes`);
  }
  for (const axis of ["x", "y", "z"]) {
    if (fieldOf(message.fields, axis)) continue;
    throw new UserError(`the cloud has no field ${axis}: ${namesOf(message.fields)}`);
  }
  for (const field of ["x", "y", "z", "time"].map((name) => fieldOf(message.fields, name)).filter(Boolean)) {
    requireReadable(field, point_step);
  }
  return { ...message, height, row_step };
}

function requireReadable({ name, offset, datatype }, point_step) {
  if (!READERS[datatype - 1]) throw new UserError(`the cloud's field ${name} has the unknown datatype ${datatype}`);
  if (offset + NUM_BYTES[datatype - 1] > point_step) {
    throw new UserError(`the cloud's field ${name} at offset ${offset} does not fit a point of ${point_step} bytes`);
  }
}

const namesOf = (fields) => fields.map(({ name }) => name).join(", ");

function fieldOf(fields, meaning) {
  for (const wanted of NAMES[meaning]) {
    const found = fields.find(({ name }) => name.toLowerCase() === wanted);
    if (found) return found;
  }
  return undefined;
}

/**
 * What the clouds' times are.
 *
 * @param clouds  the recording's first, of asCloud.
 * @returns undefined if they have none; else {perSecond, from: "stamp" | "epoch" | "first", words}; perSecond is
 *     undefined where the range tells of no unit.
 */
export function timeKind(clouds) {
  const ranges = clouds.map(timeRange).filter(Boolean);
  if (ranges.length === 0) return undefined;
  const { name } = fieldOf(clouds[0].fields, "time") ?? { name: "time" };
  const span = median(ranges.map(({ least, most }) => most - least));
  const unit = UNITS.find(({ perSecond }) => span >= SWEEP_S[0] * perSecond && span <= SWEEP_S[1] * perSecond);
  if (!unit) return { words: `the points' ${name} spans ${span} in a sweep, a time in no unit: not looked at` };
  const from = median(ranges.map((range) => originOf(range, unit.perSecond)));
  const origin = ["stamp", "epoch", "first"][from];
  const counted = {
    stamp: "after the stamp",
    epoch: "since the stamps' epoch",
    first: "of a clock of its own: counted from each sweep's first point",
  };
  return { perSecond: unit.perSecond, from: origin, words: `the points' ${name}: ${unit.name} ${counted[origin]}` };
}

/** 0 to 2: after the stamp, since its epoch, of another clock. */
function originOf({ least, most, stampS }, perSecond) {
  const nearest = Math.min(Math.abs(least), Math.abs(most));
  if (nearest < 2 * (most - least)) return 0;
  return Math.abs(least / perSecond - stampS) < 10 ? 1 : 2;
}

function timeRange(cloud) {
  const field = fieldOf(cloud.fields, "time");
  if (!field) return undefined;
  const range = { least: Infinity, most: -Infinity, stampS: 1e-9 * Number(stampOf(cloud)) };
  const { read } = access(cloud, field);
  forEachPoint(cloud, (at) => {
    const value = read(at);
    if (!Number.isFinite(value)) return;
    if (value < range.least) range.least = value;
    if (value > range.most) range.most = value;
  });
  return range.most > range.least ? range : undefined;
}

const MAX_RANGE_M = 300; // of half of a lidar's points: none sees so far

/** What is odd about where the points of these clouds are; undefined if nothing is. */
export function positionDoubt(clouds) {
  const points = clouds.flatMap(positionsOf);
  if (points.length === 0) {
    return clouds.length > 0 ? `no point of the first ${clouds.length} clouds has a position: all are NaN or 0` : undefined;
  }
  const centre = [0, 1, 2].map((axis) => median(points.map((point) => point[axis])));
  const rangeM = median(points.map((point) => Math.hypot(...point)));
  if (!(rangeM > MAX_RANGE_M)) return undefined;
  const spreadM = median(points.map((point) => Math.hypot(...point.map((value, axis) => value - centre[axis]))));
  const isElsewhere = spreadM < 0.05 * Math.hypot(...centre);
  return isElsewhere
    ? `the points lie around (${centre.map((value) => value.toFixed(0)).join(", ")}) m: in a map's frame? The lidar's own is needed`
    : `half of the points are more than ${rangeM.toFixed(0)} m away: are they in millimetres? Metres are needed`;
}

/** Some of the points that have a position. */
function positionsOf(cloud) {
  const axes = ["x", "y", "z"].map((name) => access(cloud, fieldOf(cloud.fields, name)));
  const every = Math.max(1, Math.floor((cloud.width * cloud.height) / 500));
  const points = [];
  let i = 0;
  forEachPoint(cloud, (at) => {
    if (i++ % every !== 0) return;
    const point = axes.map(({ read }) => read(at));
    if (point.every(Number.isFinite) && point.some((value) => value !== 0)) points.push(point);
  });
  return points;
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** Reads and writes one field at the offset of a point. */
function access({ data, is_bigendian }, { offset, datatype }) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const method = `get${READERS[datatype - 1]}`;
  const isLittle = !is_bigendian;
  return {
    read: (at) => view[method](at + offset, isLittle),
    write: (at, value) => view.setFloat32(at + offset, value, isLittle),
  };
}

function forEachPoint({ height, width, row_step, point_step }, visit) {
  for (let row = 0; row < height; ++row) {
    for (let i = 0, at = row * row_step; i < width; ++i, at += point_step) visit(at);
  }
}

/** @param kind  of timeKind, for all clouds of a recording. */
export function cloudToLcm(cloud, utime, seq, kind) {
  const { fields, data } = withTimes(cloud, renamed(cloud.fields), kind);
  return {
    utime,
    seq,
    frame_id: cloud.header.frame_id,
    height: cloud.height,
    width: cloud.width,
    nfields: fields.length,
    fields: fields.map(({ name, offset, datatype, count }) => ({ name, offset, datatype, count })),
    is_bigendian: Number(cloud.is_bigendian),
    point_step: cloud.point_step,
    row_step: cloud.row_step,
    data_nbytes: data.length,
    data,
    is_dense: Number(cloud.is_dense),
  };
}

/** The fields by voqcal's names; one that is not looked at but has such a name gets another. */
function renamed(fields) {
  const meaning = new Map(Object.keys(NAMES).map((name) => [fieldOf(fields, name), name]));
  return fields.map((field) => {
    if (meaning.has(field)) return { ...field, name: meaning.get(field) };
    const isTaken = Object.values(NAMES).some((names) => names.includes(field.name));
    return isTaken ? { ...field, name: `other_${field.name}` } : field;
  });
}

/** Times as 32-bit seconds after the stamp, in the bytes that they had. */
function withTimes(cloud, fields, kind) {
  const time = fields.find(({ name }) => name === "time");
  const data = buffer(cloud.data);
  if (!time || kind === undefined) return { fields, data };
  const isSeconds = time.datatype === FLOAT32 && kind.perSecond === 1 && kind.from === "stamp";
  if (isSeconds) return { fields, data };
  if (kind.perSecond === undefined || NUM_BYTES[time.datatype - 1] < 4) {
    return { fields: fields.filter((field) => field !== time), data };
  }
  return {
    fields: fields.map((field) => (field === time ? { ...field, datatype: FLOAT32 } : field)),
    data: rewritten({ ...cloud, data: Buffer.from(data) }, time, kind),
  };
}

function rewritten(cloud, time, { perSecond, from }) {
  const { read, write } = access(cloud, time);
  let origin = 0;
  if (from === "epoch") origin = (Number(stampOf(cloud)) / 1e9) * perSecond;
  if (from === "first") origin = timeRange(cloud)?.least ?? 0;
  forEachPoint(cloud, (at) => write(at, (read(at) - origin) / perSecond));
  return cloud.data;
}
