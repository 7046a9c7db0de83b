/** The bench in three dimensions: plain data in, hits out. Nothing else in the page touches WebGL. */

import {
  ACESFilmicToneMapping, AmbientLight, BufferGeometry, CanvasTexture, DirectionalLight, Group, HemisphereLight, Line, LineBasicMaterial,
  Mesh, MeshStandardMaterial, PerspectiveCamera, PlaneGeometry, BoxGeometry, Raycaster, RepeatWrapping, Scene as Stage,
  SRGBColorSpace, Vector2, Vector3, WebGLRenderer, type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Frame } from "../live/frame";
import { ArmModel } from "./arm";
import { component, dropped, place } from "./building";
import { areaOutline, badge, circle, ghost, outline, ray, ring, slotOutline, type Ghost } from "./marks";
import { Phantom } from "./phantom";
import { snapped, type Snap } from "./ruler";
import type { Component, Scene, Vec } from "./scene";

export type View = "iso" | "top" | "front" | "side";
export type Layer = "beams" | "ghosts" | "arms" | "slots" | "reach";
type Room = Layer | "phantom" | "table" | "parts" | "marks" | "ruler";
export interface Hit { part: number | null; name: string; point: Vec }
export interface Measured { from: Vec; to: Vec }
export interface Told {
  hover(hit: Hit | null): void;
  pick(hit: Hit | null): void;
  measured(found: Measured | null): void;
}

/** Who drags components over the table; where the pointer is on it [mm]. */
export interface Drag {
  /** Whether a press on a part takes it; with Alt it does anyway. */
  always: boolean;
  begin(part: number, at: [number, number]): boolean;
  over(at: [number, number]): void;
  end(): void;
}

const ACCENT = 0x1f8fff, BAD = 0xe0413a;
/** Milliseconds between two pictures where the machine draws in software. */
const SLOW = 120;
/** How high an arm rises over the table, about [mm]. */
const ARM_HEIGHT = 620;

export class Twin {
  readonly #renderer: WebGLRenderer;
  readonly #stage = new Stage();
  readonly #camera = new PerspectiveCamera(38, 1, 10, 12000);
  readonly #controls: OrbitControls;
  readonly #layers: Record<Room, Group>;
  readonly #parts = new Map<number, Group>();
  readonly #arms = new Map<number, ArmModel>();
  readonly #phantom = new Phantom();
  readonly #watch: ResizeObserver;
  #scene: Scene | null = null;
  #dirty = true;
  #last = 0;
  #going = 0;
  #selected: number | null = null;
  #blocked: number[] = [];
  #follow = false;
  /** The view that is fitted into the picture; null once somebody looks from elsewhere. */
  #view: View | null = null;
  /** How wide the picture was, and how it was zoomed, when somebody looked from there last. */
  #looked = { aspect: 1, zoom: 1 };
  #ruler: { snap: Snap; from: Vec | null } | null = null;
  #down: [number, number] | null = null;
  drag: Drag | null = null;
  #dragging = false;

