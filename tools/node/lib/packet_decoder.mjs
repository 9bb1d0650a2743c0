// Packets to clouds, by the decoders of decode_lidar: the program decode_packets beside it, asked message by message,
// so that a recording always gives the same log.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { UserError } from "./command.mjs";
import { exactReader } from "./exact_reader.mjs";
import { programPath } from "./program_path.mjs";

const ANSWER_HEAD_BYTES = 5;

/** The decoder ended, or refuses the lidar: not the fault of one message. */
export class DecoderFailed extends UserError {}

export class PacketDecoder {
  #args;
  #child;
  #read;
  #ended;
  #errors = "";

  /** @param args  of decode_packets: --rig, --model, --calibration, --metadata. */
  constructor(args) {
    this.#args = args;
  }

  /** @returns the clouds that the packets completed, encoded. @param times  of their arrival, ns. */
  async add(packets, times) {
    if (!this.#child) this.#start();
    const pieces = packets.flatMap(({ bytes }, i) => [packetHead(bytes, times[i]), bytes]);
    this.#child.stdin.write(Buffer.concat([...pieces, Buffer.from("e")]));
    return (await this.#answers("e")).clouds;
  }

  /** The last clouds, and what there was in words; after an `add`. @throws DecoderFailed if no packet was understood. */
  async finish() {
    this.#child.stdin.end();
    return this.#answers("t");
  }

  close() {
    this.#child?.kill();
  }

  #start() {
    const program = programPath("decode_packets");
    if (!program) throw new DecoderFailed("packets are decoded by the program decode_packets, which is not built yet (tools/build)");
    this.#child = spawn(program, this.#args, { stdio: ["pipe", "pipe", "pipe"] });
    this.#child.stdin.on("error", () => {}); // its end says why
    this.#child.stderr.on("data", (text) => (this.#errors += text));
    this.#read = exactReader(this.#child.stdout);
    this.#ended = once(this.#child, "close");
  }

  async #answers(lastKind) {
    const clouds = [];
    for (;;) {
      const head = await this.#read(ANSWER_HEAD_BYTES);
      const bytes = head && (await this.#read(head.readUInt32LE(1)));
      if (bytes === undefined) throw await this.#failure();
      const kind = String.fromCharCode(head[0]);
      if (kind === lastKind) return { clouds, words: bytes.toString() };
      clouds.push(bytes);
    }
  }

  async #failure() {
    await this.#ended;
    return new DecoderFailed(this.#errors.trim().replace(/^decode_packets: /, "") || "decode_packets ended early");
  }
}

function packetHead(bytes, timeNs) {
  const head = Buffer.alloc(13);
  head.write("p", 0);
  head.writeBigInt64LE(timeNs / 1000n, 1);
  head.writeUInt32LE(bytes.length, 9);
  return head;
}
