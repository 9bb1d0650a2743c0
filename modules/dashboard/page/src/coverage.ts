// Where in the image and at which ranges there are samples, and how good each is.

import uPlot from "uplot";
import { themeColour } from "./colours.ts";
import { byId, setText } from "./dom.ts";
import type { Rig, Sample } from "./protocol.ts";

const RANGE_EDGES_M = [0, 2, 3, 4, 6, 10, Infinity];
const RANGE_NAMES = ["to 2", "2–3", "3–4", "4–6", "6–10", "10+"];
const CELL_NAMES = [
  "top left", "top", "top right", "left", "middle", "right", "bottom left", "bottom", "bottom right",
];

export class Coverage {
  private rig: Rig | null = null;
  private samples: Sample[] = [];
  private readonly ranges = new Chart("range-chart", "range, m", ["samples"], true);
  private readonly errors = new Chart("error-chart", "sample", ["e_dim, mm", "held-out error, mm"], false);

  showRig(rig: Rig): void {
    this.rig = rig;
    this.draw();
  }

  showSamples(samples: Sample[]): void {
    this.samples = samples;
    this.draw();
  }

  draw(): void {
    const used = this.samples.filter((sample) => sample.left_out === undefined);
    if (this.rig) drawImageCoverage(byId("coverage"), this.rig, this.samples);
    setText("coverage-text", this.rig ? coverageText(used, this.rig) : "");
    this.ranges.show(
      RANGE_NAMES.map((_, i) => i),
      [RANGE_NAMES.map((_, i) => used.filter((sample) => isInRange(sample, i)).length)],
      RANGE_NAMES,
    );
    this.errors.show(
      this.samples.map((sample) => sample.id),
      [this.samples.map((sample) => sample.e_dim_mm), this.samples.map((sample) => sample.held_out_mm ?? null)],
    );
  }
}

function isInRange({ distance_m }: Sample, i: number): boolean {
  return distance_m >= RANGE_EDGES_M[i]! && distance_m < RANGE_EDGES_M[i + 1]!;
}

function centreOf(sample: Sample): [number, number] | null {
  const outline = sample.outline_px;
  if (!outline) return null;
  return [0, 1].map((axis) => outline.reduce((sum, corner) => sum + corner[axis]!, 0) / 4) as [number, number];
}

/** 0 to 8, row by row. */
function cellOf([u, v]: [number, number], { camera }: Rig): number {
  const third = (x: number, size: number) => Math.min(Math.max(Math.floor((3 * (x + 0.5)) / size), 0), 2);
  return 3 * third(v, camera.height_px) + third(u, camera.width_px);
}

function coverageText(samples: Sample[], rig: Rig): string {
  if (samples.length === 0) return "No samples yet.";
  const filled = new Set(samples.map(centreOf).filter((centre) => centre !== null).map((centre) => cellOf(centre, rig)));
  const empty = CELL_NAMES.filter((_, i) => !filled.has(i));
  const distances = samples.map((sample) => sample.distance_m);
  const span = `${Math.min(...distances).toFixed(1)} to ${Math.max(...distances).toFixed(1)} m`;
  const where = empty.length === 0 ? "All parts of the image have one." : `None yet: ${empty.join(", ")}.`;
  return `${samples.length} ${samples.length === 1 ? "sample" : "samples"} at ${span}. ${where}`;
}

function drawImageCoverage(canvas: HTMLCanvasElement, rig: Rig, samples: Sample[]): void {
  const { width_px, height_px } = rig.camera;
  canvas.width = 480;
  canvas.height = Math.round((480 * height_px) / width_px);
  const context = canvas.getContext("2d")!;
  const scale = canvas.width / width_px;
  context.strokeStyle = themeColour("line");
  for (const share of [1 / 3, 2 / 3]) {
    context.strokeRect(share * canvas.width, -1, 0, canvas.height + 2);
    context.strokeRect(-1, share * canvas.height, canvas.width + 2, 0);
  }
  for (const sample of samples) {
    if (!sample.outline_px) continue;
    context.beginPath();
    for (const [u, v] of sample.outline_px) context.lineTo(scale * u, scale * v);
    context.closePath();
    const colour = themeColour(sample.left_out ? "bad" : "accent");
    context.strokeStyle = colour;
    context.fillStyle = colour;
    context.globalAlpha = 0.16;
    context.fill();
    context.globalAlpha = 1;
    context.stroke();
  }
}

/** A uPlot in the colours of the theme, as wide as its holder. */
class Chart {
  private plot: uPlot | null = null;
  private shown = "";

  constructor(
    private readonly id: string,
    private readonly xName: string,
    private readonly names: string[],
    private readonly isBars: boolean,
  ) {
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(byId(id));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.plot?.redraw());
  }

  show(xs: number[], rows: (number | null)[][], ticks?: string[]): void {
    const data = [xs, ...rows] as uPlot.AlignedData;
    const text = JSON.stringify(data);
    if (text === this.shown) return;
    this.shown = text;
    if (!this.plot) this.plot = new uPlot(this.options(ticks), data, byId(this.id));
    else this.plot.setData(data);
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(byId(this.id).clientWidth, 200), height: 170 };
  }

  private options(ticks?: string[]): uPlot.Options {
    const axis = { stroke: () => themeColour("soft"), grid: { stroke: () => themeColour("line"), width: 1 } };
    const colours = ["accent", "good"];
    const bars = this.isBars ? uPlot.paths.bars!({ size: [0.7, 60] }) : undefined;
    return {
      ...this.size(),
      cursor: { show: false },
      legend: { show: !this.isBars, live: false },
      scales: {
        x: { time: false, ...(this.isBars ? { range: [-0.6, ticks!.length - 0.4] as [number, number] } : {}) },
        y: { range: (_, __, max) => [0, Math.max(max ?? 0, 1) * 1.1] },
      },
      axes: [
        {
          ...axis,
          label: this.xName,
          labelSize: 22,
          ...(ticks ? { splits: ticks.map((_, i) => i), values: () => ticks } : {}),
        },
        { ...axis, size: 44 },
      ],
      series: [
        { label: this.xName },
        ...this.names.map((label, i) => ({
          label,
          stroke: () => themeColour(colours[i]!),
          ...(bars ? { paths: bars, fill: () => themeColour(colours[i]!), points: { show: false } } : {}),
          ...(bars ? {} : { points: { show: true, size: 7 }, spanGaps: true }),
        })),
      ],
    };
  }
}
