// What all messages of sensor_msgs have, and the types that are taken.

import { LIVOX_CLOUDS } from "./livox.mjs";

export const CLOUDS = ["sensor_msgs/PointCloud2", ...LIVOX_CLOUDS];
export const IMAGES = ["sensor_msgs/Image", "sensor_msgs/CompressedImage"];
export const CAMERA_INFOS = ["sensor_msgs/CameraInfo"];

/** Of a ROS time: {sec, nsec} in ROS 1, {sec, nanosec} in ROS 2 (the reader calls it nsec too). */
export const nanoseconds = (time) =>
  BigInt(time.sec) * 1_000_000_000n + BigInt(time.nsec ?? time.nanosec);

export const stampOf = (message) => nanoseconds(message.header.stamp);

export const buffer = (data) => Buffer.from(data.buffer, data.byteOffset, data.byteLength);
