// Each layout, encoding and lens of sensor_msgs by itself, without a recording.

import assert from "node:assert/strict";
import { test } from "node:test";
import { cameraToLcm, isRectifiedTopic } from "../lib/sensor_msgs/cameras.mjs";
import { asCloud, cloudToLcm, positionDoubt, timeKind } from "../lib/sensor_msgs/clouds.mjs";
import { bitsUsed, imageToLcm } from "../lib/sensor_msgs/images.mjs";
import { Tally } from "../lib/tally.mjs";

const STAMP_S = 1_700_000_000;
const header = { stamp: { sec: STAMP_S, nsec: 0 }, frame_id: "sensor" };

// ---- Images ----------------------------------------------------------------------------------------

const WIDTH = 4;
const HEIGHT = 4;
const GREY = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, i) => 16 * i);

/** An image whose pixels are `bytesOf(grey, x, y)`, in rows of `padding` more bytes. */
function image(encoding, bytesOf, { padding = 0, big = 0 } = {}) {
  const rows = [];
  for (let y = 0; y < HEIGHT; ++y) {
    for (let x = 0; x < WIDTH; ++x) rows.push(...bytesOf(GREY[y * WIDTH + x], x, y));
    rows.push(...new Array(padding).fill(0x7f));
  }
  return { header, width: WIDTH, height: HEIGHT, encoding, is_bigendian: big, step: rows.length / HEIGHT, data: Uint8Array.from(rows) };
}
const little = (value) => [value & 255, value >> 8];

test("encodings of brightness give the very pixels of mono8", () => {
  const same = {
    mono8: image("mono8", (grey) => [grey]),
    "in capitals": image("MONO8", (grey) => [grey]),
    mono16: image("mono16", (grey) => little(257 * grey)),
    "mono16, big-endian": image("mono16", (grey) => little(257 * grey).reverse(), { big: 1 }),
    "16UC1 of 10 bits": image("16UC1", (grey) => little(grey << 2)),
    "mono16 of 12 bits, padded": image("mono16", (grey) => little(grey << 4), { padding: 6 }),
    yuv422: image("yuv422", (grey) => [128, grey]),
    yuv422_yuy2: image("yuv422_yuy2", (grey) => [grey, 128]),
  };
  for (const [name, message] of Object.entries(same)) {
    const { pixelformat, row_stride, data } = imageToLcm(message, 0n, 0, bitsUsed([message]));
    assert.deepEqual([pixelformat, row_stride, [...data]], [1497715271, WIDTH, [...GREY]], name);
  }
});

test("nv12: the brightness, without what follows it", () => {
  const message = image("nv12", (grey) => [grey]);
  message.data = Uint8Array.from([...message.data, ...new Array(8).fill(128)]);
  assert.deepEqual([...imageToLcm(message, 0n, 0).data], [...GREY]);
});

test("encodings of colour give the very pixels of bgr8", () => {
  const bgr = (grey) => [grey, 255 - grey, 7];
  const wanted = imageToLcm(image("bgr8", bgr), 0n, 0);
  const wide = (grey) => bgr(grey).flatMap((value) => little(257 * value));
  for (const [encoding, bytesOf] of [["8UC3", bgr], ["bgra8", (grey) => [...bgr(grey), 9]], ["8UC4", (grey) => [...bgr(grey), 9]], ["bgr16", wide]]) {
    const { pixelformat, data } = imageToLcm(image(encoding, bytesOf), 0n, 0);
    assert.deepEqual([pixelformat, [...data]], [wanted.pixelformat, [...wanted.data]], encoding);
  }
});

test("a Bayer mosaic becomes (R + 2 G + B) / 4, whatever its pattern and bits", () => {
  const colour = { r: 40, g: 100, b: 200 };
  for (const pattern of ["rggb", "bggr", "gbrg", "grbg"]) {
    const at = (x, y) => colour[pattern[2 * (y % 2) + (x % 2)]];
    for (const message of [
      image(`bayer_${pattern}8`, (_, x, y) => [at(x, y)]),
      image(`bayer_${pattern}16`, (_, x, y) => little(257 * at(x, y))),
    ]) {
      assert.deepEqual([...imageToLcm(message, 0n, 0).data], new Array(16).fill(110), message.encoding);
    }
  }
});

