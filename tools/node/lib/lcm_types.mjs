// LCM messages in JavaScript, from the very .lcm files that lcm-gen makes the C++ types of.

import { readdirSync, readFileSync } from "node:fs";

const SIZES = { int8_t: 1, int16_t: 2, int32_t: 4, int64_t: 8, byte: 1, boolean: 1, float: 4, double: 8 };
const isPrimitive = (type) => type in SIZES || type === "string";

/** Every type of a folder of .lcm files, by its name without the package. */
export class LcmTypes {
  #structs = new Map();
  #fingerprints = new Map();

  /** @param {URL} folder  of .lcm files; those in folders of it count as well. */
  constructor(folder) {
    for (const name of readdirSync(folder, { recursive: true }).filter((file) => file.endsWith(".lcm")).sort()) {
      for (const struct of structsOf(new URL(name, folder), name)) this.#structs.set(struct.name, struct);
    }
  }

  names() {
    return [...this.#structs.keys()];
  }

  /** The type's members: {name, type, dimensions}. */
  members(type) {
    return this.#struct(type).members;
  }

  /** @returns {Buffer} `message` as lcm-gen's encode() writes it. int64_t takes a BigInt or a number. */
  encode(type, message) {
    return Buffer.concat(this.encodeParts(type, message));
  }

  /** The same in pieces, of which long ones are the message's own bytes: borrowed. */
  encodeParts(type, message) {
    const parts = [bigEndian(8, (buffer) => buffer.writeBigUInt64BE(this.fingerprint(type)))];
    this.#encodeStruct(this.#struct(type), message, parts);
    return joinedWhereShort(parts);
  }

  /** @returns the message; int64_t as BigInt, bytes as Buffer. */
  decode(type, bytes) {
    const reader = { bytes: Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength), offset: 8 };
    if (reader.bytes.length < 8 || reader.bytes.readBigUInt64BE(0) !== this.fingerprint(type)) {
      throw new Error(`is no ${type}, or of another version of it`);
    }
    const message = this.#decodeStruct(this.#struct(type), reader);
    if (reader.offset !== reader.bytes.length) throw new Error(`${type}: bytes are left over`);
    return message;
  }

  /** The hash that opens each message: of member names, types, sizes and order (LCM 1.3.1, lcm-gen). */
  fingerprint(type) {
    if (!this.#fingerprints.has(type)) {
      const sum = this.#hash(type, []);
      this.#fingerprints.set(type, BigInt.asUintN(64, (sum << 1n) + (BigInt.asUintN(64, sum) >> 63n)));
    }
    return this.#fingerprints.get(type);
  }

  #struct(type) {
    const struct = this.#structs.get(type);
    if (!struct) throw new Error(`no LCM type ${type}`);
    return struct;
  }

  #hash(type, parents) {
    if (parents.includes(type)) return 0n;
    let hash = structHash(this.#struct(type));
    for (const member of this.#struct(type).members) {
      if (!isPrimitive(member.type)) hash += this.#hash(member.type, [...parents, type]);
    }
    hash = BigInt.asIntN(64, hash);
    if (parents.length === 0) return hash;
    return BigInt.asIntN(64, (hash << 1n) + (BigInt.asUintN(64, hash) >> 63n));
  }

  #encodeStruct(struct, message, parts) {
    for (const member of struct.members) {
      if (!(member.name in message)) throw new Error(`${struct.name} needs ${member.name}`);
      this.#encodeMember(member, member.dimensions, message[member.name], message, parts);
    }
  }

  #encodeMember(member, dimensions, value, message, parts) {
    if (dimensions.length === 0) {
      if (isPrimitive(member.type)) parts.push(encodePrimitive(member.type, value));
      else this.#encodeStruct(this.#struct(member.type), value, parts);
      return;
    }
    const length = lengthOf(dimensions[0], message);
    if (value.length !== length) {
      throw new Error(`${member.name} has ${value.length} elements, not ${length}`);
    }
    if (member.type === "byte" && dimensions.length === 1) {
      parts.push(Buffer.from(value.buffer, value.byteOffset, value.byteLength));
      return;
    }
    for (const element of value) {
      this.#encodeMember(member, dimensions.slice(1), element, message, parts);
    }
  }

  #decodeStruct(struct, reader) {
    const message = {};
    for (const member of struct.members) {
      message[member.name] = this.#decodeMember(member, member.dimensions, message, reader);
    }
    return message;
  }

  #decodeMember(member, dimensions, message, reader) {
    if (dimensions.length === 0) {
      if (isPrimitive(member.type)) return decodePrimitive(member.type, reader);
      return this.#decodeStruct(this.#struct(member.type), reader);
    }
    const length = lengthOf(dimensions[0], message);
    if (member.type === "byte" && dimensions.length === 1) return take(reader, length);
    const elements = [];
    for (let i = 0; i < length; ++i) {
      elements.push(this.#decodeMember(member, dimensions.slice(1), message, reader));
    }
    return elements;
  }
}

