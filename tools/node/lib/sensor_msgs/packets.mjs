// Lidars' datagrams as their drivers record them: one or many in a message, each with the time at which it came, or
// without.

import { UserError } from "../command.mjs";
import { LCM_PACKETS } from "./from_lcm.mjs";
import { nanoseconds } from "./messages.mjs";

const HEADER = `std_msgs/Header header
`;
const HEADER_PARTS = `
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;
/** A scan of packets, as the definition of its type would be. */
const scan = (packet, fields) => `${HEADER}${packet}[] packets
================================================================================
MSG: ${packet}
${fields}${HEADER_PARTS}`;

/** The types, with their definitions for recordings that have none (sqlite3 before ROS 2 Iron). */
export const PACKET_DEFINITIONS = {
  "velodyne_msgs/VelodyneScan": scan("velodyne_msgs/VelodynePacket", "builtin_interfaces/Time stamp\nuint8[1206] data"),
  "ouster_ros/PacketMsg": "uint8[] buf",
  "ouster_msgs/PacketMsg": "uint8[] buf",
  "ouster_sensor_msgs/PacketMsg": "uint8[] buf",
  "hesai_ros_driver/UdpFrame": scan("hesai_ros_driver/UdpPacket", "uint8[] data\nuint32 size"),
  "hesai_lidar/PandarScan": scan("hesai_lidar/PandarPacket", "builtin_interfaces/Time stamp\nuint8[1500] data\nuint32 size"),
  "pandar_msgs/PandarScan": scan("pandar_msgs/PandarPacket", "builtin_interfaces/Time stamp\nuint8[1500] data\nuint32 size"),
  "nebula_msgs/NebulaPackets": scan("nebula_msgs/NebulaPacket", "builtin_interfaces/Time stamp\nuint8[] data"),
  "robosense_msgs/RobosenseScan": scan("robosense_msgs/RobosensePacket", "builtin_interfaces/Time stamp\nuint8[1248] data\nuint32 size"),
  "rslidar_msgs/rslidarScan": scan("rslidar_msgs/rslidarPacket", "builtin_interfaces/Time stamp\nuint8[1248] data"),
  "rslidar_msgs/rslidarPacket": `builtin_interfaces/Time stamp\nuint8[1248] data${HEADER_PARTS}`,
  "rslidar_msg/RslidarPacket": `${HEADER}uint8 is_difop\nuint8 is_frame_begin\nuint8[] data${HEADER_PARTS}`,
};
export const PACKETS = [...Object.keys(PACKET_DEFINITIONS), LCM_PACKETS];

/** Topics of the same types that have no points: motion, and the sensor's own word on its state. */
export const isBesidePackets = (topic) => /imu|difop/i.test(topic);

/** @returns {packets: [{bytes, stampNs}], stampNs}: of the last packet, undefined where messages have no times. */
export function packetsOf(message) {
  const packets = (message.packets ?? [message]).map(packetOf);
  if (packets.length === 0) throw new UserError("the message has no packets");
  return { packets, stampNs: packets.at(-1).stampNs ?? stampNsOf(message) };
}

function packetOf(packet) {
  const all = packet.data ?? packet.buf;
  if (!(all?.length > 0)) throw new UserError("a packet has no bytes");
  const bytes = packet.size > 0 ? all.subarray(0, packet.size) : all;
  return { bytes, stampNs: stampNsOf(packet) };
}

/** Of a packet or a message; 0 stands for none. */
function stampNsOf({ stamp, header }) {
  const time = stamp ?? header?.stamp;
  return time && nanoseconds(time) > 0n ? nanoseconds(time) : undefined;
}

/** When each packet arrived, by its stamp, or as long before the message was recorded as its stamp says. */
export function arrivalTimesNs({ packets, stampNs }, logTimeNs, useLogTimes) {
  return packets.map((packet) => {
    const packetNs = packet.stampNs ?? stampNs;
    if (packetNs === undefined) return logTimeNs;
    return useLogTimes ? logTimeNs - (stampNs - packetNs) : packetNs;
  });
}
