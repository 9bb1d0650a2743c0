// What was taken and what was left out, by reason: however many pieces are bad, a few lines say so.

import { UserError } from "./command.mjs";

const MAX_REASONS = 5;

export class Tally {
  #what;
  #reasons = new Map(); // reason without its numbers -> {num, first}
  numTaken = 0;
  numLeftOut = 0;

  constructor(what) {
    this.#what = what;
  }

  leaveOut(reason) {
    const number = this.numTaken + this.numLeftOut++;
    const kind = reason.replace(/[\d.]+/g, "N");
    const known = this.#reasons.get(kind);
    if (known) ++known.num;
    else this.#reasons.set(kind, { num: 1, first: `number ${number}: ${reason}` });
  }

  /** "2 of 40 left out: 2 as number 3: the image has no bytes"; undefined if none was. */
  words() {
    if (this.numLeftOut === 0) return undefined;
    const kinds = [...this.#reasons.values()].sort((a, b) => b.num - a.num);
    const told = kinds.slice(0, MAX_REASONS).map(({ num, first }) => `${num} like ${first}`);
    const rest = kinds.slice(MAX_REASONS).reduce((sum, { num }) => sum + num, 0);
    if (rest > 0) told.push(`${rest} for ${kinds.length - MAX_REASONS} other reasons`);
    return `${this.numLeftOut} of ${this.numTaken + this.numLeftOut} left out: ${told.join("; ")}`;
  }

  requireSome() {
    if (this.numTaken > 0) return;
    throw new UserError(`${this.#what}: ${this.words() ?? "has no message"}`);
  }
}
