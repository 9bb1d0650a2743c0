// Messages of sensor_msgs as voqcal's. Both kinds of ROS have the same fields, but for the case of
// CameraInfo's (K and D, k and d).

import { UserError } from "./command.mjs";
import { nanoseconds } from "./recordings.mjs";

export const POINT_CLOUD = "sensor_msgs/PointCloud2";
export const IMAGES = ["sensor_msgs/Image", "sensor_msgs/CompressedImage"];
export const CAMERA_INFO = "sensor_msgs/CameraInfo";

// image_t::pixelformat (lcmtypes/image_t.lcm).
const PIXEL = { GRAY: 1497715271, RGB: 859981650, BGR: 861030210, MJPEG: 1196444237, PNG: 541544016 };

// sensor_msgs/Image encodings: our pixel format, bytes a pixel there, which of them are kept.
const ENCODINGS = {
  mono8: { format: PIXEL.GRAY, step: 1, keep: 1 },
  "8UC1": { format: PIXEL.GRAY, step: 1, keep: 1 },
  rgb8: { format: PIXEL.RGB, step: 3, keep: 3 },
  bgr8: { format: PIXEL.BGR, step: 3, keep: 3 },
  "8UC3": { format: PIXEL.BGR, step: 3, keep: 3 },
  rgba8: { format: PIXEL.RGB, step: 4, keep: 3 },
  bgra8: { format: PIXEL.BGR, step: 4, keep: 3 },
};

// The names of lenses by ROS and by us (core/camera/camera_model.hpp), with their coefficients.
const LENSES = {
  plumb_bob: { lens: "plumb_bob", num: 5 },
  rational_polynomial: { lens: "rational", num: 8 },
  equidistant: { lens: "equidistant", num: 4 },
  fisheye: { lens: "equidistant", num: 4 },
};

const buffer = (data) => Buffer.from(data.buffer, data.byteOffset, data.byteLength);

/** Sensor time in microseconds; LCM knows no finer. */
const utimeOf = (message) => nanoseconds(message.header.stamp) / 1000n;

/** PointCloud2 to pointcloud2_t: the layout and the numbers of field types are the same. */
export function cloudToLcm(message, seq) {
  const data = buffer(message.data);
  return {
    utime: utimeOf(message),
    seq,
    frame_id: message.header.frame_id,
    height: message.height,
    width: message.width,
    nfields: message.fields.length,
    fields: message.fields.map(({ name, offset, datatype, count }) => ({ name, offset, datatype, count })),
    is_bigendian: Number(message.is_bigendian),
    point_step: message.point_step,
    row_step: message.row_step,
    data_nbytes: data.length,
    data,
    is_dense: Number(message.is_dense),
  };
}

/** Image or CompressedImage to image_t; compressed bytes are passed on as they are. */
export function imageToLcm(message, seq) {
  const pixels = message.format === undefined ? rawPixels(message) : compressedPixels(message);
  const sequence = Buffer.from(String(seq));
  return {
    utime: utimeOf(message),
    ...pixels,
    size: pixels.data.length,
    nmetadata: 1,
    metadata: [{ key: "seq", n: sequence.length, value: sequence }],
  };
}

function rawPixels({ width, height, step, encoding, data }) {
  const kind = ENCODINGS[encoding];
  if (!kind) {
    const known = Object.keys(ENCODINGS).join(", ");
    throw new UserError(`the image is encoded as '${encoding}'; wanted: ${known}, or CompressedImage`);
  }
  const bytes = buffer(data);
  if (step < width * kind.step || bytes.length < step * height) {
    throw new UserError(`the image says ${width} x ${height} ${encoding}, but has ${bytes.length} bytes`);
  }
  const common = { width, height, pixelformat: kind.format };
  if (kind.step === kind.keep) return { ...common, row_stride: step, data: bytes };
  const kept = Buffer.alloc(width * height * kind.keep);
  for (let y = 0, to = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      for (let c = 0; c < kind.keep; ++c) kept[to++] = bytes[y * step + x * kind.step + c];
    }
  }
  return { ...common, row_stride: width * kind.keep, data: kept };
}

function compressedPixels({ format, data }) {
  const bytes = buffer(data);
  const size = jpegSize(bytes) ?? pngSize(bytes);
  if (!size) throw new UserError(`the image is '${format}'; wanted: JPEG or PNG`);
  return { ...size, row_stride: 0, data: bytes };
}

function pngSize(bytes) {
  const isPng = bytes.length > 24 && bytes.readUInt32BE(0) === 0x89504e47;
  if (!isPng) return undefined;
  return { width: bytes.readUInt32BE(16), height: bytes.readUInt32BE(20), pixelformat: PIXEL.PNG };
}

/** Walks the segments up to a start of frame (ITU-T T.81, B.1.1.3): SOF0 to SOF15 but DHT, JPG, DAC. */
function jpegSize(bytes) {
  if (bytes.length < 4 || bytes.readUInt16BE(0) !== 0xffd8) return undefined;
  for (let at = 2; at + 9 < bytes.length && bytes[at] === 0xff; ) {
    const marker = bytes[at + 1];
    if (marker >= 0xc0 && marker <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(marker)) {
      return {
        width: bytes.readUInt16BE(at + 7),
        height: bytes.readUInt16BE(at + 5),
        pixelformat: PIXEL.MJPEG,
      };
    }
    at += 2 + bytes.readUInt16BE(at + 2);
  }
  return undefined;
}

/** CameraInfo to camera_info_t. */
export function cameraToLcm(message, seq) {
  const lens = LENSES[message.distortion_model];
  const k = message.k ?? message.K;
  const d = [...(message.d ?? message.D)];
  if (!lens || d.length > lens.num) {
    throw new UserError(
      `CameraInfo says ${d.length} coefficients of '${message.distortion_model}'; wanted: ` +
        Object.entries(LENSES).map(([name, { num }]) => `${num} of ${name}`).join(", "),
    );
  }
  return {
    utime: utimeOf(message),
    seq,
    lens_model: lens.lens,
    width_px: message.width,
    height_px: message.height,
    fx_px: k[0],
    fy_px: k[4],
    cx_px: k[2],
    cy_px: k[5],
    distortion: [...d, ...new Array(8 - d.length).fill(0)],
  };
}

/** A camera_info_t as the camera section of a rig file. */
export function cameraSection(camera) {
  const { num } = Object.values(LENSES).find(({ lens }) => lens === camera.lens_model);
  const lines = ["lens_model", "width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"].map(
    (key) => `  ${key}: ${camera[key]}`,
  );
  const distortion = camera.distortion.slice(0, num).join(", ");
  return `camera:\n${lines.join("\n")}\n  distortion: [${distortion}]\n`;
}
