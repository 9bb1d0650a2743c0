// log_to_recording.mjs LOG OUT [ENCODING]: an LCM log of LIDAR_POINTS and CAMERA_IMAGE, or of those of several
// sensors (LIDAR_POINTS_front), as a recording of ROS, a bag or (OUT ends in .mcap or .db3, or is a folder:
// split) of ROS 2. Images are compressed ones, or, with an encoding, grey ones that are written in it without
// a loss. For the tests of what reads recordings.
import { statSync } from "node:fs";
import { join } from "node:path";
import { readLog } from "../../tools/node/lib/lcm_log.mjs";
import { voqcalTypes } from "../../tools/node/lib/lcm_types.mjs";
import {
  cloudToRos,
  compressedToRos,
  rawToRos,
  writeBag,
  writeDb3,
  writeMcap,
} from "../../tools/node/test/recording_writers.mjs";

const [log, out, encoding] = process.argv.slice(2);
const types = voqcalTypes();
const CHANNEL = /^(LIDAR_POINTS|CAMERA_IMAGE)(?:_(\w+))?$/;

/** By encoding, the bytes of a grey pixel. */
const PIXELS = {
  mono8: (grey) => [grey],
  bgr8: (grey) => [grey, grey, grey],
  rgba8: (grey) => [grey, grey, grey, 255],
  mono16: (grey) => [0, grey],
  yuv422: (grey, x) => [x % 2 ? 140 : 120, grey],
  yuv422_yuy2: (grey, x) => [grey, x % 2 ? 140 : 120],
};

function encoded(message) {
  const { width, height, row_stride: stride, data } = message;
  const pixels = [];
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) pixels.push(...PIXELS[encoding](data[y * stride + x], x));
  }
  return rawToRos({ ...message, row_stride: pixels.length / height, data: Uint8Array.from(pixels) }, encoding);
}

const imageToRos = encoding === undefined ? compressedToRos : encoded;
const imageType = encoding === undefined ? "CompressedImage" : "Image";
const isWanted = ({ channel }) => CHANNEL.test(channel);
const messages = [...readLog(log)].filter(isWanted).map(({ utime, channel, bytes }) => {
  const [, kind, name] = CHANNEL.exec(channel);
  const isCloud = kind === "LIDAR_POINTS";
  const message = types.decode(isCloud ? "pointcloud2_t" : "image_t", bytes);
  return {
    topic: isCloud ? `${name ? `/${name}` : ""}/velodyne_points` : `/${name ?? "camera"}/image`,
    type: isCloud ? "sensor_msgs/PointCloud2" : `sensor_msgs/${imageType}`,
    logTimeNs: utime * 1000n,
    message: isCloud ? cloudToRos(message) : imageToRos(message),
  };
});
const isFolder = statSync(out, { throwIfNoEntry: false })?.isDirectory();
const half = messages.length >> 1;
if (isFolder) {
  await writeMcap(join(out, "part_0.mcap"), messages.slice(0, half));
  await writeMcap(join(out, "part_1.mcap"), messages.slice(half));
} else if (out.endsWith(".mcap")) await writeMcap(out, messages);
else if (out.endsWith(".db3")) writeDb3(out, messages);
else writeBag(out, messages);
