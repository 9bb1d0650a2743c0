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

/** Red, green and blue of each point: of its range, or of the image, and then `unseen` where the camera does not see it. */
export function cloudColours(cloud: CloudFrame, image: Pixels | null, unseen: Rgb): Float32Array {
  const { positions_m, pixels } = cloud;
  const colours = new Float32Array(positions_m.length);
  for (let i = 0; i < positions_m.length / 3; ++i) {
    const range_m = Math.hypot(positions_m[3 * i]!, positions_m[3 * i + 1]!, positions_m[3 * i + 2]!);
    const isOfImage = image && pixels;
    const colour = isOfImage ? (colourAt(image, pixels[2 * i]!, pixels[2 * i + 1]!) ?? unseen) : rangeColour(range_m);
    colours.set(colour, 3 * i);
  }
  return colours;
}

function colourAt({ data, width, height, scale }: Pixels, u: number, v: number): Rgb | null {
  if (u === NOT_SEEN) return null;
  const nearest = (at: number, size: number) => Math.min(Math.max(Math.floor(scale * (at + 0.5)), 0), size - 1);
  const at = 4 * (nearest(v, height) * width + nearest(u, width));
  return [data[at]! / 255, data[at + 1]! / 255, data[at + 2]! / 255];
}
