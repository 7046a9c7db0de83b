/** Moving a component by hand in the twin: a draft that the desk checks as it goes, and writes into the manifest. */

import type { Diagnostic } from "../api/client";
import type { Pose, StatusRow } from "../api/documents";
import type { Ghost } from "../twin/marks";
import type { Component, Table } from "../twin/scene";
import { address } from "./address.svelte";
import { bench } from "./bench.svelte";
import { desk } from "./desk.svelte";
import { fields, moved, stepped, tagged } from "./moving";
import { isPose } from "./say";
import { session } from "./session.svelte";

/** How long nothing must have changed before the desk is asked [ms]. */
const SETTLED = 250;

type Checked = "checking" | "fits" | "wrong" | "same";

class Hand {
  on = $state(false);
  /** Whether a drag ends at a hole of the breadboard. */
  snap = $state(true);
  name = $state<string | null>(null);
  pose = $state.raw<Pose | null>(null);
  checked = $state<Checked>("same");
  faults = $state.raw<Diagnostic[]>([]);
  /** The words that write back what was before, the last first. */
  undo = $state.raw<string[][]>([]);
  #from: Pose | null = null;
  #grip: [number, number] = [0, 0];
  #timer = 0;
  #asked = 0;

  get part(): Component | null { return bench.scene?.components.find((one) => one.name === this.name) ?? null; }
  get barred(): string | null { return session.may("operator", bench.lab) ? null : "needs the role operator"; }
  get words(): string[] { return this.name && this.pose ? moved(this.name, this.pose) : []; }
  get changed(): boolean { return this.pose !== null && this.#from !== null && fields(this.pose) !== fields(this.#from); }

  /** The draft as the twin draws it. */
  get ghost(): Ghost | null {
    if (!this.pose || !this.part || !this.changed) return null;
    return { part: this.part.index, ...this.pose, label: tagged(this.pose), tone: this.checked === "wrong" ? "bad" : "to" };
  }

  turn = (): void => {
    this.on = !this.on;
    if (this.on && address.now.query.part) this.take(address.now.query.part);
    else if (!this.on) this.leave();
  };

  /** Take a component in the hand, where it may be moved; returns whether it may. */
  take(name: string): boolean {
    if (this.barred) return false;
    if (this.name === name) return true;
    const part = bench.scene?.components.find((one) => one.name === name);
    const pose = part && this.#wanted(part);
    if (!part || !part.type || part.movable === false || !pose) return false;
    this.leave();
    this.name = name;
    this.pose = this.#from = pose;
    return true;
  }

  leave(): void {
    clearTimeout(this.#timer);
    this.#asked++;
    this.name = this.pose = this.#from = null;
    this.faults = [];
    this.checked = "same";
  }

  /** Be where a pointer is, that took it at its grip. */
  grip(at: [number, number]): void {
    if (this.pose) this.#grip = [at[0] - this.pose.x, at[1] - this.pose.y];
  }
  over(at: [number, number]): void {
    if (this.pose) this.to(stepped({ ...this.pose, x: at[0] - this.#grip[0], y: at[1] - this.#grip[1] }, this.snap ? this.#holes : null));
  }

  to(pose: Pose): void {
    if (this.pose && fields(pose) === fields(this.pose)) return;
    this.pose = pose;
    this.faults = [];
    clearTimeout(this.#timer);
    this.#asked++;
    this.checked = this.changed ? "checking" : "same";
    if (this.changed) this.#timer = window.setTimeout(() => this.#check(), SETTLED);
  }

  /** What a key does while something is in the hand; null for one that does nothing. */
  key(event: KeyboardEvent): (() => void) | null {
    const pose = this.pose;
    if (!this.on || !pose || event.ctrlKey || event.metaKey || event.altKey) return null;
    const step = event.shiftKey ? 0.1 : this.snap ? (this.#holes?.pitch ?? 25) : 1, turn = event.shiftKey ? 1 : 15;
    const to = (dx: number, dy: number, dyaw = 0) => () => this.to(stepped({ x: pose.x + dx, y: pose.y + dy, yaw: pose.yaw + dyaw }, this.snap && !event.shiftKey && !dyaw ? this.#holes : null));
    const keys: Record<string, () => void> = {
      ArrowLeft: to(-step, 0), ArrowRight: to(step, 0), ArrowUp: to(0, step), ArrowDown: to(0, -step),
      r: to(0, 0, turn), R: to(0, 0, turn), e: to(0, 0, -turn), E: to(0, 0, -turn),
      Enter: () => void this.write(), Escape: () => this.leave(),
    };
    return keys[event.key] ?? null;
  }

  /** Write it into the manifest, once the desk has said that it fits. */
  async write(): Promise<void> {
    const name = this.name;
    if (!name || !this.changed) return;
    clearTimeout(this.#timer);
    if (this.checked === "checking") await this.#check();
    if (this.checked !== "fits") return;
    const before = this.#before(name);
    if (!(await desk.wrote(this.words))) return;
    if (before) this.undo = [before, ...this.undo].slice(0, 50);
    this.leave();
    this.take(name);
  }

  async back(): Promise<void> {
    const [words, ...rest] = this.undo;
    if (!words || !(await (words[0] === "move" ? desk.wrote(words) : desk.did(words)))) return;
    this.undo = rest;
    const name = this.name;
    this.leave();
    if (name) this.take(name);
  }

  async #check(): Promise<void> {
    const mine = ++this.#asked;
    const answer = await desk.run([...this.words, "--dry-run"]);
    if (mine !== this.#asked) return;
    this.faults = answer.diagnostics.filter((one) => one.severity === "error");
    this.checked = answer.said.some((one) => "schema" in one && one.schema === "pico.capture/v1") && !this.faults.length ? "fits" : "wrong";
  }

  get #holes(): Table["holes"] | null { return bench.scene?.table.holes ?? null; }

  #row(name: string): StatusRow | undefined {
    return desk.status?.rows.find((row) => row.component === name && row.tunable === "pose");
  }

  /** Where it is wanted, else where it stands. */
  #wanted(part: Component): Pose | null {
    const desired = this.#row(part.name)?.desired;
    if (isPose(desired) && "x" in desired) return { x: desired.x, y: desired.y, yaw: desired.yaw };
    return part.pose ? { x: part.pose.x, y: part.pose.y, yaw: part.pose.yaw } : null;
  }

  #before(name: string): string[] | null {
    const row = this.#row(name), desired = row?.desired;
    if (!row?.edited) return ["checkout", "HEAD", "--files-only", "--yes", "--", `${name}.pose`];
    return isPose(desired) && "x" in desired ? moved(name, desired) : null;
  }
}

export const hand = new Hand();
