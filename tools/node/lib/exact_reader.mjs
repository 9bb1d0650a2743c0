/** A function that reads so many bytes of a stream; undefined where it ends before them. */
export function exactReader(stream) {
  const pieces = stream[Symbol.asyncIterator]();
  let piece = Buffer.alloc(0);
  return async (length) => {
    const bytes = Buffer.allocUnsafe(length);
    for (let done = 0; done < length; ) {
      if (piece.length === 0) {
        const next = await pieces.next();
        if (next.done) return undefined;
        piece = next.value;
      }
      const num = piece.copy(bytes, done);
      piece = piece.subarray(num);
      done += num;
    }
    return bytes;
  };
}
