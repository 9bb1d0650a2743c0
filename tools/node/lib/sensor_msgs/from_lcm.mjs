// LCM messages of any type as the messages of ROS that say the same. What they are is told by their members' names:
//   images   width, height and bytes (data, image, pixels); pixelformat (a FourCC) or encoding; or `images` of these
//   clouds   the members of pointcloud2_t; or `points`, of three numbers each or with x, y, z; or lists x, y, z.
//            Other numbers of a point go by their names (intensity, ring, time, ...)
//   packets  any other one with bytes

import { FIELD_NAMES } from "./clouds.mjs";

const CLOUD = "sensor_msgs/PointCloud2";
const IMAGE = "sensor_msgs/Image";
export const LCM_PACKETS = "lcm/packets";

const IMAGE_BYTES = ["data", "image", "pixels"];
const STRIDES = ["row_stride", "stride", "step"];
const TIMES = ["utime", "timestamp", "time_us", "time"];
const IS_BYTES = { byte: true, int8_t: true };

/** What messages of this type are taken for: a type of ROS, LCM_PACKETS, or undefined. */
export function lcmKind(types, name) {
  const members = types.members(name);
  const has = (...names) => names.every((wanted) => members.some((member) => member.name === wanted));
  const find = (wanted) => members.find((member) => member.name === wanted);
  if (has("fields", "point_step", "data")) return CLOUD;
  if (isImage(members)) return IMAGE;
  const images = find("images");
  if (images?.dimensions.length === 1 && types.names().includes(images.type) && isImage(types.members(images.type))) return IMAGE;
  const points = find("points");
  if (points?.dimensions.length === 2) return CLOUD;
  const pointMembers = points?.dimensions.length === 1 && types.names().includes(points.type) ? types.members(points.type) : [];
  if (["x", "y", "z"].every((axis) => pointMembers.some((member) => member.name === axis))) return CLOUD;
  if (["x", "y", "z"].every((axis) => find(axis)?.dimensions.length === 1)) return CLOUD;
  return members.some(isBytes) ? LCM_PACKETS : undefined;
}

const isBytes = ({ type, dimensions }) => IS_BYTES[type] && dimensions.length === 1 && !/^\d/.test(dimensions[0]);

function isImage(members) {
  const has = (name) => members.some((member) => member.name === name);
  return has("width") && has("height") && members.some((member) => IMAGE_BYTES.includes(member.name) && isBytes(member));
}

/** @param message  as LcmTypes.decode has it, of a type that lcmKind takes. */
export function lcmToRos(message) {
  if ("fields" in message && "point_step" in message) return { ...message, header: headerOf(message), is_bigendian: Boolean(message.is_bigendian) };
  if ("width" in message && "height" in message && IMAGE_BYTES.some((name) => name in message)) return imageOf(message, headerOf(message));
  if (Array.isArray(message.images) && message.images.length > 0) return imageOf(message.images[0], headerOf(message));
  if (Array.isArray(message.points) || Array.isArray(message.x)) return cloudOf(message);
  return { stamp: headerOf(message).stamp, data: bytesOf(Object.values(message).find(isByteList)) };
}

const isByteList = (value) => Buffer.isBuffer(value) || (Array.isArray(value) && value.every((byte) => byte >= -128 && byte < 256));
const bytesOf = (value) => (Buffer.isBuffer(value) ? value : Buffer.from(value ?? []));

function headerOf(message) {
  const holder = [message, message.header].find((some) => some && TIMES.some((name) => name in some));
  const value = holder?.[TIMES.find((name) => name in holder)] ?? 0n;
  const ns = nanosecondsOf(value);
  return { stamp: { sec: Number(ns / 1_000_000_000n), nsec: Number(ns % 1_000_000_000n) }, frame_id: message.frame_id ?? "lidar" };
}

/** Of whole numbers microseconds, as LCM has it, or nanoseconds, by their size; of others seconds. */
function nanosecondsOf(value) {
  const mostUs = 100_000_000_000_000_000n; // the year 5138
  if (typeof value === "number") return BigInt(Math.round(value * 1e9));
  return value > mostUs ? value : value * 1000n;
}

// ---- Images ----------------------------------------------------------------------------------------

