// CameraInfo to camera_info_t and to the rig file's section. Only the size of what the image's topic holds
// counts: binning, a region of interest and rectification are worked into the numbers.

import { UserError } from "../command.mjs";

// By name in small letters, of ROS, OpenCV and Kalibr: the lens by us (as core/camera/named_lens.cpp).
const LENSES = {
  plumb_bob: "plumb_bob",
  radtan: "plumb_bob",
  "radial-tangential": "plumb_bob",
  radial_tangential: "plumb_bob",
  brown_conrady: "plumb_bob",
  pinhole: "plumb_bob",
  "pinhole-radtan": "plumb_bob",
  none: "plumb_bob",
  "non-fisheye": "plumb_bob",
  rational_polynomial: "rational",
  rational: "rational",
  equidistant: "equidistant",
  equi: "equidistant",
  "pinhole-equi": "equidistant",
  fisheye: "equidistant",
  kannala_brandt: "equidistant",
  kannala_brandt4: "equidistant",
};
const NUM_COEFFICIENTS = { plumb_bob: 5, rational: 8, equidistant: 4 };

/** @param isRectified  the images are rectified: P holds for them, and no distortion is left. */
export function cameraToLcm(message, utime, seq, isRectified = false) {
  const lens = isRectified ? { lens_model: "plumb_bob", d: [] } : lensOf(message);
  return {
    utime,
    seq,
    lens_model: lens.lens_model,
    ...sizeAndFocus(message, matrixOf(message, isRectified)),
    distortion: [...lens.d, ...new Array(8 - lens.d.length).fill(0)],
  };
}

/** A topic whose images are rectified has it in its name, as image_proc has it: image_rect, image_rect_color. */
export const isRectifiedTopic = (topic) => /(^|[/_])rect(ified)?([/_]|$)/.test(topic ?? "");

function lensOf(message) {
  const given = [...(message.d ?? message.D)];
  const d = given.slice(0, given.findLastIndex((value) => value !== 0) + 1);
  if (!d.every(Number.isFinite)) throw new UserError(`CameraInfo's distortion is [${given.join(", ")}]`);
  const model = message.distortion_model.trim().toLowerCase();
  const named = LENSES[model || "none"];
  // Five coefficients and three more are the rational lens, however it is called: OpenCV's order.
  const lens_model = named === "plumb_bob" && d.length > 5 ? "rational" : named;
  if (lens_model === undefined) {
    throw new UserError(
      `CameraInfo's distortion_model '${message.distortion_model}' is none of ${Object.keys(LENSES).join(", ")}: ` +
        "calibrate the camera with one of these (Kalibr: --models pinhole-radtan or pinhole-equi), or rectify the images",
    );
  }
  if (d.length > NUM_COEFFICIENTS[lens_model]) {
    throw new UserError(
      `CameraInfo says ${d.length} coefficients of '${message.distortion_model}' that are not 0; at most ` +
        `${NUM_COEFFICIENTS[lens_model]} of them are known here (no thin prism, no tilt): ` +
        "calibrate the camera without the others, or rectify the images",
    );
  }
  return { lens_model, d };
}

/** fx, fy, cx, cy of the whole sensor. */
function matrixOf(message, isRectified) {
  const k = [...(message.k ?? message.K)];
  const p = [...(message.p ?? message.P)];
  const isPGiven = isRectified && p[0] > 0;
  const [fx, fy, cx, cy] = isPGiven ? [p[0], p[5], p[2], p[6]] : [k[0], k[4], k[2], k[5]];
  const skew = isPGiven ? p[1] : k[1];
  if (k.every((value) => value === 0) || (fx === 1 && fy === 1)) {
    throw new UserError("CameraInfo says that the camera is not calibrated (its K is all 0, or 1): calibrate it first");
  }
  if (![fx, fy, cx, cy].every(Number.isFinite) || !(fx > 0 && fy > 0)) {
    throw new UserError(`CameraInfo's K is [${k.join(", ")}]: no focal lengths`);
  }
  if (Math.abs(skew) > 0.1) throw new UserError(`CameraInfo's K has a skew of ${skew} px, which is not known here`);
  return { fx, fy, cx, cy };
}

/** Of the image as it is sent: cut to the region of interest, then binned. Pixel 0 is a centre. */
function sizeAndFocus({ width, height, binning_x, binning_y, roi }, { fx, fy, cx, cy }) {
  const [bx, by] = [binning_x || 1, binning_y || 1];
  const isCut = roi?.width > 0 && roi?.height > 0;
  const [x0, y0] = isCut ? [roi.x_offset, roi.y_offset] : [0, 0];
  const size = {
    width_px: Math.floor((isCut ? roi.width : width) / bx),
    height_px: Math.floor((isCut ? roi.height : height) / by),
  };
  if (!(size.width_px > 0 && size.height_px > 0)) {
    throw new UserError(`CameraInfo says that the image has ${width} x ${height} px: its driver left them out`);
  }
  const binned = (centre, from, by_) => (by_ === 1 ? centre - from : (centre - from + 0.5) / by_ - 0.5);
  return {
    ...size,
    fx_px: fx / bx,
    fy_px: fy / by,
    cx_px: binned(cx, x0, bx),
    cy_px: binned(cy, y0, by),
  };
}

/** A camera_info_t as the camera section of a rig file. */
export function cameraSection(camera) {
  const lines = ["lens_model", "width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"].map(
    (key) => `  ${key}: ${camera[key]}`,
  );
  const distortion = camera.distortion.slice(0, NUM_COEFFICIENTS[camera.lens_model]).join(", ");
  return `camera:\n${lines.join("\n")}\n  distortion: [${distortion}]\n`;
}
