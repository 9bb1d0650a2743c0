// Several files as one recording: one after the other, or side by side where their times overlap.

import { UserError } from "../command.mjs";

/** The index of a file led to bytes that cannot be read: a scan finds what is still there. */
export class DamagedIndex extends Error {}

export function merged(parts, onClose) {
  parts.sort((a, b) => Number((a.startNs ?? 0n) - (b.startNs ?? 0n)));
  return {
    topics: topicsOf(parts),
    messages: (names) => inOrderOfTime(parts, names),
    get remarks() {
      return parts.flatMap(({ path, remarks }) => remarks.map((remark) => `${path}: ${remark}`));
    },
    async close() {
      for (const part of parts) await part.close();
      onClose();
    },
  };
}

function topicsOf(parts) {
  const topics = new Map();
  for (const part of parts) {
    for (const [name, { type, count }] of part.topics) {
      const there = topics.get(name);
      if (there && there.type !== type) {
        throw new UserError(`${part.path}: topic ${name} is of type ${type}, in another file ${there.type}`);
      }
      topics.set(name, { type, count: count + (there?.count ?? 0) });
    }
  }
  return topics;
}

async function* inOrderOfTime(parts, names) {
  const waiting = [...parts];
  const open = []; // {messages, head} of the parts that have begun
  const begin = async () => {
    const part = waiting.shift();
    await advance({ part, messages: part.messages(names) });
  };
  const advance = async (source) => {
    source.head = await next(source);
    if (source.head) open.push(source);
  };
  try {
    while (waiting.length > 0 || open.length > 0) {
      const isNext = () => open.length === 0 || open.every(({ head }) => waiting[0].startNs <= head.logTimeNs);
      while (waiting.length > 0 && isNext()) await begin();
      if (open.length === 0) continue;
      const first = open.reduce((least, source) => (source.head.logTimeNs < least.head.logTimeNs ? source : least));
      yield first.head;
      open.splice(open.indexOf(first), 1);
      await advance(first);
    }
  } finally {
    for (const { messages } of open) await messages.return(); // whoever reads may have enough
  }
}

async function next({ part, messages }) {
  try {
    const { done, value } = await messages.next();
    return done ? undefined : value;
  } catch (error) {
    if (part.isIndexed) throw new DamagedIndex(`${part.path}: ${error.message}`);
    throw new UserError(`${part.path}: ${error.message}`);
  }
}
