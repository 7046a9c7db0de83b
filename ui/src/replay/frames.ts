/** What moved in a run, or would move in a plan: `pico.frames/v1`, as `runs show --frames` and `plan --frames` say it. */

import type { Diagnostic } from "../api/client";
import type { ArmPose, BodyPose, Frame } from "../live/frame";
import { changed, read, type Scene } from "../twin/scene";

export interface Done {
  operation: string;
  run?: string;
  attempt: number;
  primitive: string;
  component: string;
  address: string;
  robot?: string;
  /** When it began, and how long it took [s]; `planned`: how long it was to take. */
  start: number;
  seconds: number;
  planned?: number;
  outcome: string;
}

export interface Frames {
  schema: "pico.frames/v1";
  run?: string;
  number?: number;
  plan?: string;
  goal: string;
  origin: "planned" | "reconstructed" | "recorded";
  evidence: string;
  seconds: number;
  scene: Scene;
  steps: Done[];
  moved: { time: number; arms: [number, number[], number][]; bodies: number[][] }[];
  told: { time: number; kind: string; rev: number; data: unknown }[];
  phases: [number, string, string][];
  diagnostics: Diagnostic[];
}

interface Key { time: number; values: number[] }

/** A replay that can be looked at at any time: the keys of each arm (joints, then the width) and of each body. */
export interface Reel {
  frames: Frames;
  arms: Map<number, Key[]>;
  bodies: Map<number, Key[]>;
  /** The scene from each time on. */
  scenes: { time: number; scene: Scene }[];
}

/** Make a replay of a document; `epoch` tells its scene from all others. */
export function reel(frames: Frames, epoch: number): Reel {
  const first: Scene = { ...read(frames.scene), epoch };
  const arms = new Map(first.arms.map((one) => [one.index, [{ time: 0, values: [...one.joints, one.width] }]]));
  const bodies = new Map<number, Key[]>();
  for (const one of first.components) if (one.position && one.quaternion) bodies.set(one.index, [{ time: 0, values: [...one.position, ...one.quaternion] }]);
  for (const said of frames.moved) {
    for (const [index, joints, width] of said.arms) added(arms, index, { time: said.time, values: [...joints, width] });
    for (const [index = -1, ...values] of said.bodies) added(bodies, index, { time: said.time, values });
  }
  const scenes = [{ time: 0, scene: first }];
  for (const said of frames.told) {
    const last = scenes.at(-1)!;
    const scene = changed(last.scene, said);
    if (said.time === last.time) last.scene = scene;
    else scenes.push({ time: said.time, scene });
  }
  return { frames, arms, bodies, scenes };
}

function added(tracks: Map<number, Key[]>, index: number, key: Key): void {
  const track = tracks.get(index);
  if (track) track.push(key);
  else tracks.set(index, [key]);
}

/** The last of sorted things that is not after a time; -1 where all are. */
export function last(times: { time: number }[], time: number): number {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle]!.time <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

function between(track: Key[], time: number): { a: number[]; b: number[]; share: number } {
  const i = Math.max(0, last(track, time)), from = track[i]!, to = track[i + 1];
  if (!to || time <= from.time) return { a: from.values, b: from.values, share: 0 };
  return { a: from.values, b: to.values, share: (time - from.time) / (to.time - from.time) };
}

export function mixed(a: ArrayLike<number>, b: ArrayLike<number>, share: number): number[] {
  return Array.from({ length: a.length }, (_, i) => a[i]! + share * (b[i]! - a[i]!));
}

/** Between two orientations (w x y z) that lie close together: their normalized mean, the short way round. */
export function turned(a: ArrayLike<number>, b: ArrayLike<number>, share: number): [number, number, number, number] {
  const dot = a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]! + a[3]! * b[3]!;
  const [w = 1, x = 0, y = 0, z = 0] = mixed(a, dot < 0 ? Array.from(b, (v) => -v) : b, share);
  const length = Math.hypot(w, x, y, z) || 1;
  return [w / length, x / length, y / length, z / length];
}

