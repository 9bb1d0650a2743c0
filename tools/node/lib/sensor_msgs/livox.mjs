// CustomMsg of livox_ros_driver and livox_ros_driver2: points, each with its time after the first.

const CUSTOM = (driver) => `std_msgs/Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
${driver}/CustomPoint[] points
================================================================================
MSG: ${driver}/CustomPoint
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;

export const LIVOX_CLOUDS = ["livox_ros_driver2/CustomMsg", "livox_ros_driver/CustomMsg"];
/** For recordings that do not define their types. */
export const LIVOX_DEFINITIONS = Object.fromEntries(
  LIVOX_CLOUDS.map((type) => [type, CUSTOM(type.split("/")[0])]),
);

/** Whose tags have the echo's number, from 0 on, in bits 4 and 5 (Avia, Horizon, Mid-70); HAP's and Mid-360's, a confidence. */
const TYPE_WITH_ECHOES = "livox_ros_driver/CustomMsg";
const echoOf = (tag) => (tag >> 4) & 3;

/** CustomMsg as the PointCloud2 that the driver would have sent: metres, seconds after the stamp. */
export function livoxToCloud({ header, points }, type) {
  const hasEchoes = type === TYPE_WITH_ECHOES;
  const pointBytes = hasEchoes ? 23 : 22;
  const data = Buffer.alloc(points.length * pointBytes);
  points.forEach((point, i) => {
    const at = i * pointBytes;
    data.writeFloatLE(point.x, at);
    data.writeFloatLE(point.y, at + 4);
    data.writeFloatLE(point.z, at + 8);
    data.writeFloatLE(point.reflectivity, at + 12);
    data.writeUInt16LE(point.line, at + 16);
    data.writeFloatLE(1e-9 * point.offset_time, at + 18);
    if (hasEchoes) data.writeUInt8(echoOf(point.tag) + 1, at + 22);
  });
  const field = (name, offset, datatype) => ({ name, offset, datatype, count: 1 });
  return {
    header,
    height: 1,
    width: points.length,
    fields: [
      ...["x", "y", "z", "intensity"].map((name, i) => field(name, 4 * i, 7)),
      field("ring", 16, 4),
      field("time", 18, 7),
      ...(hasEchoes ? [field("return_number", 22, 2)] : []),
    ],
    is_bigendian: false,
    point_step: pointBytes,
    row_step: data.length,
    data,
    is_dense: true,
  };
}
