// Image and CompressedImage to image_t. Compressed bytes are passed on as they are; so are 8-bit grey and
// colours. What voqcal's formats do not hold becomes 8-bit grey or colour by one rule each, below.

import { UserError } from "../command.mjs";
import { buffer } from "./messages.mjs";

// image_t::pixelformat (lcmtypes/image_t.lcm).
const PIXEL = { GRAY: 1497715271, RGB: 859981650, BGR: 861030210, MJPEG: 1196444237, PNG: 541544016 };

// By encoding, in small letters: our format; numbers a pixel, of so many bytes; how many of them are kept,
// from `first` on. yuv: only the brightness is kept, which is what boards are found by.
const GRAY = { format: PIXEL.GRAY, numbers: 1, bytes: 1, keep: 1, first: 0 };
const ENCODINGS = {
  mono8: GRAY,
  "8uc1": GRAY,
  rgb8: { ...GRAY, format: PIXEL.RGB, numbers: 3, keep: 3 },
  bgr8: { ...GRAY, format: PIXEL.BGR, numbers: 3, keep: 3 },
  "8uc3": { ...GRAY, format: PIXEL.BGR, numbers: 3, keep: 3 },
  rgba8: { ...GRAY, format: PIXEL.RGB, numbers: 4, keep: 3 },
  bgra8: { ...GRAY, format: PIXEL.BGR, numbers: 4, keep: 3 },
  "8uc4": { ...GRAY, format: PIXEL.BGR, numbers: 4, keep: 3 },
  mono16: { ...GRAY, bytes: 2 },
  "16uc1": { ...GRAY, bytes: 2 },
  rgb16: { ...GRAY, format: PIXEL.RGB, numbers: 3, bytes: 2, keep: 3 },
  bgr16: { ...GRAY, format: PIXEL.BGR, numbers: 3, bytes: 2, keep: 3 },
  "16uc3": { ...GRAY, format: PIXEL.BGR, numbers: 3, bytes: 2, keep: 3 },
  yuv422: { ...GRAY, numbers: 2, first: 1 }, // u y v y
  uyvy: { ...GRAY, numbers: 2, first: 1 },
  yuv422_yuy2: { ...GRAY, numbers: 2 }, // y u y v
  yuyv: { ...GRAY, numbers: 2 },
  nv12: GRAY, // the brightness, then the colours of half the resolution
  nv21: GRAY,
};
for (const pattern of ["rggb", "bggr", "gbrg", "grbg"]) {
  ENCODINGS[`bayer_${pattern}8`] = { ...GRAY, isMosaic: true };
  ENCODINGS[`bayer_${pattern}16`] = { ...GRAY, isMosaic: true, bytes: 2 };
}

const kindOf = ({ encoding }) => ENCODINGS[encoding?.toLowerCase()];

/** Of 16 bits. */
export const hasWideNumbers = (image) => kindOf(image)?.bytes === 2;

/** How many bits of 16 a recording's images use: the first `images` tell. Sensors have 10, 12, 14 or 16. */
export function bitsUsed(images) {
  let greatest = 0;
  for (const image of images) {
    if (hasWideNumbers(image)) greatest = Math.max(greatest, greatestOf(image, kindOf(image)));
  }
  if (greatest === 0) return undefined;
  return [8, 10, 12, 14, 16].find((bits) => greatest < 2 ** bits);
}

/** Without what pads the rows; 0 of a broken image. */
function greatestOf(image, kind) {
  let greatest = 0;
  if (!hasRows(image, kind)) return greatest;
  const { values, stride } = numbersOf(image, kind);
  for (let y = 0; y < image.height; ++y) {
    const end = y * stride + image.width * kind.numbers;
    for (let i = y * stride; i < end; ++i) if (values[i] > greatest) greatest = values[i];
  }
  return greatest;
}

/** @param bits  of numbers of 16: the upper 8 of these are kept. */
export function imageToLcm(message, utime, seq, bits = 16) {
  const pixels = message.format === undefined ? rawPixels(message, bits) : compressedPixels(message);
  const sequence = Buffer.from(String(seq));
  return {
    utime,
    ...pixels,
    size: pixels.data.length,
    nmetadata: 1,
    metadata: [{ key: "seq", n: sequence.length, value: sequence }],
  };
}

function rawPixels(message, bits) {
  const { width, height, encoding } = message;
  const kind = ENCODINGS[encoding.toLowerCase()];
  if (!kind) {
    const known = Object.keys(ENCODINGS).join(", ");
    throw new UserError(`the image is encoded as '${encoding}'; wanted: ${known}, or CompressedImage`);
  }
  const common = { width, height, pixelformat: kind.format };
  requireRows(message, kind);
  const { step } = message;
  const isAsItIs = kind.bytes === 1 && kind.numbers === kind.keep && !kind.isMosaic;
  if (isAsItIs) {
    return { ...common, row_stride: step, data: buffer(message.data).subarray(0, step * height) };
  }
  const bytes = kept(message, kind, bits);
  return { ...common, row_stride: width * kind.keep, data: kind.isMosaic ? brightness(bytes, width, height) : bytes };
}

