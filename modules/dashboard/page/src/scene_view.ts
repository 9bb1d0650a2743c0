// The sweep in three dimensions, with the board found in it, every sample and the next pose.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { cloudColours, type ColourSource } from "./cloud_colours.ts";
import { themeColour } from "./colours.ts";
import { frustum, ground, groundHeight } from "./landmarks.ts";
import type { CloudFrame, Guidance, LidarBoard, Point3, Result, Rig, Samples } from "./protocol.ts";

// Nothing here is lit: a colour is shown as it is given, as in the image beside.
THREE.ColorManagement.enabled = false;

/** Where the colours of a sweep come from. */
export type SourceOf = (cloud: CloudFrame) => ColourSource;

const UP = new THREE.Vector3(0, 0, 1);
/** What moves by itself is drawn no more often: phones have batteries. */
const MIN_PERIOD_MS = 150;

export class SceneView {
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(55, 1, 0.05, 500);
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly points = new THREE.Points(
    new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ size: 2.2, sizeAttenuation: false, vertexColors: true }),
  );
  private readonly board = new THREE.Group();
  private readonly samples = new THREE.Group();
  private readonly ghost = new THREE.Group();
  private readonly sight = new THREE.Group();
  private readonly ground = ground();
  private border: Point3[] = [];
  private cloud: CloudFrame | null = null;
  private sourceOf: SourceOf = () => "range";
  private isAsked = false;
  private isInSight = false;
  private drawnAt = 0;

  constructor(private readonly holder: HTMLElement) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    holder.append(this.renderer.domElement);
    this.renderer.domElement.tabIndex = 0;
    this.renderer.domElement.setAttribute("role", "img");
    this.renderer.domElement.setAttribute(
      "aria-label",
      "The lidar's sweep with the board, the samples and the next pose. Drag to turn, pinch to zoom, arrow keys to move.",
    );
    this.points.frustumCulled = false;
    this.scene.add(this.points, this.board, this.samples, this.ghost, this.sight, this.ground, new THREE.AxesHelper(0.5));
    this.ground.visible = false;
    this.camera.up.copy(UP);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.listenToKeyEvents(this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw(0));
    this.lookAlong();
    new ResizeObserver(() => this.resize()).observe(holder);
    new IntersectionObserver((entries) => {
      this.isInSight = entries.at(-1)!.isIntersecting;
      this.draw(0);
    }).observe(holder);
  }

  /** From behind and above the lidar, along its x axis, where cameras usually look. */
  lookAlong(): void {
    this.camera.position.set(-3.5, 1.2, 2.4);
    this.controls.target.set(2.5, 0, 0);
    this.controls.update();
    this.draw(0);
  }

  showRig({ camera }: Rig): void {
    this.border = camera.border;
  }

  /** Where the camera is, once that is known. */
  showResult({ translation_m, quaternion_xyzw }: Result): void {
    const isKnown = translation_m && quaternion_xyzw && this.border.length > 0;
    this.replace(this.sight, isKnown ? [frustum(this.border, translation_m, quaternion_xyzw)] : []);
  }

  /** From now on, and the sweep that is shown. */
  colourBy(sourceOf: SourceOf): void {
    this.sourceOf = sourceOf;
    if (!this.cloud) return;
    this.paint(this.cloud);
    this.draw();
  }

  showCloud(cloud: CloudFrame): void {
    this.cloud = cloud;
    this.showGround(cloud.positions_m);
    this.points.geometry.dispose();
    this.points.geometry = new THREE.BufferGeometry();
    this.points.geometry.setAttribute("position", new THREE.BufferAttribute(cloud.positions_m, 3));
    this.paint(cloud);
    this.holder.dataset.utime = `${cloud.utime}`;
    this.draw();
  }

  private paint(cloud: CloudFrame): void {
    const { r, g, b } = new THREE.Color(themeColour("unseen"));
    const colours = cloudColours(cloud, this.sourceOf(cloud), [r, g, b]);
    this.points.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  }

  /** Nothing of what was shown is left. */
  clear(): void {
    this.cloud = null;
    this.points.geometry.dispose();
    this.points.geometry = new THREE.BufferGeometry();
    for (const group of [this.board, this.samples, this.ghost, this.sight]) this.replace(group, []);
    this.ground.visible = false;
    delete this.holder.dataset.utime;
  }

  /** Of the first sweep: it does not move. */
  private showGround(positions_m: Float32Array): void {
    const height_m = this.ground.visible ? null : groundHeight(positions_m);
    if (height_m === null) return;
    this.ground.position.z = height_m;
    this.ground.visible = true;
  }

  showBoard(board: LidarBoard): void {
    this.replace(this.board, board.corners_lidar_m ? [plate(board.corners_lidar_m, "#31d158", 0.45)] : []);
  }

  showSamples({ samples }: Samples): void {
    const line = themeColour("accent");
    const bad = themeColour("bad");
    this.replace(
      this.samples,
      samples.map((sample) => outline(sample.corners_lidar_m, sample.left_out ? bad : line)),
    );
  }

  /** Null: no order is given. */
  showGuidance(guidance: Guidance | null): void {
    const corners = guidance?.is_enough ? undefined : guidance?.corners_lidar_m;
    this.replace(this.ghost, corners ? [plate(corners, "#ffd60a", 0.35), outline(corners, "#ffd60a")] : []);
  }

  private replace(group: THREE.Group, children: THREE.Object3D[]): void {
    for (const child of group.children) {
      const { geometry, material } = child as THREE.Mesh;
      geometry.dispose();
      (material as THREE.Material).dispose();
    }
    group.clear();
    if (children.length > 0) group.add(...children);
    this.draw();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.holder;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private draw(minPeriodMs = MIN_PERIOD_MS): void {
    if (this.isAsked || !this.isInSight) return;
    this.isAsked = true;
    const wait = Math.max(0, this.drawnAt + minPeriodMs - performance.now());
    setTimeout(() => requestAnimationFrame(() => this.drawNow()), wait);
  }

  private drawNow(): void {
    this.isAsked = false;
    this.drawnAt = performance.now();
    this.renderer.render(this.scene, this.camera);
  }
}

function geometryOf(corners: Point3[]): THREE.BufferGeometry {
  return new THREE.BufferGeometry().setFromPoints(corners.map((corner) => new THREE.Vector3(...corner)));
}

function outline(corners: Point3[], colour: string): THREE.LineLoop {
  return new THREE.LineLoop(geometryOf(corners), new THREE.LineBasicMaterial({ color: colour }));
}

function plate(corners: Point3[], colour: string, opacity: number): THREE.Mesh {
  const geometry = geometryOf(corners);
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const material = new THREE.MeshBasicMaterial({
    color: colour,
    opacity,
    transparent: true,
    side: THREE.DoubleSide,
    depthWrite: false,
  });
  return new THREE.Mesh(geometry, material);
}
