// Whose the topics beside several lidars' packets are.

import assert from "node:assert/strict";
import { test } from "node:test";
import { siblingsOf } from "../lib/packet_siblings.mjs";

test("each lidar's topics beside its packets, by their names", () => {
  const OUSTER = "ouster_sensor_msgs/PacketMsg";
  const ROBOSENSE = "rslidar_msgs/rslidarScan";
  const siblings = (topics, taken) => {
    const recording = { topics: new Map(Object.entries(topics).map(([name, type]) => [name, { type }])) };
    const sensors = taken.map((topic) => ({ name: topic, topic, kind: "lidar" }));
    return [...siblingsOf(recording, sensors).values()];
  };
  const metadata = { "/os_front/metadata": "std_msgs/String", "/os_rear/metadata": "std_msgs/String" };
  const ousters = { "/os_front/lidar_packets": OUSTER, "/os_rear/lidar_packets": OUSTER };
  assert.deepEqual(siblings({ ...metadata, ...ousters }, Object.keys(ousters)), [
    { state: [], metadata: ["/os_front/metadata"] },
    { state: [], metadata: ["/os_rear/metadata"] },
  ]);
  // One more that is nobody's is left aside; the only one of two lidars is not.
  assert.equal(siblings({ "/metadata": "std_msgs/String", ...metadata, ...ousters }, Object.keys(ousters))[0].metadata.length, 1);
  assert.throws(() => siblings({ "/metadata": "std_msgs/String", ...ousters }, Object.keys(ousters)), /which lidar's \/metadata is/);
  // Another maker's lidar has none; letters that names happen to begin with tell nothing.
  const makers = { "/difop": "rslidar_msgs/rslidarPacket", "/velodyne_packets": "velodyne_msgs/VelodyneScan", "/packets": ROBOSENSE };
  assert.deepEqual(siblings(makers, ["/velodyne_packets", "/packets"]).map(({ state }) => state), [[], ["/difop"]]);
  const letters = { "/rslidar_difop": "rslidar_msgs/rslidarPacket", "/left": ROBOSENSE, "/right": ROBOSENSE };
  assert.throws(() => siblings(letters, ["/left", "/right"]), /that of \/left or \/right, is not clear/);
});
