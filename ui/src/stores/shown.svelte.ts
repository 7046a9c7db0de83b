/** What the panels want the twin to show: ghosts, what is outlined. */

import type { Change, Operation, PartState, Plan, Pose } from "../api/documents";
import type { Ghost } from "../twin/marks";
import type { Scene } from "../twin/scene";

class Shown {
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

/** How a bench stands `time` seconds into a plan: of what has moved by then, as ghosts. */
export function ghostsAt(plan: Plan, scene: Scene, time: number): Ghost[] {
  return plan.operations.flatMap((one: Operation, i) => {
    if (one.primitive !== "move" || one.start > time) return [];
    const part = scene.components.find((each) => each.name === one.component);
    const from = stands(one.arguments.from, scene), to = stands(one.arguments.to, scene);
    if (!part || !to || !from) return [];
    const share = Math.min(1, (time - one.start) / Math.max(one.seconds, 1e-6));
    const turn = ((to.yaw - from.yaw + 540) % 360) - 180;
    const pose = { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y), yaw: from.yaw + share * turn };
    return [{ part: part.index, ...pose, label: String(i + 1), tone: "to" as const }];
  });
}
