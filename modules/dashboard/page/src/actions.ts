// The buttons, and what becomes of what they asked for.

import { byId, setText } from "./dom.ts";
import { News } from "./news.ts";
import { eventText } from "./panels.ts";
import { signalTaken } from "./signal.ts";
import { pairText } from "./pairs.ts";
import type { CommandName, Events, PairName, Pairs, Request, Samples } from "./protocol.ts";

/** What is waited for after a command, said once it takes longer than a moment. */
const WAITING: Record<CommandName, string> = {
  capture: "Waiting for both sensors to see the board",
  discard: "Discarding",
  finish: "Finishing",
  reset: "Taking all samples away",
};
const ANSWERS: Record<CommandName, string[]> = {
  capture: ["accepted"],
  discard: ["discarded", "rejected"],
  finish: ["finished"],
  reset: ["reset"],
};
const MOMENT_MS = 400;
/** What is clicked so soon after the page turned to another pair by itself was meant for the one before. */
const TURN_MS = 800;
const GIVE_UP_MS = 30_000;

export class Actions {
  private waitingFor: CommandName | null = null;
  private timers: number[] = [];
  private news = new News();
  private isLive = false;
  private mayCapture = false;
  private hasSamples = false;
  /** Of any pair. */
  private hasAnySamples = false;
  /** Which is shown; null where there is but one. */
  private pair: PairName | null = null;
  private turnedAtMs = -Infinity;

  constructor(private readonly sendRequest: (request: Request) => boolean) {
    for (const command of ["capture", "discard"] as const) {
      byId(command).addEventListener("click", () => this.sendOfPair({ command }));
    }
    byId("finish").addEventListener("click", () => this.send({ command: "finish" }));
    const confirm = byId<HTMLDialogElement>("confirm-reset");
    let named: PairName | null = null;
    byId("reset").addEventListener("click", () => {
      named = this.pair;
      if (named) nameInConfirm(named);
      confirm.showModal();
    });
    confirm.addEventListener("close", () => {
      if (confirm.returnValue === "reset") this.send({ command: "reset" });
      if (confirm.returnValue === "pair") this.send({ command: "reset", pair: named!.name });
      confirm.returnValue = "";
    });
    const exports = byId<HTMLDialogElement>("export-dialog");
    byId("export").addEventListener("click", () => exports.showModal());
    document.addEventListener("keydown", (event) => this.onKey(event));
  }

  /** What is of samples is of the pair that is shown. */
  sendOfPair(request: { command: CommandName; sample_id?: number }): void {
    if (performance.now() < this.turnedAtMs + TURN_MS) return this.say(`Not sent: this is ${pairText(this.pair!)} by now`);
    this.send(this.pair ? { ...request, pair: this.pair.name } : request);
  }

  /** To all pairs, if it names none. */
  private send(request: { command: CommandName; sample_id?: number; pair?: string }): void {
    if (!this.sendRequest(request)) return this.say("Not sent: there is no connection");
    this.stopWaiting();
    this.waitingFor = request.command;
    this.timers = [
      window.setTimeout(() => this.showWaiting(WAITING[request.command]), MOMENT_MS),
      window.setTimeout(() => {
        this.stopWaiting();
        this.say("Nothing came of it: are the sensors and the sample collector running?");
      }, GIVE_UP_MS),
    ];
  }

  say(text: string): void {
    setText("said", text);
  }

  /** @param mayCapture  whether a capture can come to anything. */
  setLive(isLive: boolean, mayCapture: boolean): void {
    this.isLive = isLive;
    this.mayCapture = mayCapture;
    if (!isLive) this.stopWaiting();
    this.enable();
  }

  /** The next thing to press is the largest. */
  setEnough(isEnough: boolean): void {
    byId("capture").classList.toggle("main", !isEnough);
    byId("finish").classList.toggle("main", isEnough);
  }

  /** Something is being asked or waits for its answer: it is of the pair that is shown. */
  isBusy(): boolean {
    return this.waitingFor !== null || document.querySelector("dialog[open]") !== null;
  }

  /**
   * What comes from now on is of this one.
   * @param isOwnChoice  of who clicks; else the page turned by itself.
   */
  setPair(pair: PairName, isOwnChoice: boolean): void {
    const isTurn = this.pair !== null && !isOwnChoice;
    this.turnedAtMs = isTurn ? performance.now() : -Infinity;
    this.pair = pair;
    this.news = new News();
    this.stopWaiting();
    this.say("");
  }

  takePairs({ pairs }: Pairs): void {
    this.hasAnySamples = pairs.some(({ num_samples }) => num_samples > 0);
    this.enable();
  }

  takeSamples({ samples }: Samples): void {
    this.hasSamples = samples.length > 0;
    this.enable();
  }

  /** @return whether they tell of a sample that was taken. */
  takeEvents({ events }: Events): boolean {
    const news = this.news.since(events);
    // Rejects come by the second: they are news only to who waits for a sample.
    const told = news.find((event) => event.event !== "rejected" || this.waitingFor !== null);
    if (told) this.say(eventText(told));
    const isTaken = news.some((event) => event.event === "accepted");
    if (isTaken) signalTaken();
    const answers = this.waitingFor === null ? [] : ANSWERS[this.waitingFor];
    if (news.some((event) => answers.includes(event.event))) this.stopWaiting();
    return isTaken;
  }

  takeRefusal(reason: string): void {
    this.stopWaiting();
    this.say(`Refused: ${reason}`);
  }

  private enable(): void {
    const set = (id: string, isOn: boolean) => (byId<HTMLButtonElement>(id).disabled = !isOn);
    set("capture", this.isLive && this.mayCapture);
    set("finish", this.isLive);  // without samples it tells what was seen instead
    set("discard", this.isLive && this.hasSamples);
    set("reset", this.isLive && (this.hasSamples || this.hasAnySamples));
  }

  private showWaiting(text: string): void {
    byId("waiting").hidden = false;
    setText("waiting-text", text);
  }

  private stopWaiting(): void {
    for (const timer of this.timers) clearTimeout(timer);
    this.waitingFor = null;
    byId("waiting").hidden = true;
  }

  /** C captures: the other keys are the browser's. */
  private onKey(event: KeyboardEvent): void {
    const isTyping = event.ctrlKey || event.altKey || event.metaKey || event.repeat;
    if (isTyping || event.key.toLowerCase() !== "c" || document.querySelector("dialog[open]")) return;
    byId("capture").click();
  }
}

function nameInConfirm(pair: PairName): void {
  byId("reset-pair").hidden = false;
  setText("reset-pair", `Reset ${pairText(pair)} alone`);
  setText("reset-all", "Reset all pairs");
  setText("confirm-text", `All pairs begin anew, or ${pairText(pair)} alone.`);
}