test("broken images say what is wrong", () => {
  const compressed = (data) => () => imageToLcm({ header, format: "png", data: Buffer.from(data) }, 0n, 0);
  assert.throws(compressed(""), /has no bytes/);
  assert.throws(compressed("\x89PNG\r\n\x1a\n" + "x".repeat(100), "latin1"), /neither JPEG nor PNG|cut off/);
  assert.throws(compressed("RIFF....WEBP"), /'png' and neither JPEG nor PNG/);
  assert.throws(() => imageToLcm({ ...image("mono8", (grey) => [grey]), height: 9 }, 0n, 0), /4 x 9 mono8/);
  assert.throws(() => imageToLcm(image("32FC1", () => [0, 0, 0, 0]), 0n, 0), /'32FC1'; wanted: mono8/);
});

// ---- Clouds ----------------------------------------------------------------------------------------

const TYPES = { u1: [2, 1, "writeUInt8"], u2: [4, 2, "writeUInt16LE"], u4: [6, 4, "writeUInt32LE"], f4: [7, 4, "writeFloatLE"], f8: [8, 8, "writeDoubleLE"] };
const NUM = 11;

/** Points at (i, 0, 1), and one more field of them. */
function cloud(name, type, valueOf) {
  const [datatype, numBytes, write] = TYPES[type];
  const point_step = 12 + numBytes;
  const data = Buffer.alloc(NUM * point_step);
  for (let i = 0; i < NUM; ++i) {
    data.writeFloatLE(i, i * point_step);
    data.writeFloatLE(1, i * point_step + 8);
    data[write](valueOf(i), i * point_step + 12);
  }
  const fields = ["x", "y", "z"].map((axis, k) => ({ name: axis, offset: 4 * k, datatype: 7, count: 1 }));
  fields.push({ name, offset: 12, datatype, count: 1 });
  return { header, height: 1, width: NUM, fields, is_bigendian: false, point_step, row_step: data.length, data, is_dense: true };
}
const toLcm = (message) => {
  const ready = asCloud(message, "sensor_msgs/PointCloud2");
  return cloudToLcm(ready, 0n, 0, timeKind([ready]));
};

test("fields by their usual names", () => {
  const names = { reflectivity: "intensity", i: "intensity", Intensity: "intensity", scalar_intensity: "intensity", line: "ring", channel: "ring", laser_id: "ring" };
  for (const [theirs, ours] of Object.entries(names)) assert.equal(toLcm(cloud(theirs, "u2", (i) => i)).fields[3].name, ours);
});

test("times of every unit and origin become seconds after the stamp", () => {
  const s = (i) => 0.01 * i;
  const kinds = {
    "f4 seconds": [cloud("time", "f4", s), s],
    "before the stamp": [cloud("time", "f4", (i) => s(i) - 0.1), (i) => s(i) - 0.1],
    "u4 nanoseconds": [cloud("t", "u4", (i) => 1e9 * s(i)), s],
    "u4 microseconds": [cloud("offset_time", "u4", (i) => 1e6 * s(i)), s],
    "f4 microseconds": [cloud("time", "f4", (i) => 1e6 * s(i)), s],
    "f8 seconds since the epoch": [cloud("timestamp", "f8", (i) => STAMP_S + s(i)), s],
    "f8 nanoseconds since the epoch": [cloud("timestamp", "f8", (i) => 1e9 * (STAMP_S + s(i))), s],
    "f8 seconds since boot": [cloud("time_stamp", "f8", (i) => 5000 + s(i)), s],
  };
  for (const [name, [message, wanted]] of Object.entries(kinds)) {
    const { fields, data, point_step } = toLcm(message);
    assert.deepEqual({ ...fields[3] }, { name: "time", offset: 12, datatype: 7, count: 1 }, name);
    // 1e-6 s: a double of nanoseconds since the epoch counts in steps of 256 ns.
    for (let i = 0; i < NUM; ++i) assert.ok(Math.abs(data.readFloatLE(i * point_step + 12) - wanted(i)) < 1e-6, name);
  }
});

