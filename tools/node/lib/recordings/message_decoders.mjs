// What makes objects of a topic's bytes.

import { createRequire } from "node:module";
import { UserError } from "../command.mjs";
import { LIVOX_DEFINITIONS } from "../sensor_msgs/livox.mjs";
import { PACKET_DEFINITIONS } from "../sensor_msgs/packets.mjs";

// These packages are CommonJS.
const require = createRequire(import.meta.url);
const { parse } = require("@foxglove/rosmsg");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");
const { MessageReader: Ros1Reader } = require("@foxglove/rosmsg-serialization");
const { MessageReader: Ros2Reader } = require("@foxglove/rosmsg2-serialization");

/** "sensor_msgs/msg/Image" as both kinds of ROS are spoken of here: "sensor_msgs/Image". */
export const plainType = (type) => type.replace("/msg/", "/");

export function ros1Decoder(definition) {
  const reader = new Ros1Reader(parse(definition));
  return (data) => reader.readMessage(data);
}

/** @param definition  as `ros2 bag` stores it; "" takes the one of the type that is known here. */
export function ros2Decoder(type, definition) {
  const reader = new Ros2Reader(definition === "" ? knownDefinition(type) : parse(definition, { ros2: true }));
  return (data) => reader.readMessage(data);
}

/** A type and all that it is made of, as the readers want it. */
function knownDefinition(type) {
  const driver = LIVOX_DEFINITIONS[plainType(type)] ?? PACKET_DEFINITIONS[plainType(type)];
  if (driver) return parse(driver, { ros2: true });
  const found = new Map();
  const add = (name) => {
    const definition = ros2humble[plainType(name)] ?? ros2humble[plainType(name).replace("/", "/msg/")];
    if (!definition) throw new UserError(`type ${name}: the recording does not define it, nor is it known here`);
    if (found.has(name)) return;
    found.set(name, definition);
    for (const field of definition.definitions) if (field.isComplex) add(field.type);
  };
  add(type);
  const [main, ...others] = found.values();
  return [{ ...main, name: undefined }, ...others];
}
