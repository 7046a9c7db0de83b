/** What the panels want the twin to show: ghosts, what is outlined. */

import type { Diagnostic } from "../api/client";
import type { Frame } from "../live/frame";
import type { Change, PartState, Plan, Pose } from "../api/documents";
import type { Ghost } from "../twin/marks";
import type { Scene } from "../twin/scene";

class Shown {
  /** Arms and parts as they would be at a moment of a plan. */
  phantom = $state.raw<Frame | null>(null);
  ghosts = $state.raw<Ghost[]>([]);
  outlined = $state.raw<string[]>([]);
}

export const shown = new Shown();

/** Where something stands by what a state or a change says of it: a pose, or a slot of the table. */
export function stands(said: unknown, scene: Scene): Pose | null {
  if (typeof said === "string") return slot(said, scene);
  const place = (said ?? {}) as Partial<Pose> & PartState;
  if (place.x !== undefined) return place as Pose;
  return place.pose ?? (place.slot ? slot(place.slot, scene) : null);
}

function slot(name: string, scene: Scene): Pose | null {
  const found = scene.table.slots.find((one) => one.name === name);
  return found ? { x: found.x, y: found.y, yaw: found.yaw } : null;
}

/** The moves of a plan as numbered ghosts: of the rows `numbers` alone where they are given. */
export function ghostsOf(plan: Plan, scene: Scene, only: string | null = null): Ghost[] {
  return plan.operations.flatMap((one, i) => {
    if (only !== null && one.id !== only) return [];
    const part = scene.components.find((each) => each.name === one.component);
    const to = one.primitive === "move" ? stands(one.arguments.to, scene) : null;
    if (!part || !to) return [];
    const made: Ghost = { part: part.index, ...to, label: String(i + 1), tone: one.reason.kind === "changed" ? "to" : "staged" };
    return [made];
  });
}

/** Before and after of a comparison. */
export function ghostsBetween(changes: Change[], scene: Scene): Ghost[] {
  return changes.filter((one) => one.tunable === "pose").flatMap((one) => {
    const part = scene.components.find((each) => each.name === one.component);
    if (!part) return [];
    const sides: [unknown, Ghost["tone"], string][] = [[one.before, "from", "A"], [one.after, "to", "B"]];
    return sides.flatMap(([value, tone, label]) => {
      const pose = stands(value, scene);
      return pose ? [{ part: part.index, ...pose, label, tone }] : [];
    });
  });
}

/** The components that something wrong is about: by its address, or named in what it says. */
export function named(found: Diagnostic[], scene: Scene): string[] {
  const words = new Set(found.flatMap((one) => `${one.address ?? ""} ${one.summary} ${one.detail ?? ""}`.split(/[^a-z0-9_]+/)));
  return scene.components.map((one) => one.name).filter((name) => words.has(name));
}