test("a time of no unit is not looked at, and that is said", () => {
  const absurd = asCloud(cloud("time", "f4", (i) => 1e6 * i), "sensor_msgs/PointCloud2");
  const kind = timeKind([asCloud(cloud("time", "f4", (i) => 1e-4 * i), "sensor_msgs/PointCloud2")]);
  assert.match(kind.words, /spans 0.00.* in no unit: not looked at/);
  assert.deepEqual(cloudToLcm(absurd, 0n, 0, kind).fields.map(({ name }) => name), ["x", "y", "z"]);
  assert.equal(timeKind([asCloud(cloud("time", "f4", () => NaN), "sensor_msgs/PointCloud2")]), undefined);
});

test("rows whose step or number was left out; clouds that are cut off", () => {
  const message = cloud("ring", "u2", (i) => i);
  assert.equal(toLcm({ ...message, row_step: 0 }).row_step, NUM * message.point_step);
  assert.equal(toLcm({ ...message, height: 0 }).height, 1);
  assert.throws(() => toLcm({ ...message, data: message.data.subarray(5) }), /11 x 1 points of 14 bytes has 149 bytes/);
  assert.throws(() => toLcm({ ...message, fields: message.fields.slice(1) }), /no field x: y, z, ring/);
});

test("fields that cannot be read are the cloud's fault, not the recording's", () => {
  const message = cloud("time", "f4", (i) => 0.01 * i);
  const withField = (i, change) => ({ ...message, fields: message.fields.map((field, k) => (k === i ? { ...field, ...change } : field)) });
  assert.throws(() => toLcm(withField(0, { datatype: 11 })), /field x has the unknown datatype 11/);
  assert.throws(() => toLcm(withField(3, { offset: 13 })), /field time at offset 13 does not fit a point of 16 bytes/);
});

