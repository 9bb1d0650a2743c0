// The colours of a sweep's points.

import { rangeColour, type Rgb } from "./colours.ts";
import { NOT_SEEN, type CloudFrame } from "./protocol.ts";

/** An image without what is drawn on it. */
export interface Pixels {
  /** Red, green, blue, alpha of each, 0 to 255. */
  data: ArrayLike<number>;
  width: number;
  height: number;
  /** Its pixels to one of the camera's. */
  scale: number;
}

/** What points take their colours from; null: from an image that is not there. */
export type ColourSource = "range" | Pixels | null;

/** Red, green and blue of each point: `unseen` where it is to have the image's, and that does not show it. */
export function cloudColours(cloud: CloudFrame, source: ColourSource, unseen: Rgb): Float32Array {
  const { positions_m, pixels } = cloud;
  const colours = new Float32Array(positions_m.length);
  for (let i = 0; i < positions_m.length / 3; ++i) {
    const range_m = Math.hypot(positions_m[3 * i]!, positions_m[3 * i + 1]!, positions_m[3 * i + 2]!);
    const colour =
      source === "range" ? rangeColour(range_m) : source && pixels && colourAt(source, pixels[2 * i]!, pixels[2 * i + 1]!);
    colours.set(colour ?? unseen, 3 * i);
  }
  return colours;
}

function colourAt({ data, width, height, scale }: Pixels, u: number, v: number): Rgb | null {
  if (u === NOT_SEEN) return null;
  const nearest = (at: number, size: number) => Math.min(Math.max(Math.floor(scale * (at + 0.5)), 0), size - 1);
  const at = 4 * (nearest(v, height) * width + nearest(u, width));
  return [data[at]! / 255, data[at + 1]! / 255, data[at + 2]! / 255];
}