function hasRows({ width, height, step, data }, { numbers, bytes }) {
  const rowBytes = width * numbers * bytes;
  const isOfNumbers = step % bytes === 0;
  return width > 0 && height > 0 && isOfNumbers && step >= rowBytes && data.length >= (height - 1) * step + rowBytes;
}

function requireRows(image, kind) {
  if (hasRows(image, kind)) return;
  const { width, height, step, encoding, data } = image;
  throw new UserError(
    data.length === 0
      ? "the image has no bytes"
      : `the image of ${width} x ${height} ${encoding} has rows of ${step} bytes, and ${data.length} bytes`,
  );
}

/** The numbers that are kept, 8 bits each, without padding. */
function kept(image, kind, bits) {
  const { width, height } = image;
  const { values, stride } = numbersOf(image, kind);
  const out = Buffer.allocUnsafe(width * height * kind.keep);
  const shift = kind.bytes === 2 ? bits - 8 : 0;
  let to = 0;
  for (let y = 0; y < height; ++y) {
    let from = y * stride + kind.first;
    for (let x = 0; x < width; ++x, from += kind.numbers) {
      for (let c = 0; c < kind.keep; ++c) {
        const value = values[from + c] >> shift;
        out[to++] = value > 255 ? 255 : value;
      }
    }
  }
  return out;
}

/** All numbers, and how many lie between the beginnings of two rows. */
function numbersOf({ step, data, is_bigendian }, kind) {
  if (kind.bytes === 1) return { values: data, stride: step };
  const copy = Buffer.from(data.subarray(0, data.length & ~1)); // at an even address
  if (is_bigendian) copy.swap16();
  return { values: new Uint16Array(copy.buffer, copy.byteOffset, copy.length / 2), stride: step / 2 };
}

/**
 * A Bayer mosaic's brightness (R + 2 G + B) / 4: the mean over each pixel's 3 x 3 neighbours with weights
 * 1 2 1 each way, at which all four patterns give the same. Symmetric, so that no edge moves. The border has
 * its neighbours mirrored.
 */
function brightness(mosaic, width, height) {
  const sums = new Uint16Array(width * height);
  const out = Buffer.allocUnsafe(width * height);
  for (let y = 0; y < height; ++y) {
    const row = y * width;
    for (let x = 0; x < width; ++x) {
      const left = x > 0 ? x - 1 : Math.min(1, width - 1);
      const right = x < width - 1 ? x + 1 : Math.max(width - 2, 0);
      sums[row + x] = mosaic[row + left] + 2 * mosaic[row + x] + mosaic[row + right];
    }
  }
  for (let y = 0; y < height; ++y) {
    const above = (y > 0 ? y - 1 : Math.min(1, height - 1)) * width;
    const below = (y < height - 1 ? y + 1 : Math.max(height - 2, 0)) * width;
    for (let x = 0; x < width; ++x) {
      out[y * width + x] = (sums[above + x] + 2 * sums[y * width + x] + sums[below + x] + 8) >> 4;
    }
  }
  return out;
}

function compressedPixels({ format, data }) {
  const bytes = buffer(data);
  if (bytes.length === 0) throw new UserError("the image has no bytes");
  const size = jpegSize(bytes) ?? pngSize(bytes);
  if (!size) throw new UserError(`the image is '${format}' and neither JPEG nor PNG, which are wanted`);
  return { ...size, row_stride: 0, data: bytes };
}

function pngSize(bytes) {
  const isPng = bytes.length > 24 && bytes.readUInt32BE(0) === 0x89504e47;
  if (!isPng) return undefined;
  if (bytes.lastIndexOf("IEND", -1, "latin1") < bytes.length - 64) throw new UserError("the PNG is cut off");
  return { width: bytes.readUInt32BE(16), height: bytes.readUInt32BE(20), pixelformat: PIXEL.PNG };
}

/** Walks the segments up to a start of frame (ITU-T T.81, B.1.1.3): SOF0 to SOF15 but DHT, JPG, DAC. */
function jpegSize(bytes) {
  if (bytes.length < 4 || bytes.readUInt16BE(0) !== 0xffd8) return undefined;
  if (bytes.lastIndexOf(Buffer.from([0xff, 0xd9])) < 0) throw new UserError("the JPEG is cut off");
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
