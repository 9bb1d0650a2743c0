// The parts of the page that are text: guidance, estimate, samples, rejects, modules.

import { byId, element, number, setText } from "./dom.ts";
import type { Check, Events, Fault, Guidance, Modules, Report, Result, Sample, Samples } from "./protocol.ts";

/** Before anything is known of a pair. */
export function showFirstGuidance(): void {
  setText("advice", "Hold the board where both sensors see it, and rest.");
  setText("advice-why", "");
  delete byId("guidance").dataset.state;
  byId("enough-meter").hidden = byId("near-meter").hidden = true;
}

/** Says what there is instead of an order, where nothing would come of one. */
export function showNoGuidance(instead: string): void {
  setText("advice", instead);
  setText("advice-why", "");
  byId("guidance").dataset.state = "halted";
  byId("enough-meter").hidden = byId("near-meter").hidden = true;
}

/** Full where the board is as it is asked to be, empty from a metre on. */
function showNearness({ away_m, is_enough }: Guidance): void {
  const meter = byId<HTMLMeterElement>("near-meter");
  meter.hidden = is_enough || away_m === null;
  meter.value = 1 - Math.min(1, away_m ?? 1);
}

export function showGuidance(guidance: Guidance): void {
  const { unit, tolerance, min_range_m, max_range_m, worst_error, predicted_worst_error, min_samples } = guidance;
  const advice = guidance.advice || guidance.problem;
  setText("advice", sentence(advice));
  byId("guidance").dataset.state = guidance.is_enough ? "enough" : "more";
  showNearness(guidance);
  const where = `between ${min_range_m} and ${max_range_m} m`;
  const known = worst_error !== null;
  const now = known
    ? `Expected error at worst ${number(worst_error, 1, unit)} ${where}; wanted ${number(tolerance, 1, unit)}` +
      (worst_error <= tolerance ? `, by at least ${min_samples} samples.` : ".")
    : `Wanted: at most ${number(tolerance, 1, unit)} of error ${where}.`;
  const next = guidance.is_enough || predicted_worst_error === null || !known
    ? ""
    : ` One more sample there: ${number(predicted_worst_error, 1, unit)}.`;
  setText("advice-why", guidance.problem || guidance.is_enough ? "" : `Left and right are the image's. ${now}${next}`);
  const meter = byId<HTMLProgressElement>("enough-meter");
  meter.hidden = !known;
  meter.value = known ? Math.min(1, tolerance / Math.max(worst_error, tolerance, 1e-9)) : 0;
}

/** @param folder  of the files within the session's: "" or "front_left/". */
export function showResult(result: Result, folder: string): void {
  byId("progress").hidden = result.working_on === "";
  setText("progress-text", result.working_on);
  const verdict = result.verdict;
  byId("verdict").dataset.grade = verdict?.grade ?? "none";
  setText("verdict", verdict?.headline ?? (result.problem ? `No result: ${result.problem}` : "No result yet"));
  byId("estimate").hidden = verdict === undefined;
  showExports((result.exports ?? []).map((name) => folder + name));
  if (!verdict) return;
  setText("translation", `${list(result.translation_m!.map((metres) => 1e3 * metres), 1)} mm`);
  setText("translation-sigma", `± ${list(result.sigma_mm!, 1)} mm`);
  setText("quaternion", list(result.quaternion_xyzw!, 5));
  setText("rotation-sigma", `± ${list(result.sigma_deg!, 3)} deg`);
  setText("place-sigma", `± ${list(result.place_sigma_mm!, 1)} mm, ± ${list(result.place_sigma_deg!, 3)} deg`);
  const { centre_mm, centre_px } = result.held_out!;
  setText(
    "held-out",
    `${number(centre_mm.mean, 1, "mm")} (largest ${number(centre_mm.max, 1, "mm")}), ${number(centre_px.mean, 2, "px")}`,
  );
  setText(
    "predicted",
    result.predicted!.map((each) => `${number(each.corner_mm, 0, "mm")} at ${each.range_m} m`).join(", "),
  );
  setText("made-from", `${result.num_samples} samples, by ${result.method}${result.is_current ? "" : "; being renewed"}`);
  const isGood = (check: Check) => check.grade === "good";
  const isBad = (check: Check) => check.grade === "bad";
  const marked = verdict.checks.filter((check) => !isGood(check));
  gradedList("marked", [...marked.filter(isBad), ...marked.filter((check) => !isBad(check))]);
  gradedList("checks", verdict.checks.filter(isGood));
}

/** @param within  as showResult's folder. */
export function showReport({ state, file, folder }: Report, within: string): void {
  const line = byId("report");
  line.hidden = state === "";
  line.dataset.state = state;
  if (state === "making") line.replaceChildren("Making the report");
  if (state === "failed") line.replaceChildren(`No report could be made: see ${folder}/report.txt`);
  if (state !== "made") return;
  const name = file === "report.html" ? "The report" : "What was seen instead";
  const link = element("a", { href: `export/${within}${file}`, target: "_blank", rel: "noopener" }, name);
  line.replaceChildren(link, element("span", { class: "soft" }, ` ${folder}/${file}`));
}

export function gradedList(id: string, checks: Check[]): void {
  byId(id).replaceChildren(...checks.map(checkItem));
}

function checkItem(check: Check): HTMLElement {
  return element(
    "li",
    { "data-grade": check.grade },
    element("strong", {}, `${check.name}: ${check.grade}. `),
    check.text,
  );
}

