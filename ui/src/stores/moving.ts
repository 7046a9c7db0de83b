/** Poses that are moved by steps: pure. */

import type { Pose } from "../api/documents";
import type { Table } from "../twin/scene";

/** Round to what a hand means: a tenth of a millimetre, a tenth of a degree; to a hole where there are holes. */
export function stepped(pose: Pose, holes: Table["holes"] | null): Pose {
  const [firstX = 0, firstY = 0] = holes?.first ?? [];
  const along = (value: number, first: number) => (holes ? first + holes.pitch * Math.round((value - first) / holes.pitch) : Math.round(value * 10) / 10);
  const yaw = Math.round((((((pose.yaw + 180) % 360) + 360) % 360) - 180) * 10) / 10;
  return { x: along(pose.x, firstX), y: along(pose.y, firstY), yaw: yaw === -180 ? 180 : yaw };
}

/** The command that writes a pose into the manifest. */
export function moved(name: string, pose: Pose): string[] {
  return ["move", name, `x=${pose.x}`, `y=${pose.y}`, `yaw=${pose.yaw}`, "--manifest"];
}

/** A pose as one looks whether another is the same. */
export function fields({ x, y, yaw }: Pose): string {
  return [x, y, yaw].map((one) => one.toFixed(3)).join();
}

/** A pose as it stands beside a ghost. */
export function tagged({ x, y, yaw }: Pose): string {
  return `x ${x.toFixed(1)}  y ${y.toFixed(1)} mm  ${yaw.toFixed(1)}°`;
}
