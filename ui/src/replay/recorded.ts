/** What is known of a run: `pico.recorded/v1`, `pico.plotted/v1`, `pico.run-comparison/v1`, and what it kept beside it:
 * `pico.still/v1`, `pico.curve/v1`, `pico.search/v1`. */

import type { Change, RunDocument } from "../api/documents";
import type { Diagnostic } from "../api/client";
import type { Series } from "../parts/plotting";
import { withSigma, type Still } from "../stores/seen";

interface Kept { operation: string; attempt: number; run?: string; sha256: string }
export type RunStill = Still & Kept;
export interface Curve extends Kept { schema: "pico.curve/v1"; component: string; measurable: string; x: { name: string; unit: string }; y: { name: string; unit: string }; points: { x: number; y: number }[] }
export interface Search extends Kept {
  schema: "pico.search/v1"; goal: string; algorithm: string; met: boolean; why: string; aim: "reach" | "minimize" | "maximize"; merit: string; enough: number | null;
  outputs: { name: string; unit: string; target: number | null; tolerance: number | null }[];
  tunables: { name: string; unit: string; range: [number, number] }[];
  rows: { values: Record<string, number>; merit: number | null; sigma: number | null; best: number | null }[];
}
/** A number that was measured, with its own unit. */
export interface Numbered { name: string; value: number; sigma: number | null; unit: string }
interface ArrayRef { sha256: string; shape: number[] }

export interface Measurement {
  component: string;
  measurable: string;
  value?: unknown;
  unit?: string;
  unknown?: string | null;
  sigma?: number | null;
  assured?: string[];
  array?: ArrayRef | null;
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
  /** What was measured, each number with its own unit. */
  numbers?: Numbered[];
  data: { measurement?: Measurement; points?: ArrayRef; stages?: { points?: ArrayRef }[]; error_mm?: number; error_deg?: number; met?: boolean; why?: string } & Record<string, unknown>;
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
  measured: { address: string; a: Measurement; b: Measurement; numbers: { a: Numbered[]; b: Numbered[] }; incomparable?: string[] }[];
}

/** What an operation is about: `p2`, `p1.angle`. */
export function address(one: OperationRun): string {
  const { goal, tunable, measurable } = one.arguments as Record<string, string | undefined>;
  return goal ?? (tunable || measurable ? `${one.component}.${tunable ?? measurable}` : one.component);
}

/** How it ended, in a few words: what was measured, how far off a part stands, why it failed. */
export function ended(one: OperationRun): string {
  const { outcome, error, data } = one;
  if (error?.summary) return error.summary;
  if (data.measurement) return measured(data.measurement, one.numbers);
  if (data.met !== undefined) return data.met ? "met" : `not met${data.why ? `: ${data.why}` : ""}`;
  if (data.error_mm) return `${data.error_mm.toPrecision(2)} mm, ${(data.error_deg ?? 0).toPrecision(2)}° off`;
  return outcome === "done" ? "" : outcome;
}

/** What was measured, in a line: `x -624.23 ± 0.03 um, y 1.8 ± 0.03 um`. */
export function measured(measurement: Measurement, numbers: Numbered[] = []): string {
  if (numbers.length) return numbers.map(({ name, value, sigma, unit }) => `${name} ${withSigma(value, sigma)} ${unit === "1" ? "" : unit}`.trim()).join(", ");
  return measurement.unknown ? `unknown: ${measurement.unknown}` : measurement.array ? "an image" : String(measurement.value ?? "");
}

/** The arrays that operations kept of which there are pictures, in their order. */
export function kept(operations: OperationRun[]): ArrayRef[] {
  return operations.flatMap(({ data }) => [data.measurement?.array, ...(data.stages ?? []).map((one) => one.points), data.points].filter((one) => one != null));
}

/** What a search read or set, measurement by measurement; null where nothing was. */
export function column({ rows }: Search, name: string): (number | null)[] {
  return rows.map((one) => one.values[name] ?? null);
}

/** The ways of tunables, those of one unit together, four at most. */
export function paths(search: Search): { name: string; unit: string; series: Series[] }[] {
  const units = [...new Set(search.tunables.map((one) => one.unit))];
  return units.flatMap((unit) => {
    const of = search.tunables.filter((one) => one.unit === unit);
    return Array.from({ length: Math.ceil(of.length / 4) }, (_, i) => {
      const some = of.slice(4 * i, 4 * i + 4);
      return { name: some.length === 1 ? some[0]!.name : "tunables", unit, series: some.map(({ name }) => ({ name, values: column(search, name) })) };
    });
  });
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
