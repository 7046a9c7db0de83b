/** What is typed into a field, before PICO itself looks at it. */

import type { Tunable } from "../twin/scene";

/** What is wrong with a number that is typed; null where nothing is. */
export function wrong(text: string, kind: Tunable | undefined): string | null {
  if (kind && (kind.datatype === "bool" || kind.choices.length)) return null;
  const value = Number(text.replace(",", "."));
  if (!text.trim() || Number.isNaN(value)) return "a number is wanted";
  const [low, high] = kind?.range ?? [-Infinity, Infinity];
  return value < low || value > high ? `${text} is beyond ${limits(kind)}` : null;
}

/** Between which values something can be set: `0.02 to 1000 ms`. */
export function limits(kind: Tunable | undefined): string {
  return kind?.range ? `${kind.range[0]} to ${kind.range[1]} ${kind.unit}`.trim() : "";
}

/** The command that writes it into the manifest. */
export function edited(part: string, tunable: string, fields: Record<string, string>): string[] {
  const said = (text: string | undefined) => (text ?? "").trim().replace(",", ".");
  if (tunable !== "pose") return ["set", part, `${tunable}=${said(fields.value)}`, "--manifest"];
  return ["move", part, ...["x", "y", "yaw"].map((axis) => `${axis}=${said(fields[axis])}`), "--manifest"];
}
