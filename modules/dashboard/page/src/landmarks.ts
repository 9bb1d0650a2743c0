// What a view of points alone lacks: the ground, how far things are, and where the camera looks.

import * as THREE from "three";
import { themeColour } from "./colours.ts";
import type { Point3, Quaternion } from "./protocol.ts";

const GRID_M = 20;
const MARKS_M = [1, 2, 5, 10];
/** Of the lines of sight that are drawn. */
const SIGHT_M = 1;

/** Squares of one metre on the ground, and how far it is along the lidar's x axis. */
export function ground(): THREE.Group {
  const group = new THREE.Group();
  const material = new THREE.LineBasicMaterial({ color: themeColour("soft"), transparent: true, opacity: 0.4 });
  group.add(new THREE.LineSegments(grid(), material));
  group.add(...MARKS_M.map((mark) => label(`${mark} m`, new THREE.Vector3(mark, 0, 0))));
  return group;
}

/** Every side of every square is a line of its own: long ones that pass beside the eye are not always drawn. */
function grid(): THREE.BufferGeometry {
  const points: THREE.Vector3[] = [];
  const half = GRID_M / 2;
  for (let x = -half; x <= half; ++x) {
    for (let y = -half; y <= half; ++y) {
      if (x < half) points.push(new THREE.Vector3(x, y, 0), new THREE.Vector3(x + 1, y, 0));
      if (y < half) points.push(new THREE.Vector3(x, y, 0), new THREE.Vector3(x, y + 1, 0));
    }
  }
  return new THREE.BufferGeometry().setFromPoints(points);
}

/** Where the ground is, by the lowest points but for the strays below it. */
export function groundHeight(positions_m: Float32Array): number | null {
  const heights: number[] = [];
  for (let i = 0; i < positions_m.length; i += 3) {
    if (Math.hypot(positions_m[i]!, positions_m[i + 1]!) < GRID_M / 2) heights.push(positions_m[i + 2]!);
  }
  heights.sort((a, b) => a - b);
  return heights[Math.floor(0.03 * heights.length)] ?? null;
}

/**
 * The camera in the lidar's frame: lines of sight through the border of its image, whose directions are in its own frame.
 * T_camera_lidar is its translation and its rotation.
 */
export function frustum(border: Point3[], t_m: Point3, q_xyzw: Quaternion): THREE.LineSegments {
  const toLidar = new THREE.Quaternion(...q_xyzw).invert();
  const centre = new THREE.Vector3(...t_m).applyQuaternion(toLidar).negate();
  const ends = border.map((ray) =>
    new THREE.Vector3(...ray).multiplyScalar(SIGHT_M).applyQuaternion(toLidar).add(centre),
  );
  const lines = ends.flatMap((end, i) => [end, ends[(i + 1) % ends.length]!]);
  // The first of each side is a corner.
  for (let side = 0; side < 4; ++side) lines.push(centre, ends[(side * ends.length) / 4]!);
  const geometry = new THREE.BufferGeometry().setFromPoints(lines);
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: themeColour("text") }));
}

/** Words of one size, however far they are. */
export function label(text: string, at: THREE.Vector3): THREE.Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = 128;
  canvas.height = 48;
  const context = canvas.getContext("2d")!;
  context.font = "34px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = themeColour("text");
  context.fillText(text, 64, 24);
  const material = new THREE.SpriteMaterial({
    map: new THREE.CanvasTexture(canvas),
    sizeAttenuation: false,
    depthTest: false,
    transparent: true,
  });
  const sprite = new THREE.Sprite(material);
  sprite.scale.set(0.12, 0.045, 1);
  sprite.position.copy(at);
  return sprite;
}
