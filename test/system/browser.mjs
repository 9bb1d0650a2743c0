// A browser as people have one, for the scripts beside this file. Ends with 77 where there is no Chromium.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const require = createRequire(new URL("../../tools/node/package.json", import.meta.url));
const { chromium } = require("playwright-core");

/** What is wrong, a line each. */
export const problems = [];
export const demand = (isMet, problem) => {
  if (!isMet) problems.push(problem);
};
export const say = (text) => process.stdout.write(`${text}\n`);

export const SIZES = { desktop: { width: 1280, height: 900 }, phone: { width: 390, height: 844 }, landscape: { width: 844, height: 390 } };

function chromiumPath() {
  try {
    return execFileSync("sh", ["-c", "command -v chromium"]).toString().trim();
  } catch {
    process.stdout.write("skipped: no chromium (tools/setup installs it)\n");
    process.exit(77);
  }
}

/** Longer than anything takes on a busy machine, and shorter than a test may take. */
const PATIENCE_MS = 90_000;

/**
 * Waits until `condition`, which runs in the page with `argument`, holds. (Playwright's own way needs eval, which
 * the dashboard forbids its page.) Throws with what the page shows if it never does.
 */
export async function until(page, condition, argument) {
  const end = performance.now() + PATIENCE_MS;
  while (!(await page.evaluate(condition, argument))) {
    if (performance.now() > end) {
      const shown = await page.evaluate(() => document.body.innerText);
      throw new Error(`waited ${PATIENCE_MS / 1000} s in vain for ${condition} with ${JSON.stringify(argument)}; the page:\n${shown}`);
    }
    await page.waitForTimeout(100);
  }
}

/** A browser context with a profile of its own, and how to close it; flags: what Chromium is told besides. */
export async function openBrowser(flags = []) {
  const profile = mkdtempSync(join(tmpdir(), "voqcal-chromium-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: chromiumPath(),
    headless: true,
    timeout: 120_000,
    args: [
      "--no-sandbox",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--no-first-run",
      ...flags,
    ],
  });
  context.setDefaultTimeout(120_000);
  // Chromium's children may still write for a moment.
  const close = async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
  };
  return { context, close };
}

/** The page of a live session: what the scripts do with it, and `end`, which says the problems and sets the exit status. */
export async function openSession(session) {
  const { context, close } = await openBrowser();
  const page = await context.newPage();
  let isServerDown = false;
  page.on("console", (message) => {
    // Chromium reports each connection that fails; while there is no server they must.
    if (message.type() === "error" && !isServerDown) problems.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => problems.push(error.message));

  const waitUntil = (condition, argument) => until(page, condition, argument);
  const supervisorctl = (...args) => execFileSync("supervisorctl", ["-c", join(session, "supervisor.conf"), ...args]);
  /** Kills the server, which is started again; `meanwhile` runs once the page has seen that it is gone. */
  async function killServer(meanwhile = async () => {}) {
    const untilLive = (isLive) =>
      waitUntil((isLive) => (document.getElementById("connection").dataset.state === "live") === isLive, isLive);
    isServerDown = true;
    supervisorctl("signal", "KILL", "dashboard");
    await untilLive(false);
    await meanwhile();
    await untilLive(true);
    isServerDown = false;
  }
  async function end() {
    await close();
    for (const problem of problems) say(problem);
    process.exitCode = problems.length === 0 ? 0 : 1;
  }
  return {
    context,
    page,
    url: readFileSync(join(session, "dashboard_url.txt"), "utf8").trim(),
    text: (id) => page.locator(`#${id}`).innerText(),
    until: waitUntil,
    supervisorctl,
    killServer,
    end,
  };
}
