/** What needs somebody's attention, and where it is mended. Pure: of what the page knows already. */

import type { Diagnostic } from "../api/client";
import type { RunDocument, Status, StatusRow } from "../api/documents";
import type { Scene } from "../twin/scene";
import type { Query, Tab } from "./address.svelte";
import { entitled } from "./say";

export interface Need {
  tone: "bad" | "warn";
  text: string;
  /** What else is known of it. */
  detail?: string;
  /** What mends it. */
  mend: string;
  to: { tab: Tab; query: Partial<Record<Query, string>> } | null;
}

export interface Known {
  status: Status | null;
  scene: Scene | null;
  runs: RunDocument[];
  line: "opening" | "open" | "lost";
  edge: "here" | "away";
  /** Whether somebody has the bench, as every run does. */
  busy: boolean;
  /** What a recipe asks. */
  asks: string | null;
}

/** A value that is found by light, not told: `{"null_of": [...]}`. */
const byLight = (row: StatusRow) => typeof row.desired === "object" && row.desired !== null && !("x" in row.desired);
const count = (number: number, one: string, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;
const address = (row: StatusRow) => (row.tunable === "pose" ? row.component : `${row.component}.${row.tunable}`);

function listed(rows: StatusRow[]): string {
  const names = [...new Set(rows.map(address))];
  return names.length > 3 ? `${names.slice(0, 3).join(", ")} and ${names.length - 3} more` : names.join(", ");
}

/** What the guard of light has to say: the stream tells that at once, a status as it was asked for last. */
function guarded(status: Status | null, scene: Scene | null): Diagnostic[] {
  return scene?.guard ?? (status?.cut_short ?? []).filter((one) => one.code === "guard");
}

/** What a status tells first besides: killed runs, faults of arms, the lock of a person at the table. */
function interrupted(status: Status | null): Diagnostic[] {
  return (status?.cut_short ?? []).filter((one) => one.severity !== "note" && !["guard", "goes-on"].includes(one.code));
}

/** What needs attention, the worst first. */
export function needs({ status, scene, runs, line, edge, busy, asks }: Known): Need[] {
  const rows = status?.rows ?? [], found: Need[] = [];
  if (line === "lost") found.push({ tone: "bad", text: "The line to the coordinator is lost", mend: "it is tried again by itself", to: null });
  else if (edge === "away") found.push({ tone: "bad", text: "The bench's edge is not connected", mend: "start `pico edge` beside the table", to: null });
  if (asks) found.push({ tone: "warn", text: `A recipe waits for an answer: ${asks}`, mend: "answer it", to: { tab: "do", query: { act: "recipes" } } });
  const guard = guarded(status, scene), cut = interrupted(status);
  for (const one of guard) found.push({ tone: "bad", text: one.summary, detail: one.detail, mend: one.hint || "make the table safe", to: null });
  for (const one of cut) found.push(one.code === "cut-short"
    ? { tone: "bad", text: one.summary, detail: one.hint, mend: "look at the run", to: { tab: "runs", query: runs[0] ? { run: runs[0].id } : {} } }
    : { tone: "bad", text: one.summary, detail: one.detail, mend: one.hint || "see `pico status`", to: null });
  for (const one of status?.lacking ?? []) found.push({ tone: "warn", text: one.summary, detail: one.detail, mend: one.hint || "see `pico devices check`", to: null });
  for (const one of scene?.components ?? []) {
    const to = { tab: "inspect" as const, query: { part: one.name } };
    if (one.state === "lost") found.push({ tone: "bad", text: `${one.name}: nobody sees it`, mend: "look where it is", to });
    else if (one.type === "" && one.position) found.push({ tone: "bad", text: `${one.name} stands on the table and is not in the inventory`, mend: "look what it is", to });
    else if (one.state === "held" && !busy) found.push({ tone: "bad", text: `${one.held_by ?? "A hand"} holds ${one.name}, and nothing goes on`, mend: "look at the run: Recover sets it down", to: { tab: "runs", query: runs[0] ? { run: runs[0].id } : {} } });
  }
  const last = runs[0];
  if (last && !["", "done"].includes(last.outcome) && !cut.some((one) => one.code === "cut-short"))
    found.push({ tone: "bad", text: `Run ${last.number} (${entitled(last)}) ended: ${last.outcome}`, mend: "look at the run", to: { tab: "runs", query: { run: last.id } } });
  const off = rows.filter((row) => row.off && !row.note);
  const kinds: [StatusRow[], (rows: StatusRow[]) => string][] = [
    [off.filter(byLight), (some) => `${count(some.length, "goal")} found by light ${some.length === 1 ? "is" : "are"} not reached any more`],
    [off.filter((row) => row.drifted && !byLight(row)), (some) => `${count(some.length, "value")} neither as committed nor as wanted`],
    [off.filter((row) => !row.drifted && !byLight(row)), (some) => `${count(some.length, "value")} of the manifest not on the bench yet`],
  ];
  for (const [some, text] of kinds)
    if (some.length) found.push({ tone: "warn", text: `${text(some)}: ${listed(some)}`, mend: "plan what brings it there", to: { tab: "plan", query: { rev: "" } } });
  const edits = rows.filter((row) => row.edited);
  if (edits.length)
    found.push({ tone: "warn", text: `${count(edits.length, "edit")} in no commit: ${listed(edits)}`, mend: "look at it, and commit", to: { tab: "inspect", query: { part: edits[0]!.component } } });
  return found;
}
