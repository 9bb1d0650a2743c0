// How far a long run is, on a terminal only: "importing: 34 %, 1234 MB, 310 MB/s".

export class Progress {
  #what;
  #begin = Date.now();
  #next = Date.now() + 1000;
  #numBytes = 0;
  #isShown = false;

  constructor(what) {
    this.#what = what;
  }

  /** @param share  0 to 1, or NaN where that is not known. */
  add(numBytes, share) {
    this.#numBytes += numBytes;
    const now = Date.now();
    if (!process.stderr.isTTY || now < this.#next) return;
    this.#next = now + 200;
    this.#isShown = true;
    const percent = Number.isFinite(share) ? `${Math.round(100 * share)} %, ` : "";
    process.stderr.write(`\r\x1b[K${this.#what}: ${percent}${this.rate()}`);
  }

  rate() {
    const megabytes = this.#numBytes / 1e6;
    const seconds = Math.max(Date.now() - this.#begin, 1) / 1000;
    return `${megabytes.toFixed(0)} MB, ${(megabytes / seconds).toFixed(0)} MB/s`;
  }

  end() {
    if (this.#isShown) process.stderr.write("\r\x1b[K");
  }
}