/** One piece for each run of short ones. */
function joinedWhereShort(parts) {
  const maxShortBytes = 4096;
  const joined = [];
  let run = [];
  const endRun = () => {
    if (run.length > 0) joined.push(Buffer.concat(run));
    run = [];
  };
  for (const part of parts) {
    if (part.length <= maxShortBytes) {
      run.push(part);
      continue;
    }
    endRun();
    joined.push(part);
  }
  endRun();
  return joined;
}

function structsOf(file, name) {
  try {
    return parseStructs(readFileSync(file, "utf8"));
  } catch (error) {
    throw new Error(`${name}: ${error.message}`);
  }
}

function parseStructs(text) {
  const code = text.replace(/\/\/.*$|\/\*[^]*?\*\//gm, "");
  return [...code.matchAll(/struct\s+(\w+)\s*\{([^}]*)\}/g)].map(([, name, body]) => ({ name, members: membersOf(body) }));
}

function membersOf(body) {
  const members = [];
  for (const declaration of body.split(";").map((part) => part.trim()).filter(Boolean)) {
    if (/^const\b/.test(declaration)) continue; // not sent, nor in the fingerprint
    const parts = /^(?:[\w.]+\.)?(\w+)\s+(\w.*)$/s.exec(declaration);
    if (!parts) throw new Error(`cannot read the member "${declaration}"`);
    const [, type, names] = parts;
    for (const declarator of names.split(/,(?![^[]*\])/)) {
      const dimensions = [...declarator.matchAll(/\[\s*(\w+)\s*\]/g)].map((match) => match[1]);
      members.push({ name: /\w+/.exec(declarator)[0], type, dimensions });
    }
  }
  return members;
}

const lengthOf = (dimension, message) =>
  /^\d/.test(dimension) ? Number(dimension) : Number(message[dimension]);

function structHash(struct) {
  let hash = 0x12345678n;
  const update = (byte) => {
    hash = BigInt.asIntN(64, ((hash << 8n) ^ (hash >> 55n)) + BigInt(byte));
  };
  const updateText = (text) => {
    update(text.length);
    for (const byte of Buffer.from(text)) update(byte);
  };
  for (const { name, type, dimensions } of struct.members) {
    updateText(name);
    if (isPrimitive(type)) updateText(type);
    update(dimensions.length);
    for (const dimension of dimensions) {
      update(/^\d/.test(dimension) ? 0 : 1); // a constant or a member's value
      updateText(dimension);
    }
  }
  return hash;
}

function bigEndian(numBytes, write) {
  const buffer = Buffer.alloc(numBytes);
  write(buffer);
  return buffer;
}

function encodePrimitive(type, value) {
  switch (type) {
    case "string": {
      const text = Buffer.from(`${value}\0`);
      return Buffer.concat([bigEndian(4, (buffer) => buffer.writeInt32BE(text.length)), text]);
    }
    case "int64_t":
      return bigEndian(8, (buffer) => buffer.writeBigInt64BE(BigInt(value)));
    case "float":
      return bigEndian(4, (buffer) => buffer.writeFloatBE(value));
    case "double":
      return bigEndian(8, (buffer) => buffer.writeDoubleBE(value));
    case "byte":
      return bigEndian(1, (buffer) => buffer.writeUInt8(value));
    default:
      return bigEndian(SIZES[type], (buffer) => buffer.writeIntBE(Number(value), 0, SIZES[type]));
  }
}

function take(reader, numBytes) {
  if (numBytes < 0 || reader.offset + numBytes > reader.bytes.length) {
    throw new Error("ends within the message");
  }
  reader.offset += numBytes;
  return reader.bytes.subarray(reader.offset - numBytes, reader.offset);
}

function decodePrimitive(type, reader) {
  if (type === "string") {
    const text = take(reader, take(reader, 4).readInt32BE());
    return text.subarray(0, -1).toString();
  }
  const bytes = take(reader, SIZES[type]);
  switch (type) {
    case "int64_t":
      return bytes.readBigInt64BE();
    case "float":
      return bytes.readFloatBE();
    case "double":
      return bytes.readDoubleBE();
    case "byte":
      return bytes.readUInt8();
    case "boolean":
      return bytes.readInt8() !== 0;
    default:
      return bytes.readIntBE(0, SIZES[type]);
  }
}

/** The types of this repository. */
export const voqcalTypes = () => new LcmTypes(new URL("../../../lcmtypes/", import.meta.url));
