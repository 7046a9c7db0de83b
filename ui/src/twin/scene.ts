/** What `GET …/scene` tells of a bench: `pico.scene/v1`. Millimetres, radians, quaternions w x y z. */

import type { Diagnostic } from "../api/client";
import type { Pose, Value } from "../api/documents";

export type Vec = [number, number, number];
export type Quat = [number, number, number, number];
export type Colour = [number, number, number, number?];

/** A part of a link, in its frame: a box by its edges, else a round one from `a` to `b`. */
export type LinkShape =
  | { shape: "box"; at: Vec; size: Vec; color: Colour }
  | { shape: "cylinder" | "capsule"; a: Vec; b: Vec; radius: number; color: Colour };

export interface Link {
  name: string;
  parent: number | null;
  origin: Vec;
  quaternion: Quat;
  drive: number | "width" | null;
  kind?: "turns" | "slides";
  axis?: Vec;
  /** Millimetres for one of what drives it. */
  factor?: number;
  shapes: LinkShape[];
}

export interface Arm {
  index: number;
  name: string;
  mount: { x: number; y: number; z: number; yaw: number };
  reach: [number, number] | null;
  joints: number[];
  width: number;
  holding: string | null;
  known: boolean;
  links: Link[];
}

/** A part of a component, in its frame: a box by its edges, a cylinder by diameter and length along its own z. */
export interface Body { name: string; shape: "box" | "cylinder"; size: number[]; at: Vec; quaternion: Quat; color: Colour; rides?: string }

export interface Tunable {
  datatype: string;
  unit: string;
  range?: [number, number] | null;
  choices: string[];
  resolution: number;
  tolerance: number;
  mover: string;
  restore: { kind: string };
  description?: string;
}

export interface Component {
  index: number;
  name: string;
  /** Empty for something that is not in the inventory. */
  type: string;
  title: string;
  element?: string;
  movable?: boolean;
  height?: number;
  footprint?: { box?: [number, number]; disc?: number; circle?: number };
  optical?: Vec;
  marker?: number | null;
  home?: string | null;
  serial?: string;
  note?: string;
  bodies: Body[];
  tunables: Record<string, Tunable>;
  measurables?: unknown;
  state: "seen" | "known" | "held" | "lost";
  presence?: string;
  how?: string;
  held_by?: string | null;
  values: Record<string, { value: Value; status: string }>;
  position: Vec | null;
  quaternion: Quat | null;
  pose?: Pose | null;
  stages?: Record<string, number>;
}

export interface Beam {
  source: string;
  component: string | null;
  event: string;
  start: Vec;
  end: Vec;
  /** Whether light runs there now, and not only would if the laser were on and open. */
  lit: boolean;
  power: number;
  onward: number;
  clipped: number;
  radii: [number, number];
  wavelength: number;
  color: Colour;
  polarization: { angle: number; ellipticity: number; degree: number } | null;
  ghost: boolean;
}

export interface Area { x: [number, number]; y: [number, number] }

export interface Table {
  size: [number, number];
  thickness: number;
  beam_height: number;
  holes: { pitch: number; first: [number, number] };
  slots: { name: string; x: number; y: number; yaw: number }[];
  regions: { name: string; area: Area; title: string }[];
  keep_out: { name: string; area: Area; reason?: string }[];
}

export interface Scene {
  schema: "pico.scene/v1";
  lab: string;
  epoch: number;
  rev: number;
  time: number;
  table: Table;
  arms: Arm[];
  components: Component[];
  beams: Beam[];
  /** What the guard of light has to say, the most urgent first; absent while it said nothing yet. */
  guard?: Diagnostic[];
}

/** The scene as it was told; throws where it is none that this page reads. */
export function read(said: unknown): Scene {
  const found = said as Scene;
  if (found.schema !== "pico.scene/v1") throw new RangeError(`the bench speaks ${String(found.schema)}, and this page reads pico.scene/v1`);
  return found;
}

/** The scene after something changed: a component, the light, or what its guard has to say. */
export function changed(scene: Scene, event: { kind: string; rev: number; data: unknown }): Scene {
  if (event.kind === "beams") return { ...scene, rev: event.rev, beams: (event.data as { beams: Beam[] }).beams };
  if (event.kind === "guard") return { ...scene, rev: event.rev, guard: (event.data as { notices: Diagnostic[] }).notices };
  if (event.kind !== "component") return scene;
  const news = event.data as Component;
  const known = scene.components.some((one) => one.index === news.index);
  const components = known
    ? scene.components.map((one) => (one.index === news.index ? { ...one, ...news } : one))
    : [...scene.components, news];
  return { ...scene, rev: event.rev, components };
}
