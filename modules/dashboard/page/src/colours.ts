// The colour of a range: red is near, blue is far, equal steps for equal ratios.

/** Red, green and blue, 0 to 1. */
export type Rgb = readonly [number, number, number];

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

/** Of a hue in degrees, bright and nearly full. */
function rgb(hue: number): [number, number, number] {
  const [lightness, chroma] = [0.55, 0.95 * 0.45];
  const part = (shift: number) => {
    const k = (shift + hue / 30) % 12;
    return lightness - chroma * Math.max(-1, Math.min(k - 3, 9 - k, 1));
  };
  return [part(0), part(8), part(4)];
}

const STEPS = Array.from({ length: NUM_STEPS + 1 }, (_, i) => rgb(hue(i / NUM_STEPS)));
const PIXELS = Uint32Array.from(STEPS, ([red, green, blue]) => {
  const byte = (share: number) => Math.round(255 * share);
  return (255 << 24) | (byte(blue) << 16) | (byte(green) << 8) | byte(red);
});

export function rangeColour(range_m: number): Rgb {
  return STEPS[stepOf(range_m)]!;
}

/** As ImageData holds it on little-endian machines, which all with a browser are: alpha, blue, green, red. */
export function rangePixel(range_m: number): number {
  return PIXELS[stepOf(range_m)]!;
}

function stepOf(range_m: number): number {
  return Math.round(NUM_STEPS * rangeShare(range_m));
}

const themeColours = new Map<string, string>();

/** A colour of the style sheet, which knows whether it is dark: as "rgb(...)". Computed once for each scheme. */
export function themeColour(name: string): string {
  const key = `${name} ${matchMedia("(prefers-color-scheme: dark)").matches}`;
  const colour = themeColours.get(key) ?? computedColour(name);
  themeColours.set(key, colour);
  return colour;
}

/** Has the browser recalculate styles. */
function computedColour(name: string): string {
  const probe = document.createElement("i");
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}
