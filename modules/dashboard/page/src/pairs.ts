// All pairs of a rig of several sensors, and which of them the page shows.

import { byId, element, number, setText } from "./dom.ts";
import { gradedList } from "./panels.ts";
import type { PairName, PairRow, Pairs } from "./protocol.ts";

export function pairText({ lidar, camera }: PairName): string {
  return `${lidar} → ${camera}`;
}

/** The pair that an address's fragment names; null: none. */
export function pairOfHash(hash: string): string | null {
  try {
    return decodeURIComponent(hash.slice(1)) || null;
  } catch {
    return null; // no text: typed or cut by somebody
  }
}

/** A pair that the page turned to, or that a sample was taken of, is not taken away at once: time to see it and to discard. */
const HOLD_MS = 5000;
/** But where another is next, samples that go on coming do not hold it for ever. */
const MOST_HOLD_MS = 2 * HOLD_MS;

/** The operator's own choice, which stays (over a reload too: it is the address's fragment); without one that which is next. */
export class PairChoice {
  private heldUntilMs = 0;
  /** Since when another than the shown one is next. */
  private otherSinceMs: number | null = null;

  constructor(private own: string | null) {}

  choose(name: string | null): void {
    this.own = name;
    this.heldUntilMs = 0;
  }

  isOwn(): boolean {
    return this.own !== null;
  }

  /** The page does not turn to another pair by itself for some seconds from `nowMs` on. */
  hold(nowMs: number): void {
    this.heldUntilMs = nowMs + HOLD_MS;
  }

  /**
   * @param shown   which the page shows by now; null: none yet.
   * @param isBusy  something was asked of that one which is not answered yet.
   */
  wanted({ pairs, next }: Pairs, shown: string | null, isBusy: boolean, nowMs: number): string {
    const has = (name: string | null) => pairs.some((row) => row.name === name);
    if (has(this.own)) return this.own!;
    this.own = null; // of another rig
    if (has(shown) && (!has(next) || shown === next)) {
      this.otherSinceMs = null;
      return shown!;
    }
    this.otherSinceMs ??= nowMs;
    const isHeld = nowMs < Math.min(this.heldUntilMs, this.otherSinceMs + MOST_HOLD_MS);
    if (has(shown) && (isBusy || isHeld)) return shown!;
    this.otherSinceMs = null;
    if (has(shown)) this.hold(nowMs);
    return has(next) ? next : pairs[0]!.name;
  }
}

/** What there is to say of a pair, the gravest first. */
export function stateOf(row: PairRow): string {
  if (row.silent) return `${row.silent} is silent`;
  if (row.unheard) return `${row.unheard} has sent nothing yet`;
  const said = row.problem || row.headline;
  if (!said) return row.num_samples > 0 ? "being calibrated" : "no samples yet";
  return row.is_current ? said : `${said} (being renewed)`;
}

export function showPairs({ pairs, next, problem, verdict, is_current }: Pairs, shown: string, choose: (name: string) => void): void {
  byId("pairs-panel").hidden = false;
  const list = byId("pairs");
  for (const row of pairs) {
    const button = list.querySelector<HTMLElement>(`[data-pair="${row.name}"]`) ?? addPair(list, row, choose);
    button.setAttribute("aria-pressed", `${row.name === shown}`);
    button.dataset.grade = row.silent ? "bad" : row.grade || "none";
    button.dataset.isNext = `${row.name === next}`;
    const [, mark, figures, state] = button.children as unknown as HTMLElement[];
    put(mark!, row.name === next ? "next" : "");
    put(figures!, `${row.num_samples} ${row.num_samples === 1 ? "sample" : "samples"}${errorText(row)}`);
    put(state!, stateOf(row));
  }
  byId("rig-result").hidden = false;
  byId("rig-verdict").dataset.grade = verdict?.grade ?? "none";
  const isOlder = verdict !== undefined && !is_current;
  setText("rig-verdict", `Rig: ${verdict?.headline ?? "no result yet"}${isOlder ? " (of earlier samples)" : ""}`);
  setText("rig-problem", problem);
  const checks = verdict?.checks ?? [];
  gradedList("rig-bad", checks.filter(({ grade }) => grade === "bad"));
  gradedList("rig-checks", checks.filter(({ grade }) => grade !== "bad"));
  byId("rig-checks").parentElement!.hidden = checks.every(({ grade }) => grade === "bad");
}

/** Where it is worst over the scene, as the guide expects it. */
function errorText({ worst_error, unit, is_enough }: PairRow): string {
  if (worst_error === null || worst_error === undefined) return "";
  return `, ± ${number(worst_error, worst_error < 10 ? 1 : 0, unit!)}${is_enough ? " ✓" : ""}`;
}

function put(part: HTMLElement, text: string): void {
  if (part.textContent !== text) part.textContent = text;
}

function addPair(list: HTMLElement, row: PairRow, choose: (name: string) => void): HTMLElement {
  const spans = ["name", "mark", "figures", "state"].map((name) => element("span", { class: name }));
  spans[0]!.textContent = pairText(row);
  const title = "Samples, and the error that is expected where it is worst over the scene";
  const button = element("button", { type: "button", "data-pair": row.name, title }, ...spans);
  button.addEventListener("click", () => choose(row.name));
  list.append(element("li", {}, button));
  return button;
}

/** In a strip that is wider than the screen. */
export function scrollToPair(name: string): void {
  const list = byId("pairs");
  const item = list.querySelector<HTMLElement>(`[data-pair="${name}"]`)?.parentElement;
  if (item && list.scrollWidth > list.clientWidth) list.scrollTo({ left: item.offsetLeft - list.offsetLeft - 12 });
}
