/** Goals of the lab, and one that is sought. */

import type { BenchEvent, Said } from "../api/documents";

export interface Goal { tunables: Record<string, [number, number] | null>; tolerance?: unknown; description?: string; aim?: string; reach?: Record<string, number>; budget?: { measurements: number; seconds: number } }
export interface Standing { goal: string; status: string; why: string; at: string; seconds: number }
export interface Goals { schema: "pico.goals/v1"; goals: Record<string, Goal>; alignments: Standing[]; ready: Record<string, string> }
export interface Ahead { schema: "pico.goal/v1"; name: string; goal: Goal; algorithm: string; why: string; seconds: number }
export interface Optimized {
  schema: "pico.optimization/v1"; goal: string; algorithm: string; met: boolean; why: string; measurements: number; seconds: number;
  first: Record<string, number> | null; last: Record<string, number> | null; run: string;
}
export interface Tried { measured: number; value: number | null; best: number | null; objective: string; point: Record<string, number>; values: Record<string, number>; unknown: string }

/** What was tried by now, one row a measurement. */
export function tried(events: BenchEvent[]): Tried[] {
  return events.filter((one) => one.kind === "operation_progress" && "measured" in one.data).map(({ data }) => {
    const objective = data.objective as { name: string; value: number; best: number } | undefined;
    return {
      measured: Number(data.measured), value: objective?.value ?? null, best: objective?.best ?? null, objective: objective?.name ?? "",
      point: (data.point ?? {}) as Record<string, number>, values: (data.values ?? {}) as Record<string, number>, unknown: String(data.unknown ?? ""),
    };
  });
}

/** Numbers with the uncertainty that stands beside them as `NAME_sigma`. */
export function sure(values: Record<string, number>): { name: string; value: number; sigma: number | null }[] {
  return Object.entries(values).filter(([name]) => !name.endsWith("_sigma")).map(([name, value]) => ({ name, value, sigma: values[`${name}_sigma`] ?? null }));
}

export function document<T extends { schema: string }>(going: { said: Said[] } | null, schema: T["schema"]): T | null {
  return (going?.said.find((one: Said) => "schema" in one && one.schema === schema) as unknown as T | undefined) ?? null;
}
