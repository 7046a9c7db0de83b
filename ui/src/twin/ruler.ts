/** To what a ruler snaps: two points on moving parts are told apart by what is meant, not by where the mouse was. */

import { Vector3, type Matrix4 } from "three";
import type { Hit } from "./twin";
import type { Scene, Vec } from "./scene";

export type Snap = "optical" | "surface" | "hole";

/** The point that is meant: the optical centre of the part, the hole beside it, or the surface itself [mm]. */
export function snapped(hit: Hit, snap: Snap, scene: Scene, matrix: (part: number) => Matrix4 | undefined): Vec {
  if (snap === "hole") {
    const { pitch, first: [x, y] } = scene.table.holes;
    return [x + pitch * Math.round((hit.point[0] - x) / pitch), y + pitch * Math.round((hit.point[1] - y) / pitch), 0];
  }
  const part = scene.components.find((one) => one.index === hit.part);
  const to = part && matrix(part.index);
  if (snap === "optical" && part?.optical && to) return new Vector3(...part.optical).applyMatrix4(to).toArray();
  return hit.point;
}

/** What a ruler says: the differences and the distance [mm]. */
export function difference(from: Vec, to: Vec): { x: number; y: number; z: number; whole: number } {
  const [x, y, z] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  return { x, y, z, whole: Math.hypot(x, y, z) };
}
