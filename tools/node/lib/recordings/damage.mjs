// What of a recording could not be read: one line a kind, however many pieces are bad.

export class Damage {
  #kinds = new Map(); // what -> {num, first, why}

  /** @param what  "chunk": of which one more is left out; begins at byte `at`. */
  note(what, at, why) {
    const known = this.#kinds.get(what);
    if (known) ++known.num;
    else this.#kinds.set(what, { num: 1, first: at, why });
  }

  /** "2 chunks are damaged and left out, the first at byte 4711 (its checksum is another)". */
  words() {
    return [...this.#kinds].map(([what, { num, first, why }]) => {
      const [whatIs, where] = num === 1 ? [`${what} is`, ""] : [`${what}s are`, "the first "];
      return `${num} ${whatIs} damaged and left out, ${where}at byte ${first} (${why})`;
    });
  }
}
