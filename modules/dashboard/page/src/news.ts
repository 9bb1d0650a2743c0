// Which events are news.

import type { Events } from "./protocol.ts";

type Event = Events["events"][number];

/** The newest event is first. */
export class News {
  private lastSeq = -1;
  private hasBegun = false;

  /** Those since the last call, the newest first; what was before the first call is no news. */
  since(events: Event[]): Event[] {
    const run = newestRun(events);
    const isFirstCall = !this.hasBegun;
    this.hasBegun = true;
    const newest = run[0];
    if (!newest) return [];
    const isNewRun = newest.seq < this.lastSeq;
    const news = isFirstCall ? [] : run.filter((event) => isNewRun || event.seq > this.lastSeq);
    this.lastSeq = newest.seq;
    return news;
  }
}

/** Events count up from 0; a sample collector that was started again begins anew, before which come older ones. */
function newestRun(events: Event[]): Event[] {
  const end = events.findIndex((event, i) => i > 0 && event.seq >= events[i - 1]!.seq);
  return end < 0 ? events : events.slice(0, end);
}
