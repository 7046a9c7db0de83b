/** What `pico --json` says, as far as the page shows it. */

import type { Diagnostic } from "./client";

export interface Pose { x: number; y: number; yaw: number }
export type Value = number | string | boolean | Pose | null | undefined;

export interface Change {
  component: string;
  tunable: string;
  before?: Value;
  after?: Value;
  text: string;
  tolerated: boolean;
  requested?: boolean;
}

export interface Place { pose?: Pose; slot?: string }

export interface Operation {
  id: string;
  primitive: string;
  component: string;
  arguments: { from?: Place | Value; to?: Place | Value; tunable?: string; measurable?: string };
  robot?: string;
  after: string[];
  reason: { kind: string; of: string[]; text: string };
  start: number;
  seconds: number;
}

export interface Rule { rule: string; level?: string; holds: boolean | null; text: string }

export type PartState = Record<string, Value> & { pose?: Pose; slot?: string };

export interface Plan {
  schema: "pico.plan/v1";
  digest: string;
  fidelity: string;
  backend: string;
  base: { commit?: string; observed_at: string; state: Record<string, PartState> };
  target: { revision?: string; commit?: string; state: Record<string, PartState> };
  changes: Change[];
  operations: Operation[];
  staging: { count: number; lower_bound: number; proven: boolean };
  makespan: number;
  policy: Rule[];
  diagnostics: Diagnostic[];
}

export interface StatusRow {
  component: string;
  tunable: string;
  committed?: Value;
  desired?: Value;
  live?: Value;
  edited: boolean;
  off: boolean;
  drifted: boolean;
  unit: string;
  near: string;
  aside: string;
  requested: boolean;
  note: string;
}

export interface Status { schema: "pico.status/v1"; lab: string; backend: string; head: string; observed_at: string; rows: StatusRow[]; cut_short?: Diagnostic[]; lacking?: Diagnostic[] }

export interface RunLine { id: string; outcome: string; evidence: string; seconds: number; tally: Record<string, number> }

export interface Commit {
  id: string;
  parents: string[];
  refs: string[];
  author: string;
  time: string;
  message: string;
  changes: Change[];
  evidence: string;
  verdict: string;
  runs: RunLine[];
  lane?: number;
  links?: [number, number][];
}

export interface Log { schema: "pico.log/v1"; head: string | null; commits: Commit[] }
export interface Diff { schema: "pico.diff/v1"; from: string; to: string; changes: Change[] }
export interface Revision extends Omit<Commit, "lane" | "links"> { schema: "pico.revision/v1"; state: Record<string, PartState> }

/** Which commit changed a tunable last. */
export interface Leaf { component: string; tunable: string; value: Value; unit: string; last: { commit: string; name: string; author: string; time: string; summary: string; how: { kind: string }; text: string } | null }
export interface Blame { schema: "pico.blame/v1"; leaves: Leaf[] }
export interface Notes { schema: "pico.notes/v1"; part: string; notes: { text: string; day: string; author: string }[] }

export interface Laser {
  laser: string;
  laser_class: string;
  power: number;
  emits: boolean;
  /** `low` (class 1 or 2), `waived`, `armed` or `nothing`. */
  lets: string;
  arming: { by: string; role: string; ends: string; begins: string } | null;
  broken: string;
}

export interface BenchEvent {
  schema: "pico.event/v1";
  run: string;
  seq: number;
  kind: string;
  time: number;
  operation?: string;
  component?: string;
  data: Record<string, unknown>;
}

export interface Report {
  schema: "pico.report/v1";
  run: string;
  goal: string;
  outcome: string;
  done: number;
  failed: number;
  unknown: number;
  skipped: number;
  held?: Record<string, string>;
  seconds: number;
  evidence: string;
  diagnostics: Diagnostic[];
}

export interface RunDocument {
  id: string;
  number: number;
  goal: string;
  cause: { kind: string };
  evidence: string;
  operator: string;
  started_at: string;
  ended_at?: string;
  outcome: string;
  seconds: number;
  tally: Record<string, number>;
  changes: Change[];
  parent?: string;
}

export interface Diagnostics { schema: "pico.diagnostics/v1"; diagnostics: Diagnostic[] }
export interface Ended { exit: number }
export type Said = ({ schema: string } & Record<string, unknown>) | Ended;