function list(values: (number | null)[], digits: number): string {
  return values.map((value) => value?.toFixed(digits) ?? "?").join("  ");
}

function showExports(names: string[]): void {
  const list = byId("exports");
  if (list.dataset.names === names.join()) return;
  list.dataset.names = names.join();
  byId<HTMLButtonElement>("export").disabled = names.length === 0;
  list.replaceChildren(
    ...names.map((name) => element("li", {}, element("a", { href: `export/${name}`, download: name }, name))),
  );
}

function facing(degrees: number, positive: string, negative: string): string {
  const whole = Math.round(Math.abs(degrees));
  return whole === 0 ? "" : `${whole}° ${degrees > 0 ? positive : negative}`;
}

export function showSamples({ samples, is_finished }: Samples, discard: (id: number) => void): void {
  setText("sample-count", `${samples.length}`);
  setText("finished", is_finished ? "Finished: no more is taken. Capture goes on." : "");
  byId("no-samples").hidden = samples.length > 0;
  const list = byId("samples");
  const known = new Map([...list.children].map((item) => [(item as HTMLElement).dataset.sample, item as HTMLElement]));
  for (const sample of samples) {
    const item = known.get(`${sample.id}`) ?? sampleItem(sample.id, discard);
    known.delete(`${sample.id}`);
    if (!item.parentElement) list.prepend(item);
    item.className = sample.left_out ? "left-out" : "";
    const facts = factsOf(sample);
    const shown = item.querySelector<HTMLElement>(".facts")!;
    if (shown.dataset.facts === facts.join()) continue;
    shown.dataset.facts = facts.join();
    shown.replaceChildren(...facts.map((fact) => element("span", {}, fact)));
  }
  for (const gone of known.values()) gone.remove();
}

/** Stays the same as long as the sample does: a button must not vanish under a finger. */
function sampleItem(id: number, discard: (id: number) => void): HTMLElement {
  const button = element("button", { type: "button", class: "quiet", "aria-label": `Discard sample ${id}` }, "Discard");
  button.addEventListener("click", () => discard(id));
  return element(
    "li",
    { "data-sample": `${id}` },
    element("b", {}, `${id}`),
    element("span", { class: "facts" }),
    button,
  );
}

function factsOf(sample: Sample): string[] {
  const turned = [facing(sample.faces_right_deg, "right", "left"), facing(sample.faces_up_deg, "up", "down")];
  return [
    number(sample.distance_m, 2, "m"),
    `e_dim ${number(sample.e_dim_mm, 0, "mm")}`,
    `faces ${turned.filter(Boolean).join(", ") || "the camera"}`,
    ...(sample.held_out_mm === undefined ? [] : [`error ${number(sample.held_out_mm, 1, "mm")}`]),
    ...(sample.left_out ? [`left out: ${sample.left_out}`] : []),
    ...sample.warnings,
  ];
}

export function eventText(event: Events["events"][number]): string {
  const sample = event.sample_id > 0 ? ` ${event.sample_id}` : "";
  const what: Record<string, string> = {
    accepted: `Sample${sample} taken`,
    discarded: `Sample${sample} discarded`,
    finished: "Finished",
    reset: "All samples taken away",
    rejected: "Not taken",
  };
  return (what[event.event] ?? event.event) + (event.reason ? `: ${event.reason}` : "");
}

export function showEvents({ events }: Events): void {
  byId("events").replaceChildren(
    ...events.slice(0, 15).map((event) =>
      element(
        "li",
        { class: event.event },
        eventText(event),
        ...(event.count > 1 ? [element("span", { class: "count" }, ` ${event.count}×`)] : []),
      ),
    ),
  );
}

export function showModules({ modules }: Modules): void {
  const bad = modules.filter(({ health }) => health === "silent" || health === "failed");
  const ended = modules.filter(({ health }) => health === "ended").map(({ name }) => name);
  const good = ended.length === 0 ? `All ${modules.length} modules run` : `${ended.join(", ")} ended, the others run`;
  setText("modules-summary", bad.length === 0 ? good : bad.map(({ name, health }) => `${name}: ${health}`).join("; "));
  byId("modules-panel").dataset.state = bad.length === 0 ? "good" : "bad";
  byId("modules").replaceChildren(
    ...modules.map((module) =>
      element("li", { "data-health": module.health }, element("b", {}, module.name), ` ${module.state}`),
    ),
  );
}

/** Faults stand first on the page. What did not change is left alone, for who selects its text or hears it read. */
export function showFaults(faults: Fault[]): void {
  const panel = byId("faults");
  panel.hidden = faults.length === 0;
  const list = byId("fault-list");
  faults.forEach((fault, i) => {
    const item = list.children[i] ?? list.appendChild(faultItem());
    (item as HTMLElement).dataset.grave = `${fault.is_grave}`;
    const [what, cause, remedy] = item.children as unknown as HTMLElement[];
    const put = (part: HTMLElement, text: string) => part.textContent !== text && (part.textContent = text);
    put(what!, sentence(fault.what));
    put(cause!, sentence(fault.cause));
    put(remedy!, sentence(fault.remedy));
  });
  while (list.children.length > faults.length) list.lastElementChild!.remove();
}

/** Names of modules keep their small letter. */
function sentence(text: string): string {
  return /^[a-z]+[_/-]/.test(text) ? text : text.charAt(0).toUpperCase() + text.slice(1);
}

function faultItem(): HTMLElement {
  return element(
    "li",
    {},
    element("strong", {}),
    element("p", { class: "cause" }),
    element("p", { class: "remedy" }),
  );
}
