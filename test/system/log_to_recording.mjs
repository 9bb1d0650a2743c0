// log_to_recording.mjs LOG OUT: an LCM log of LIDAR_POINTS and CAMERA_IMAGE as a recording of ROS, a
// bag or (OUT ends in .mcap or .db3) of ROS 2. For import_ros_test.
import { readLog } from "../../tools/node/lib/lcm_log.mjs";
import { voqcalTypes } from "../../tools/node/lib/lcm_types.mjs";
import {
  cloudToRos,
  compressedToRos,
  writeBag,
  writeDb3,
  writeMcap,
} from "../../tools/node/test/recording_writers.mjs";

const [log, out] = process.argv.slice(2);
const types = voqcalTypes();
const isWanted = ({ channel }) => channel === "LIDAR_POINTS" || channel === "CAMERA_IMAGE";
const messages = [...readLog(log)].filter(isWanted).map(({ utime, channel, bytes }) => {
  const isCloud = channel === "LIDAR_POINTS";
  const message = types.decode(isCloud ? "pointcloud2_t" : "image_t", bytes);
  return {
    topic: isCloud ? "/velodyne_points" : "/camera/image/compressed",
    type: isCloud ? "sensor_msgs/PointCloud2" : "sensor_msgs/CompressedImage",
    logTimeNs: utime * 1000n,
    message: isCloud ? cloudToRos(message) : compressedToRos(message),
  };
});
if (out.endsWith(".mcap")) await writeMcap(out, messages);
else if (out.endsWith(".db3")) writeDb3(out, messages);
else writeBag(out, messages);
