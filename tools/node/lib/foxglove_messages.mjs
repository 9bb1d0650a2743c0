// voqcal's messages as Foxglove's. A camera's frame is the optical one, as everywhere.

const MJPEG = 1196444237;
const PNG = 541544016;
const RAW_ENCODINGS = { 1497715271: "mono8", 859981650: "rgb8", 861030210: "bgr8" };

// pointfield_t::datatype to foxglove.PackedElementField.NumericType.
const NUMERIC_TYPES = { 1: 2, 2: 1, 3: 4, 4: 3, 5: 6, 6: 5, 7: 7, 8: 8 };

const LINE_LOOP = 1;
const COLOURS = { lidar: { r: 0.86, g: 0.16, b: 0.94, a: 1 }, camera: { r: 0.24, g: 0.86, b: 0.31, a: 1 } };
const ORIGIN = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };

const timestamp = (utime) => ({
  seconds: Number(utime / 1_000_000n),
  nanos: Number(utime % 1_000_000n) * 1000,
});
const xyz = ([x, y, z]) => ({ x, y, z });

/** Pose of the child in the parent's frame: Foxglove's transforms take a child's coordinates to its parent. */
export function transform({ parent, child, T_parent_child }, utime) {
  const { quaternion_xyzw: q, translation_m: t } = T_parent_child;
  return {
    timestamp: timestamp(utime),
    parent_frame_id: parent,
    child_frame_id: child,
    translation: xyz(t),
    rotation: { ...xyz(q), w: q[3] },
  };
}

export function calibration(frame, camera, utime) {
  const { fx_px, fy_px, cx_px, cy_px } = camera;
  const models = {
    equidistant: "kannala_brandt",
    plumb_bob: "plumb_bob",
    rational: "rational_polynomial",
  };
  return {
    timestamp: timestamp(utime),
    frame_id: frame,
    width: camera.width_px,
    height: camera.height_px,
    distortion_model: models[camera.lens_model],
    D: camera.distortion,
    K: [fx_px, 0, cx_px, 0, fy_px, cy_px, 0, 0, 1],
    R: [1, 0, 0, 0, 1, 0, 0, 0, 1],
    P: [fx_px, 0, cx_px, 0, 0, fy_px, cy_px, 0, 0, 0, 1, 0],
  };
}

/** The board's outline as one sensor saw it. @param kind  of the sensor: "lidar" or "camera". */
export function boardLines(kind, frame, pose, utime) {
  const line = {
    type: LINE_LOOP,
    pose: ORIGIN,
    thickness: 3,
    scale_invariant: true,
    points: pose.corners_m.map(xyz),
    color: COLOURS[kind],
  };
  const entity = { timestamp: timestamp(utime), frame_id: frame, id: `board seen by ${frame}` };
  return { entities: [{ ...entity, lines: [line] }] };
}

export function cloud(frame, sweep) {
  return {
    timestamp: timestamp(sweep.utime),
    frame_id: frame,
    pose: ORIGIN,
    point_stride: sweep.point_step,
    fields: sweep.fields.map(({ name, offset, datatype }) => ({
      name,
      offset,
      type: NUMERIC_TYPES[datatype],
    })),
    data: sweep.data,
  };
}

/** A CompressedImage or a RawImage: {type, message}. */
export function image(frame, picture) {
  const common = { timestamp: timestamp(picture.utime), frame_id: frame, data: picture.data };
  if (picture.pixelformat === MJPEG || picture.pixelformat === PNG) {
    const format = picture.pixelformat === PNG ? "png" : "jpeg";
    return { type: "CompressedImage", message: { ...common, format } };
  }
  const { width, height, row_stride: step } = picture;
  const encoding = RAW_ENCODINGS[picture.pixelformat];
  return { type: "RawImage", message: { ...common, width, height, step, encoding } };
}
