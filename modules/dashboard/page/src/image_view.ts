// The live image with what was found in it.

import type { Pixels } from "./cloud_colours.ts";
import { rangePixel } from "./colours.ts";
import { NOT_SEEN, type CloudFrame, type Guidance, type ImageFrame } from "./protocol.ts";

/** Points take the colours of images that are at most so much older or newer: only what moves is then beside it. */
const MAX_COLOUR_OFFSET_US = 2_000_000;

export class ImageView {
  private bitmap: ImageBitmap | null = null;
  private frame: ImageFrame | null = null;
  private cloud: CloudFrame | null = null;
  private guidance: Guidance | null = null;
  private drawnCloud: CloudFrame | null = null;
  private cleared = 0;
  private pixels: { of: ImageBitmap; image: ImageData } | null = null;
  private readonly context: CanvasRenderingContext2D;
  private readonly points = document.createElement("canvas").getContext("2d")!;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly hasPoints: HTMLInputElement,
  ) {
    this.context = canvas.getContext("2d")!;
    hasPoints.addEventListener("change", () => void this.draw());
  }

  /** Resolves once the image is on the screen. */
  async show(frame: ImageFrame): Promise<void> {
    const cleared = this.cleared;
    const bitmap = await createImageBitmap(frame.data);
    if (cleared !== this.cleared) return bitmap.close();
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.frame = frame;
    await this.draw();
  }

  /** Nothing of what was shown is left. */
  clear(): void {
    this.bitmap?.close();
    this.bitmap = this.frame = this.cloud = this.guidance = this.drawnCloud = this.pixels = null;
    ++this.cleared;
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    delete this.canvas.dataset.utime;
  }

  // These show with the next image.
  showCloud(cloud: CloudFrame): void {
    this.cloud = cloud;
  }

  /** What a sweep's points can take their colours from; null if it shows another moment. */
  pixelsFor({ utime }: CloudFrame): Pixels | null {
    const { bitmap, frame } = this;
    if (!bitmap || !frame || Math.abs(utime - frame.utime) > MAX_COLOUR_OFFSET_US) return null;
    if (this.pixels?.of !== bitmap) this.pixels = { of: bitmap, image: imageOf(bitmap) };
    const { data, width, height } = this.pixels.image;
    return { data, width, height, scale: width / frame.width };
  }

  /** Null: no order is given. */
  showGuidance(guidance: Guidance | null): void {
    this.guidance = guidance;
  }

  private draw(): Promise<void> {
    return new Promise((resolve) => {
      requestAnimationFrame(() => {
        this.drawNow();
        resolve();
      });
    });
  }

  private drawNow(): void {
    const { bitmap, frame, canvas, context } = this;
    if (!bitmap || !frame) return;
    if (canvas.width !== bitmap.width) canvas.width = bitmap.width;
    if (canvas.height !== bitmap.height) canvas.height = bitmap.height;
    context.drawImage(bitmap, 0, 0);
    canvas.dataset.utime = `${frame.utime}`;
    const scale = bitmap.width / frame.width;
    if (this.hasPoints.checked) this.drawPoints(scale);
    this.drawGhost(scale);
    this.drawBoard(scale);
  }

  /** Drawn once a sweep, shown with every image until the next. */
  private drawPoints(scale: number): void {
    if (!this.cloud?.pixels) return;
    if (this.drawnCloud !== this.cloud || this.points.canvas.width !== this.canvas.width) {
      this.drawnCloud = this.cloud;
      paintPoints(this.points, this.cloud, this.canvas, scale);
    }
    this.context.drawImage(this.points.canvas, 0, 0);
  }

  private drawBoard(scale: number): void {
    const { context } = this;
    const board = this.frame!.board;
    if (!board || board.miss) return;
    if (board.outline_px) this.drawPolygon(board.outline_px, scale, "#31d158", []);
    context.fillStyle = "#31d158";
    context.strokeStyle = "#003b12";
    context.lineWidth = 1;
    const radius = Math.max(2.5, this.canvas.width / 260);
    for (const [u, v] of board.corners_px ?? []) {
      context.beginPath();
      context.arc(scale * (u + 0.5), scale * (v + 0.5), radius, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
  }

  private drawGhost(scale: number): void {
    const corners = this.guidance?.corners_px;
    if (!corners || this.guidance!.is_enough) return;
    if (corners.flat().some((value) => value === null)) return;
    this.drawPolygon(corners as number[][], scale, "#ffd60a", [8, 5]);
    this.context.fillStyle = "rgb(255 214 10 / 22%)";
    this.context.fill();
  }

  private drawPolygon(corners: number[][], scale: number, colour: string, dash: number[]): void {
    const { context } = this;
    context.beginPath();
    for (const [u, v] of corners) context.lineTo(scale * (u! + 0.5), scale * (v! + 0.5));
    context.closePath();
    context.setLineDash(dash);
    context.lineWidth = Math.max(2, this.canvas.width / 320);
    context.strokeStyle = colour;
    context.stroke();
    context.setLineDash([]);
  }
}

function imageOf(bitmap: ImageBitmap): ImageData {
  const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

/** Thousands of small squares: written into the pixels they take a quarter of the time of as many fillRect. */
function paintPoints(
  context: CanvasRenderingContext2D,
  { positions_m, pixels }: CloudFrame,
  { width, height }: HTMLCanvasElement,
  scale: number,
): void {
  context.canvas.width = width; // also clears it
  context.canvas.height = height;
  const picture = context.createImageData(width, height);
  const painted = new Uint32Array(picture.data.buffer);
  const size = Math.max(2, Math.round(width / 320));
  for (let i = 0; i < pixels!.length / 2; ++i) {
    const u = pixels![2 * i]!;
    if (u === NOT_SEEN) continue;
    const range_m = Math.hypot(positions_m[3 * i]!, positions_m[3 * i + 1]!, positions_m[3 * i + 2]!);
    const pixel = rangePixel(range_m);
    const left = Math.round(scale * (u + 0.5) - size / 2);
    const top = Math.round(scale * (pixels![2 * i + 1]! + 0.5) - size / 2);
    for (let y = Math.max(top, 0); y < Math.min(top + size, height); ++y) {
      painted.fill(pixel, y * width + Math.max(left, 0), y * width + Math.min(left + size, width));
    }
  }
  context.putImageData(picture, 0, 0);
}
