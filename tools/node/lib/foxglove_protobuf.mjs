// Foxglove's schemas as protobuf: what Foxglove and Rerun both read.

import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const protobuf = require("protobufjs");
require("protobufjs/ext/descriptor"); // adds Root.toDescriptor
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");
const {
  foxgloveEnumSchemas,
  foxgloveMessageSchemas,
  generateProto,
} = require("@foxglove/schemas/internal");

/** The protobuf type foxglove.`name` with what an MCAP schema record needs of it. */
export function foxgloveType(name) {
  const root = rootWith(name);
  const type = root.lookupType(`foxglove.${name}`);
  const descriptors = root.toDescriptor("proto3");
  return {
    schema: {
      name: `foxglove.${name}`,
      encoding: "protobuf",
      data: FileDescriptorSet.encode(descriptors).finish(),
    },
    encode: (message) => type.encode(type.fromObject(message)).finish(),
  };
}

/** Only the files that the type needs. */
function rootWith(name) {
  const root = new protobuf.Root();
  const loaded = new Set();
  const load = (file) => {
    if (loaded.has(file)) return;
    loaded.add(file);
    const known = protobuf.common.get(file);
    if (known) {
      root.addJSON(known.nested);
      return;
    }
    const { imports } = protobuf.parse(protoText(file), root, { keepCase: true });
    for (const each of imports ?? []) load(each);
  };
  load(`foxglove/${name}.proto`);
  root.resolveAll();
  return root;
}

function protoText(file) {
  const name = /^foxglove\/(\w+)\.proto$/.exec(file)[1];
  const schema = foxgloveMessageSchemas[name] ?? Object.values(foxgloveEnumSchemas).find((e) => e.name === name);
  const nested = Object.values(foxgloveEnumSchemas).filter((e) => e.parentSchemaName === name);
  return generateProto(schema, nested);
}