  constructor(readonly canvas: HTMLCanvasElement, readonly told: Told, readonly slow = false) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: !slow, alpha: true, powerPreference: slow ? "low-power" : "default" });
    this.#renderer.outputColorSpace = SRGBColorSpace;
    this.#renderer.toneMapping = ACESFilmicToneMapping;
    this.#renderer.toneMappingExposure = 1.15;
    this.#renderer.shadowMap.enabled = !slow;
    this.#renderer.setPixelRatio(slow ? 1 : Math.min(devicePixelRatio, 2));
    this.#camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.#controls.addEventListener("change", () => (this.#dirty = true));
    this.#controls.addEventListener("start", () => (this.#view = null));
    this.#controls.addEventListener("end", () => this.#keep(this.#camera.zoom));
    const names = ["table", "slots", "reach", "parts", "arms", "beams", "ghosts", "phantom", "marks", "ruler"] as const;
    this.#layers = Object.fromEntries(names.map((name) => [name, new Group()])) as never;
    this.#stage.add(...Object.values(this.#layers));
    this.#layers.reach.visible = false;
    this.#layers.phantom.add(this.#phantom.root);
    this.#light();
    canvas.addEventListener("pointermove", this.#hovered);
    canvas.addEventListener("pointerdown", this.#pressed, { capture: true });
    canvas.addEventListener("pointerup", this.#picked);
    canvas.addEventListener("pointercancel", this.#picked);
    canvas.addEventListener("pointerleave", () => this.told.hover(null));
    this.#watch = new ResizeObserver(() => this.#resized());
    this.#watch.observe(canvas.parentElement ?? canvas);
    this.#going = requestAnimationFrame(this.#tick);
  }

  close(): void {
    cancelAnimationFrame(this.#going);
    this.#watch.disconnect();
    this.#controls.dispose();
    dropped(this.#stage);
    this.#renderer.dispose();
  }

  // what there is

  show(scene: Scene): void {
    const before = this.#scene;
    this.#scene = scene;
    if (before?.epoch !== scene.epoch) this.#begin(scene, before);
    else if (before.components !== scene.components) this.#stand(scene, before);
    this.#lit(scene);
    this.#marked();
  }

  #begin(scene: Scene, before: Scene | null): void {
    for (const name of ["table", "slots", "reach", "parts", "arms"] as const) this.#empty(name);
    this.#parts.clear();
    this.#arms.clear();
    this.#table(scene);
    for (const part of scene.components) this.#add(part);
    for (const arm of scene.arms) {
      const model = new ArmModel(arm);
      this.#arms.set(arm.index, model);
      this.#layers.arms.add(model.root);
      for (const radius of arm.reach ?? [])
        this.#layers.reach.add(outline(circle(radius).map(([x, y]) => [x + arm.mount.x, y + arm.mount.y]), ACCENT));
    }
    // the same table at another time is looked at from where one looks
    if (JSON.stringify(before?.table.size) !== JSON.stringify(scene.table.size)) this.view("iso");
  }

  /** Components stand otherwise: where they are say the frames, what they look like the scene. */
  #stand(scene: Scene, before: Scene): void {
    for (const part of scene.components) {
      const known = before.components.find((one) => one.index === part.index);
      const group = this.#parts.get(part.index);
      if (group) group.visible = part.position !== null;
      if (known && group && JSON.stringify(known.stages) === JSON.stringify(part.stages)) continue;
      const made = this.#add(part);
      if (!group) continue;
      made.position.copy(group.position);
      made.quaternion.copy(group.quaternion);
      dropped(group);
    }
  }

  #add(part: Component): Group {
    const group = component(part);
    group.userData.part = part.index;
    if (part.position && part.quaternion) place(group, part.position, part.quaternion);
    group.visible = part.position !== null;
    this.#parts.set(part.index, group);
    this.#layers.parts.add(group);
    return group;
  }

  #lit(scene: Scene): void {
    this.#empty("beams");
    const strongest = Math.max(0, ...scene.beams.map((beam) => beam.power));
    for (const beam of scene.beams) this.#layers.beams.add(ray(beam, strongest));
    this.#dirty = true;
  }

  move(frame: Frame): void {
    for (const arm of frame.arms) this.#arms.get(arm.index)?.move(arm.joints, arm.gripper);
    for (const moved of frame.bodies) {
      const group = this.#parts.get(moved.index);
      if (!group) continue;
      place(group, moved.position, moved.quaternion);
      group.visible = true;
    }
    if (frame.arms.length || frame.bodies.length) {
      this.#marked();
      this.#dirty = true;
    }
  }

  // what is shown of it

  ghosts(wanted: Ghost[]): void {
    this.#empty("ghosts");
    for (const one of wanted) {
      const part = this.#part(one.part);
      if (!part) continue;
      const now = this.#parts.get(one.part)!.position;
      this.#layers.ghosts.add(ghost(one, part, one.tone === "from" ? null : [now.x, now.y], (this.#scene?.table.beam_height ?? 70) * 2));
    }
    this.#dirty = true;
  }

  select(part: number | null, blocked: number[] = []): void {
    this.#selected = part;
    this.#blocked = blocked;
    this.#marked();
    this.#dirty = true;
  }

  /** Arms and parts as they would be at a moment, translucent; null: none. */
  phantom(frame: Frame | null): void {
    if (this.#scene) this.#phantom.show(this.#scene, frame);
    this.#dirty = true;
  }

  layer(name: Layer, shown: boolean): void {
    this.#layers[name].visible = shown;
    if (name === "ghosts") this.#layers.phantom.visible = shown;
    this.#dirty = true;
  }

  view(name: View): void {
    const [w, d] = this.#scene?.table.size ?? [1200, 750];
    const corners = [0, w].flatMap((x) => [0, d].flatMap((y) => [-60, 0].map((z) => new Vector3(x, y, z))));
    if (name !== "top") for (const { mount } of this.#scene?.arms ?? []) corners.push(new Vector3(mount.x, mount.y, ARM_HEIGHT));
    const from = { iso: [-0.45, -1, 0.85], top: [0, -0.001, 1], front: [0, -1, 0.12], side: [1, -0.05, 0.25] }[name] as Vec;
    this.#follow = false;
    this.#view = name;
    this.#fit(corners, new Vector3(...from).normalize());
  }

  /** Bring a part into the middle; `follow` keeps it there while it moves. */
  frame(part: number, follow = false): void {
    const group = this.#parts.get(part);
    if (!group) return;
    this.#follow = follow;
    this.#view = null;
    const from = this.#camera.position.clone().sub(this.#controls.target).normalize();
    this.#look(group.position.clone().setZ(60), from, 190);
  }

  ruler(snap: Snap | null): void {
    this.#ruler = snap ? { snap, from: null } : null;
    this.#empty("ruler");
    this.told.measured(null);
    this.#dirty = true;
  }

  /** Where a part is on the screen, from the corner of the window [px]: for tests and for what is pinned to it. */
  at(part: number): [number, number] | null {
    const group = this.#parts.get(part);
    if (!group) return null;
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const point = group.position.clone().setZ(group.position.z + 30).project(this.#camera);
    return [left + ((point.x + 1) / 2) * width, top + ((1 - point.y) / 2) * height];
  }

  // inside

  #part(index: number): Component | undefined {
    return this.#scene?.components.find((one) => one.index === index);
  }

  #empty(name: Room): void {
    for (const one of [...this.#layers[name].children]) dropped(one);
  }

  #light(): void {
    const sun = new DirectionalLight(0xffffff, 2.1);
    sun.position.set(-300, -500, 1400);
    sun.target.position.set(600, 380, 0);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, { left: -900, right: 900, top: 900, bottom: -900, near: 100, far: 3000 });
    this.#stage.add(sun, sun.target, new HemisphereLight(0xffffff, 0x8894a0, 1.5), new AmbientLight(0xffffff, 0.3));
  }

  #table({ table }: Scene): void {
    const [w, d] = table.size;
    const slab = new Mesh(new BoxGeometry(w, d, table.thickness), new MeshStandardMaterial({ color: 0x4a525a, roughness: 0.8 }));
    slab.position.set(w / 2, d / 2, -table.thickness / 2 - 0.5);
    const top = new Mesh(new PlaneGeometry(w, d), new MeshStandardMaterial({ map: holes(table.holes.pitch, table.holes.first, w, d), roughness: 0.7, metalness: 0.25 }));
    top.position.set(w / 2, d / 2, 0);
    top.receiveShadow = true;
    this.#layers.table.add(slab, top);
    for (const slot of table.slots) this.#layers.slots.add(outline(slotOutline(slot), 0xb8c4cf));
    for (const one of table.regions) this.#layers.slots.add(outline(areaOutline(one.area), 0x6fa8dc, 0.06));
    for (const one of table.keep_out) this.#layers.slots.add(outline(areaOutline(one.area), BAD, 0.14));
  }

  #marked(): void {
    this.#empty("marks");
    const marks: [number, number][] = this.#blocked.map((one) => [one, BAD]);
    if (this.#selected !== null) marks.push([this.#selected, ACCENT]);
    for (const [index, colour] of marks) {
      const part = this.#part(index), group = this.#parts.get(index);
      if (!part || !group) continue;
      const around = ring(part, colour);
      around.position.set(group.position.x, group.position.y, 2);
      around.rotation.z = 2 * Math.atan2(group.quaternion.z, group.quaternion.w);
      this.#layers.marks.add(around);
      if (this.#follow && index === this.#selected) this.#controls.target.copy(group.position).setZ(60);
    }
  }

  /** Look so that all of some points are in the picture, seen along a direction. */
  #fit(points: Vector3[], from: Vector3): void {
    this.#keep(1);
    const target = points.reduce((sum, one) => sum.add(one), new Vector3()).divideScalar(points.length);
    const right = new Vector3().crossVectors(this.#camera.up, from).normalize(), up = new Vector3().crossVectors(from, right);
    const high = Math.tan((this.#camera.fov * Math.PI) / 360), wide = high * this.#camera.aspect;
    let far = 0;
    for (let round = 0; round < 4; round++) {
      // each point asks for a distance; the middle is then moved to where both sides have the same room
      let [left, most, low, top] = [Infinity, -Infinity, Infinity, -Infinity];
      far = Math.max(...points.map((one) => {
        const to = one.clone().sub(target);
        return to.dot(from) + Math.max(Math.abs(to.dot(right)) / wide, Math.abs(to.dot(up)) / high);
      }));
      for (const one of points) {
        const to = one.clone().sub(target), depth = far - to.dot(from);
        left = Math.min(left, to.dot(right) / depth); most = Math.max(most, to.dot(right) / depth);
        low = Math.min(low, to.dot(up) / depth); top = Math.max(top, to.dot(up) / depth);
      }
      target.addScaledVector(right, ((left + most) / 2) * far).addScaledVector(up, ((low + top) / 2) * far);
    }
    this.#controls.target.copy(target);
    this.#camera.position.copy(target).addScaledVector(from, far * 1.06);
    this.#controls.update();
    this.#camera.updateMatrixWorld();
    this.#dirty = true;
  }

  #look(target: Vector3, from: Vector3, radius: number): void {
    this.#keep(1);
    const half = (this.#camera.fov * Math.PI) / 360;
    const far = radius / Math.tan(half) / Math.min(1, this.#camera.aspect) * 1.02;
    this.#controls.target.copy(target);
    this.#camera.position.copy(target).addScaledVector(from, far);
    this.#controls.update();
    this.#camera.updateMatrixWorld();
    this.#dirty = true;
  }

  #hit(event: PointerEvent): Hit | null {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#camera);
    const [first] = caster.intersectObjects([this.#layers.parts, this.#layers.arms, this.#layers.table].filter((one) => one.visible));
    if (!first) return null;
    let owner: Object3D | null = first.object;
    while (owner && !owner.name) owner = owner.parent;
    const part = owner?.userData.part as number | undefined;
    return { part: part ?? null, name: owner?.name ?? "", point: first.point.toArray() };
  }

  /** Where a pointer is on the table. */
  #onTable(event: PointerEvent): [number, number] | null {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#camera);
    const { origin, direction } = caster.ray;
    if (direction.z >= -1e-6) return null;
    const far = -origin.z / direction.z;
    return [origin.x + far * direction.x, origin.y + far * direction.y];
  }

  #pressed = (event: PointerEvent): void => {
    this.#down = [event.clientX, event.clientY];
    const drag = this.drag;
    if (!drag || this.#ruler || event.button !== 0 || !(drag.always || event.altKey)) return;
    const hit = this.#hit(event), at = this.#onTable(event);
    if (hit?.part == null || !at || !drag.begin(hit.part, at)) return;
    this.#dragging = true;
    this.#controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
  };

  #hovered = (event: PointerEvent): void => {
    const at = this.#dragging ? this.#onTable(event) : null;
    if (at) this.drag?.over(at);
    if (event.buttons) return;
    const hit = this.#hit(event);
    this.canvas.style.cursor = this.#ruler ? "crosshair" : hit?.part != null ? "pointer" : "";
    this.told.hover(hit);
  };

  #picked = (event: PointerEvent): void => {
    const [x, y] = this.#down ?? [0, 0];
    this.#down = null;
    if (this.#dragging) {
      this.#dragging = false;
      this.#controls.enabled = true;
      this.drag?.end();
      return;
    }
    if (Math.hypot(event.clientX - x, event.clientY - y) > 5) return;
    const hit = this.#hit(event);
    if (!this.#ruler) this.told.pick(hit);
    else if (hit && this.#scene) this.#measure(snapped(hit, this.#ruler.snap, this.#scene, (index) => this.#parts.get(index)?.matrixWorld));
  };

  #measure(point: Vec): void {
    const ruler = this.#ruler!;
    this.#empty("ruler");
    const dots = ruler.from ? [ruler.from, point] : [point];
    for (const [i, dot] of dots.entries()) {
      const mark = badge(String.fromCharCode(65 + i), ACCENT);
      mark.position.set(...dot);
      this.#layers.ruler.add(mark);
    }
    if (ruler.from) {
      const points = dots.map((dot) => new Vector3(...dot));
      const line = new Line(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: ACCENT, depthTest: false }));
      line.renderOrder = 9;
      this.#layers.ruler.add(line);
      this.told.measured({ from: ruler.from, to: point });
      ruler.from = null;
    } else ruler.from = point;
    this.#dirty = true;
  }

  #resized(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement ?? this.canvas;
    if (!width || !height) return;
    this.#renderer.setSize(width, height, false);
    const { aspect, zoom } = this.#looked;
    this.#camera.aspect = width / height;
    this.#camera.zoom = zoom * Math.min(1, this.#camera.aspect / aspect);
    this.#camera.updateProjectionMatrix();
    if (this.#view) this.view(this.#view);
    this.#dirty = true;
  }

  /** Somebody looks from here: whatever is in the picture now stays in it when the picture's size changes. */
  #keep(zoom: number): void {
    this.#looked = { aspect: this.#camera.aspect, zoom };
    this.#camera.zoom = zoom;
    this.#camera.updateProjectionMatrix();
  }

  #tick = (now: number): void => {
    this.#going = requestAnimationFrame(this.#tick);
    if (!this.#dirty || now - this.#last < (this.slow ? SLOW : 0)) return;
    this.#dirty = false;
    this.#last = now;
    this.#renderer.render(this.#stage, this.#camera);
  };
}

/** The top of a breadboard: a hole every `pitch` millimetres. */
function holes(pitch: number, [x, y]: [number, number], width: number, depth: number): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#626b74";
  pen.fillRect(0, 0, 64, 64);
  pen.fillStyle = "#30363c";
  pen.beginPath();
  pen.arc(32, 32, 8, 0, 7);
  pen.fill();
  const made = new CanvasTexture(canvas);
  made.wrapS = made.wrapT = RepeatWrapping;
  made.repeat.set(width / pitch, depth / pitch);
  made.offset.set(0.5 - x / pitch, 0.5 - y / pitch);
  made.colorSpace = SRGBColorSpace;
  made.anisotropy = 8;
  return made;
}
