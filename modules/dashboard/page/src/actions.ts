// The buttons, and what becomes of what they asked for.

import { byId, setText } from "./dom.ts";
import { News } from "./news.ts";
import { eventText } from "./panels.ts";
import { signalTaken } from "./signal.ts";
import type { CommandName, Events, Request, Samples } from "./protocol.ts";

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
const GIVE_UP_MS = 30_000;

export class Actions {
  private waitingFor: CommandName | null = null;
  private timers: number[] = [];
  private readonly news = new News();
  private isLive = false;
  private mayCapture = false;
  private hasSamples = false;

  constructor(private readonly sendRequest: (request: Request) => boolean) {
    for (const command of ["capture", "discard", "finish"] as const) {
      byId(command).addEventListener("click", () => this.send({ command }));
    }
    const confirm = byId<HTMLDialogElement>("confirm-reset");
    byId("reset").addEventListener("click", () => confirm.showModal());
    confirm.addEventListener("close", () => {
      if (confirm.returnValue === "reset") this.send({ command: "reset" });
      confirm.returnValue = "";
    });
    const exports = byId<HTMLDialogElement>("export-dialog");
    byId("export").addEventListener("click", () => exports.showModal());
    document.addEventListener("keydown", (event) => this.onKey(event));
  }

  send(request: { command: CommandName; sample_id?: number }): void {
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

  takeSamples({ samples }: Samples): void {
    this.hasSamples = samples.length > 0;
    this.enable();
  }

  takeEvents({ events }: Events): void {
    const news = this.news.since(events);
    // Rejects come by the second: they are news only to who waits for a sample.
    const told = news.find((event) => event.event !== "rejected" || this.waitingFor !== null);
    if (told) this.say(eventText(told));
    if (news.some((event) => event.event === "accepted")) signalTaken();
    if (this.waitingFor === null) return;
    const answers = ANSWERS[this.waitingFor];
    if (news.some((event) => answers.includes(event.event))) this.stopWaiting();
  }

  private enable(): void {
    const set = (id: string, isOn: boolean) => (byId<HTMLButtonElement>(id).disabled = !isOn);
    set("capture", this.isLive && this.mayCapture);
    set("finish", this.isLive);  // without samples it tells what was seen instead
    for (const id of ["discard", "reset"]) set(id, this.isLive && this.hasSamples);
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
