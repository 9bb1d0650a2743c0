// The colour of a range: red is near, blue is far, equal steps for equal ratios.

const NEAR_M = 1;
const FAR_M = 30;
const NUM_STEPS = 64;

/** 0 (near) to 1 (far). */
export function rangeShare(range_m: number): number {
  const share = Math.log(range_m / NEAR_M) / Math.log(FAR_M / NEAR_M);
  return Math.min(Math.max(share, 0), 1);
}

function hue(share: number): number {
  return 250 * share;
}

const STEPS = Array.from({ length: NUM_STEPS + 1 }, (_, i) => `hsl(${hue(i / NUM_STEPS)} 95% 55%)`);

export function rangeColour(range_m: number): string {
  return STEPS[Math.round(NUM_STEPS * rangeShare(range_m))]!;
}

/** Hue 0 to 1, for three.js. */
export function rangeHue(range_m: number): number {
  return hue(rangeShare(range_m)) / 360;
}

const probe = document.createElement("i");

/** A colour of the style sheet, which knows whether it is dark: as "rgb(...)". */
export function themeColour(name: string): string {
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}