/** Where everything is at a time, straight between the keys before and after it. */
export function at(film: Reel, time: number): Frame {
  const arms: ArmPose[] = [], bodies: BodyPose[] = [];
  for (const [index, track] of film.arms) {
    const { a, b, share } = between(track, time);
    const values = mixed(a, b, share);
    arms.push({ index, joints: Float32Array.from(values.slice(0, -1)), gripper: values.at(-1)! });
  }
  for (const [index, track] of film.bodies) {
    const { a, b, share } = between(track, time);
    const [x = 0, y = 0, z = 0] = mixed(a, b, share);
    bodies.push({ index, position: [x, y, z], quaternion: turned(a.slice(3), b.slice(3), share) });
  }
  const { scene } = film.scenes[0]!;
  return { epoch: scene.epoch, rev: 0, time, arms, bodies };
}

/** The scene at a time: how components stand, and how light runs. */
export function sceneAt(film: Reel, time: number): Scene {
  return film.scenes[Math.max(0, last(film.scenes, time))]!.scene;
}

/** What is done at a time, by the order in which it began. */
export function doneAt(frames: Frames, time: number): Done[] {
  return frames.steps.filter((one) => one.start <= time && time < one.start + Math.max(one.seconds, 1e-3));
}

/** What an arm does at a time: `transit`. */
export function phaseAt(frames: Frames, robot: string, time: number): string {
  return frames.phases.filter(([from, name]) => name === robot && from <= time).at(-1)?.[2] ?? "";
}

/** The times to which one goes step by step: where something begins, and the end. */
export function stops(frames: Frames): number[] {
  return [...new Set([0, ...frames.steps.map((one) => one.start), frames.seconds])].sort((a, b) => a - b);
}

/** The next stop after a time, or the one before it. */
export function stepped(frames: Frames, time: number, by: 1 | -1): number {
  const all = stops(frames);
  if (by > 0) return all.find((one) => one > time + 1e-3) ?? frames.seconds;
  return all.filter((one) => one < time - 1e-3).at(-1) ?? 0;
}

/** When one sees best what an operation does: a part in the hand on its way, else its end [s]. */
export function telling(frames: Frames, operation: string): number | null {
  const one = frames.steps.find((step) => step.operation === operation);
  if (!one) return null;
  const end = one.start + one.seconds;
  const own = frames.phases.filter(([from, robot]) => robot === one.robot && from >= one.start - 1e-3 && from < end);
  const i = own.findIndex(([, , phase]) => phase === "transit");
  return i < 0 ? end : ((own[i]![0] + (own[i + 1]?.[0] ?? end)) / 2);
}

/** A frame of a film as one of another scene, by the names of arms and components; what stands there as here is left out. */
export function translated(film: Reel, time: number, to: Scene): Frame {
  const frame = at(film, time), own = film.scenes[0]!.scene;
  const names = new Map(own.components.map((one) => [one.index, one.name]));
  const there = new Map(to.components.map((one) => [one.name, one]));
  const arms = frame.arms.flatMap((one) => {
    const name = own.arms.find((arm) => arm.index === one.index)?.name;
    const index = to.arms.find((arm) => arm.name === name)?.index;
    return index === undefined ? [] : [{ ...one, index }];
  });
  const bodies = frame.bodies.flatMap((one) => {
    const part = there.get(names.get(one.index) ?? "");
    if (!part?.position) return [];
    const first = film.bodies.get(one.index)![0]!.values;
    const away = Math.hypot(...one.position.map((v, i) => v - first[i]!));
    const spun = Math.abs(1 - Math.abs(one.quaternion.reduce((sum, v, i) => sum + v * first[i + 3]!, 0)));
    return away < 0.5 && spun < 1e-5 ? [] : [{ ...one, index: part.index }];
  });
  return { epoch: to.epoch, rev: to.rev, time, arms, bodies };
}
