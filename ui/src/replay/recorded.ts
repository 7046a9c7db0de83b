/** What is known of a run: `pico.recorded/v1`, `pico.plotted/v1`, `pico.run-comparison/v1`. */

import type { Change, RunDocument } from "../api/documents";
import type { Diagnostic } from "../api/client";

export interface Measurement {
  component: string;
  measurable: string;
  value?: unknown;
  unit?: string;
  sigma?: number | null;
  assured?: string[];
  array?: unknown;
}

export interface OperationRun {
  id: string;
  run: string;
  attempt: number;
  primitive: string;
  component: string;
  arguments: Record<string, unknown>;
  start?: number | null;
  seconds?: number | null;
  planned?: number | null;
  outcome: string;
  error?: { summary?: string } | null;
  data: { measurement?: Measurement; error_mm?: number; error_deg?: number; met?: boolean; why?: string } & Record<string, unknown>;
}

export interface Recorded { schema: "pico.recorded/v1"; document: RunDocument; commit?: string; operations: OperationRun[]; artifacts: { artifact: { name: string; size: number }; present: boolean }[]; diagnostics: Diagnostic[] }
export interface Plotted { schema: "pico.plotted/v1"; title: string; x: { name: string; unit: string }; y: { name: string; unit: string }; points: { x: number; y: number; sigma?: number | null }[] }
export interface Comparison {
  schema: "pico.run-comparison/v1";
  a: RunDocument;
  b: RunDocument;
  same: boolean;
  changes?: Change[] | null;
  differing: { name: string; a?: unknown; b?: unknown }[];
  measured: { address: string; a: Measurement; b: Measurement; incomparable?: string[] }[];
}

/** What an operation is about: `p2`, `p1.angle`. */
export function address(one: OperationRun): string {
  const { goal, tunable, measurable } = one.arguments as Record<string, string | undefined>;
  return goal ?? (tunable || measurable ? `${one.component}.${tunable ?? measurable}` : one.component);
}

/** How it ended, in a few words: what was measured, how far off a part stands, why it failed. */
export function ended({ outcome, error, data }: OperationRun): string {
  if (error?.summary) return error.summary;
  if (data.measurement) return measured(data.measurement);
  if (data.met !== undefined) return data.met ? "met" : `not met${data.why ? `: ${data.why}` : ""}`;
  if (data.error_mm) return `${data.error_mm.toPrecision(2)} mm, ${(data.error_deg ?? 0).toPrecision(2)}° off`;
  return outcome === "done" ? "" : outcome;
}

export function measured({ value, unit, sigma, array }: Measurement): string {
  if (typeof value === "number") return `${Number(value.toPrecision(5))}${sigma ? ` ± ${Number(sigma.toPrecision(2))}` : ""} ${unit ?? ""}`.trim();
  if (value && typeof value === "object") return Object.entries(value).map(([name, one]) => `${name} ${typeof one === "number" ? Number(one.toPrecision(5)) : String(one)}`).join(", ");
  return array ? "an image" : String(value ?? "");
}

/** How much longer it took than planned, where that is more than a little: `+1.2 s`. */
export function late(one: OperationRun): string {
  const by = (one.seconds ?? 0) - (one.planned ?? one.seconds ?? 0);
  return Math.abs(by) < 0.05 ? "" : `${by > 0 ? "+" : "−"}${Math.abs(by).toFixed(1)} s`;
}

/** The runs that a filter leaves: by words in goal, cause, operator, id or what they changed, and by evidence. */
export function filtered(runs: RunDocument[], words: string, evidence: string): RunDocument[] {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return runs.filter((one) => {
    const text = [one.id, one.number, one.cause.kind, one.goal, one.operator, one.outcome, ...one.changes.map((each) => `${each.component}.${each.tunable}`)].join(" ").toLowerCase();
    return (!evidence || one.evidence === evidence) && wanted.every((word) => text.includes(word));
  });
}