test("points in millimetres, in a map's frame, or none: said", () => {
  const moved = (shift, scale) => {
    const message = cloud("ring", "u2", (i) => i);
    for (let at = 0; at < message.data.length; at += message.point_step) {
      for (let axis = 0; axis < 3; ++axis) message.data.writeFloatLE(scale * message.data.readFloatLE(at + 4 * axis) + shift[axis], at + 4 * axis);
    }
    return asCloud(message, "sensor_msgs/PointCloud2");
  };
  assert.equal(positionDoubt([moved([0, 0, 0], 1)]), undefined);
  assert.equal(positionDoubt([]), undefined);
  assert.match(positionDoubt([moved([0, 0, 0], 1000)]), /more than 5099 m away: are they in millimetres\?/);
  assert.match(positionDoubt([moved([450_000, 5_400_000, 100], 1)]), /around \(45000\d, 5400000, 101\) m: in a map's frame\?/);
  assert.match(positionDoubt([moved([0, 0, 0], NaN)]), /no point of the first 1 clouds has a position/);
});

test("Livox' own messages; those of the first driver tell which echo a point is", () => {
  const points = [{ offset_time: 5_000_000, x: 1, y: 2, z: 3, reflectivity: 9, tag: 0x10, line: 4 }];
  const names = ["x", "y", "z", "intensity", "ring", "time"];
  const cases = { "livox_ros_driver/CustomMsg": ["return_number"], "livox_ros_driver2/CustomMsg": [] };
  for (const [type, more] of Object.entries(cases)) {
    const cloud = asCloud({ header, points: [...points, ...points] }, type);
    const { fields, data, width, point_step: step } = cloudToLcm(cloud, 0n, 0, undefined);
    assert.deepEqual(fields.map(({ name }) => name), [...names, ...more]);
    assert.deepEqual([width, data.length], [2, 2 * step]);
    assert.deepEqual([data.readFloatLE(step + 8), data.readFloatLE(step + 12), data.readUInt16LE(step + 16)], [3, 9, 4]);
    assert.ok(Math.abs(data.readFloatLE(step + 18) - 0.005) < 1e-9);
    if (more.length > 0) assert.equal(data.readUInt8(step + 22), 2);
  }
});

// ---- Cameras ---------------------------------------------------------------------------------------

const D = [-0.4, 0.2, -0.001, 0.0002, -0.07];
const info = (changes) => ({
  header,
  width: 1280,
  height: 720,
  distortion_model: "plumb_bob",
  d: D,
  k: [900, 0, 640, 0, 901, 360, 0, 0, 1],
  p: [600, 0, 630, 0, 0, 601, 350, 0, 0, 0, 1, 0],
  binning_x: 0,
  binning_y: 0,
  roi: { x_offset: 0, y_offset: 0, width: 0, height: 0 },
  ...changes,
});

test("lenses by any name, coefficients of 0 left out", () => {
  const lens = (distortion_model, d) => {
    const { lens_model, distortion } = cameraToLcm(info({ distortion_model, d }), 0n, 0);
    return [lens_model, ...distortion];
  };
  const R = [0.6, -2.5, 0.0003, -0.0002, 1.4, 0.5, -2.3, 1.3];
  assert.deepEqual(lens("plumb_bob", D), ["plumb_bob", ...D, 0, 0, 0]);
  assert.deepEqual(lens("Plumb_Bob", [...D, 0, 0, 0]), ["plumb_bob", ...D, 0, 0, 0]);
  assert.deepEqual(lens("plumb_bob", R), ["rational", ...R]);
  assert.deepEqual(lens("rational_polynomial", [...R, 0, 0, 0, 0, 0, 0]), ["rational", ...R]);
  assert.deepEqual(lens("fisheye", [0.1, 0, 0, 0, 0]), ["equidistant", 0.1, 0, 0, 0, 0, 0, 0, 0]);
  assert.deepEqual(lens("", []), ["plumb_bob", 0, 0, 0, 0, 0, 0, 0, 0]);
  for (const model of ["radtan", "radial-tangential", "pinhole", "brown_conrady"]) {
    assert.deepEqual(lens(model, [1, 2, 3, 4]), ["plumb_bob", 1, 2, 3, 4, 0, 0, 0, 0]);
  }
  for (const model of ["equidistant", "kannala_brandt", "pinhole-equi"]) {
    assert.deepEqual(lens(model, [1, 2, 3, 4]), ["equidistant", 1, 2, 3, 4, 0, 0, 0, 0]);
  }
  assert.throws(() => lens("rational_polynomial", [...R, 0.001]), /no thin prism/);
  assert.throws(() => lens("double_sphere", [0.1, 0.5]), /'double_sphere' is none of plumb_bob.*Kalibr: --models pinhole-radtan/);
});

test("cameras that are not calibrated", () => {
  assert.throws(() => cameraToLcm(info({ k: new Array(9).fill(0) }), 0n, 0), /not calibrated/);
  assert.throws(() => cameraToLcm(info({ k: [1, 0, 0, 0, 1, 0, 0, 0, 1] }), 0n, 0), /not calibrated/);
  assert.throws(() => cameraToLcm(info({ width: 0 }), 0n, 0), /0 x 720 px/);
});

test("a region of interest, then binning: the same ray at the same part of the image", () => {
  const roi = { x_offset: 100, y_offset: 50, width: 640, height: 480 };
  const camera = cameraToLcm(info({ roi, binning_x: 2, binning_y: 2 }), 0n, 0);
  assert.deepEqual([camera.width_px, camera.height_px, camera.fx_px, camera.fy_px], [320, 240, 450, 450.5]);
  // Pixels 540 and 541 of the whole sensor make one: its centre is at 540.5 - 100, or pixel 220.
  assert.equal(camera.cx_px, (640 - 100 + 0.5) / 2 - 0.5);
});

test("rectified images: P, and no distortion", () => {
  const camera = cameraToLcm(info({}), 0n, 0, true);
  assert.deepEqual([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px], [600, 601, 630, 350]);
  assert.deepEqual(camera.distortion, new Array(8).fill(0));
  assert.deepEqual(["/cam/image_rect", "/cam/image_rect_color/compressed", "/cam/image_raw", "/direct/image"].map(isRectifiedTopic), [true, true, false, false]);
});

// ---- What is left out ------------------------------------------------------------------------------

test("1500 broken pieces make a few words", () => {
  const tally = new Tally("clouds");
  for (let i = 0; i < 1500; ++i) tally.leaveOut(i % 2 ? `row_step is ${i}` : `has ${i} bytes`);
  assert.equal(tally.words(), "1500 of 1500 left out: 750 like number 0: has 0 bytes; 750 like number 1: row_step is 1");
  assert.throws(() => tally.requireSome(), /clouds: 1500 of 1500 left out/);
});