const fourCc = (text) => Buffer.from(text, "latin1").readInt32LE(0);
const BAYER = ["bggr", "gbrg", "grbg", "rggb"];
/** By bot_core's numbers and V4L2's; "big" where the bytes of a number are the other way round. */
const ENCODINGS = new Map([
  ...["GREY", "GRAY", "Y800"].map((code) => [fourCc(code), "mono8"]),
  ...["LG16", "Y16 "].map((code) => [fourCc(code), "mono16"]),
  [357, "mono16 big"],
  [fourCc("RGB3"), "rgb8"],
  [fourCc("BGR3"), "bgr8"],
  [fourCc("RGB4"), "rgba8"],
  [fourCc("BGR4"), "bgra8"],
  [fourCc("RGBL"), "rgb16"],
  [358, "rgb16 big"],
  [fourCc("UYVY"), "yuv422"],
  [fourCc("YUYV"), "yuv422_yuy2"],
  [fourCc("NV12"), "nv12"],
  [fourCc("BA81"), "bayer_bggr8"],
  ...BAYER.map((pattern, i) => [fourCc(`XXX${i + 1}`), `bayer_${pattern}8`]),
  ...BAYER.slice(1).map((pattern) => [fourCc(pattern.toUpperCase()), `bayer_${pattern}8`]),
  ...BAYER.map((pattern, i) => [fourCc(`LBA${i + 1}`), `bayer_${pattern}16`]),
  ...BAYER.map((pattern, i) => [fourCc(`BBA${i + 1}`), `bayer_${pattern}16 big`]),
]);

function imageOf(message, header) {
  const data = bytesOf(message[IMAGE_BYTES.find((name) => name in message)]);
  const { width, height } = message;
  const isPacked = data.length > 3 && (data.readUIntBE(0, 3) === 0xffd8ff || data.readUInt32BE(0) === 0x89504e47);
  if (isPacked) return { header, format: "", data };
  const name = message.encoding ?? ENCODINGS.get(message.pixelformat) ?? `pixelformat ${message.pixelformat}`;
  const [encoding, isBig] = [name.replace(/ big$/, ""), name.endsWith(" big")];
  const given = message[STRIDES.find((stride) => stride in message)] ?? 0;
  // Rows without a word on how long they are have no padding.
  const step = given > 0 ? given : encoding === "nv12" ? width : Math.floor(data.length / Math.max(height, 1));
  return { header, width, height, encoding, is_bigendian: Number(isBig), step, data };
}

// ---- Clouds ----------------------------------------------------------------------------------------

const FLOAT64 = 8;

/** Every list of numbers that has one for each point, by a name of clouds.mjs, as a PointCloud2 of doubles. */
function cloudOf(message) {
  const columns = columnsOf(message);
  const names = [...columns.keys()];
  const width = columns.get("x")?.length ?? 0;
  const data = Buffer.alloc(8 * names.length * width);
  names.forEach((name, column) => {
    const values = columns.get(name);
    for (let i = 0; i < width; ++i) data.writeDoubleLE(values[i], 8 * (i * names.length + column));
  });
  return {
    header: headerOf(message),
    height: 1,
    width,
    fields: names.map((name, i) => ({ name, offset: 8 * i, datatype: FLOAT64, count: 1 })),
    is_bigendian: false,
    point_step: 8 * names.length,
    row_step: data.length,
    data,
    is_dense: false,
  };
}

function columnsOf(message) {
  const columns = new Map();
  const put = (name, values) => {
    if (FIELD_NAMES.has(name.toLowerCase()) && values.every((value) => typeof value !== "object")) columns.set(name, values.map(Number));
  };
  const points = message.points ?? [];
  if (Array.isArray(points[0])) ["x", "y", "z"].forEach((axis, i) => put(axis, points.map((point) => point[i])));
  else for (const name of Object.keys(points[0] ?? {})) put(name, points.map((point) => point[name]));
  const num = points.length || message.x?.length || 0;
  for (const [name, values] of Object.entries(message)) {
    if (Array.isArray(values) && values.length === num && name !== "points") put(name, values);
  }
  (message.channel_names ?? []).forEach((name, i) => put(name, message.channels?.[i] ?? [])); // bot_core's pointcloud_t
  for (const [name, values] of columns) if (values.length !== num) columns.delete(name);
  return columns;
}
