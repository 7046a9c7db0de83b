/** Steering by hand: the page's end of a teleoperation, of which the bench's edge holds the other. */

import { filled, Refused, type Diagnostic } from "../api/client";
import type { BenchEvent } from "../api/documents";
import { Link } from "../live/link";
import { bench, type LiveEvent } from "./bench.svelte";
import { desk } from "./desk.svelte";
import { Hand, rung, type Frame, type Heard } from "./teleop";
import { told } from "./told.svelte";

/** Milliseconds between two frames while something may move, and else. */
const OFTEN = 33, SELDOM = 100;

export interface Jogged { unit: string; longest: number; range: [number, number] | null; period: number | null; steps: number[] }
export interface Begun { schema: "pico.steered/v1"; run: string; operation: string; component: string; robot: string | null; tunables: Record<string, Jogged> }
/** What it came to, one transition. */
export interface Came { component: string; robot: string | null; run: string; first: Record<string, number>; last: Record<string, number>; steps: number; refused: number; presses: Record<string, number>; after: number; outcome: string; wrong: Diagnostic[] }

class Steering {
  begun = $state.raw<Begun | null>(null);
  answer = $state.raw<Heard | null>(null);
  /** When the edge last answered [ms of this page's clock]. */
  heard = $state(0);
  steps = $state<Record<string, number>>({});
  chosen = $state("");
  held = $state<{ tunable: string; way: number } | null>(null);
  /** Why this page let go. */
  why = $state("");
  came = $state.raw<Came | null>(null);
  state = $state<"idle" | "beginning" | "on" | "ending">("idle");
  #hand = new Hand();
  #link: Link | null = null;
  #timer = 0;
  #last = 0;
  #off: () => void = () => undefined;

  /** Have it begun, and be there from then on. */
  async begin(target: string): Promise<void> {
    this.state = "beginning";
    this.came = this.answer = null;
    this.why = "";
    const link = (this.#link = new Link(filled("/api/benches/{lab}/{bench}/link", bench.at), bench.session, () => this.#lost(link)));
    await Promise.race([link.opened, new Promise((done) => setTimeout(done, 5000))]);
    this.#off = bench.listen((event) => this.#news(event));
    const over = (): boolean => this.#link !== link;
    const answer = await desk.run(["teleop", target, "--begin", "--yes"], (said) => {
      if ("schema" in said && said.schema === "pico.steered/v1") this.#begins(said as unknown as Begun);
    });
    if (answer.exit === 0 || over()) return;
    told.wrong(answer.diagnostics.filter((one) => one.severity === "error"));
    this.#over();
  }

  #begins(begun: Begun): void {
    this.begun = begun;
    this.#hand = new Hand();
    this.steps = Object.fromEntries(Object.entries(begun.tunables).map(([name, one]) => [name, one.steps[Math.max(0, one.steps.length - 4)]!]));
    this.chosen = Object.keys(begun.tunables)[0]!;
    this.#timer = window.setInterval(() => this.#beat(), OFTEN);
  }

  /** A key or a button goes down: one step, and more while it stays down. */
  hold(tunable: string, way: number): void {
    if (this.state !== "on" || this.answer?.phase !== "ready" || document.hidden) return;
    this.held = { tunable, way };
    this.chosen = tunable;
    this.why = "";
    this.#say(this.#hand.hold(tunable, way * this.steps[tunable]!));
  }

  /** Nothing is held down any more; said at once. */
  release(why: string): void {
    if (!this.begun || !this.held) return;
    this.held = null;
    this.why = why;
    this.#say(this.#hand.release());
  }

  size(way: number): void {
    const one = this.begun?.tunables[this.chosen];
    if (one) this.steps[this.chosen] = rung(one.steps, this.steps[this.chosen]!, way);
  }

  end(): void {
    this.release("it ends");
    this.state = "ending";
  }

  #beat(): void {
    const often = this.held || this.answer?.phase !== "ready" || this.state === "ending";
    if (this.#link!.waiting || performance.now() - this.#last < (often ? 0 : SELDOM)) return; // none is ever queued
    this.#say(this.#hand.frame(this.state === "ending"));
  }

  #say(frame: Frame): void {
    this.#last = performance.now();
    this.#link!.call<Heard>("jog", this.begun!.run, frame).then((answer) => this.#hears(answer), (why: unknown) => {
      if (!(why instanceof Refused)) throw why; // it is not begun yet, or over: the desk and the bench say so
    });
  }

  #hears(answer: Heard): void {
    this.heard = performance.now();
    const begins = answer.phase !== "over" && this.state === "beginning";
    if (begins) this.state = "on";
    if (this.state === "beginning") return;
    this.#hand.heard(answer);
    if (!this.#hand.held) this.held = null;
    if (answer.phase !== "over") this.answer = answer;
  }

  #news({ kind, data }: LiveEvent): void {
    const event = data as BenchEvent;
    if (kind !== "run" || !this.begun || event.run !== this.begun.run) return;
    if (event.kind === "operation_done" && event.operation === this.begun.operation) this.#comes(event.data as unknown as Came);
    if (event.kind === "operation_failed" && event.operation === this.begun.operation) {
      this.#comes({ wrong: [event.data.diagnostic as Diagnostic] });
    }
    if (event.kind === "run_finished") {
      this.came = this.came && { ...this.came, outcome: String(event.data.outcome ?? "") };
      this.#over();
      void Promise.all([desk.look(), desk.recorded()]);
    }
  }

  #comes(data: Partial<Came>): void {
    const { component, robot, run } = this.begun!;
    const none = { first: {}, last: {}, steps: this.answer?.steps ?? 0, refused: 0, presses: {}, after: 0, outcome: "", wrong: [] };
    this.came = { ...none, ...data, component, robot, run };
  }

  #lost(link: Link): void {
    if (this.#link !== link || this.state === "idle") return;
    this.held = null;
    told.wrong([{ severity: "error", code: "away", summary: "The line to the bench is lost: nothing moves any more.", hint: this.begun?.robot ? `${this.begun.robot} may still hold ${this.begun.component}: \`pico recover\` sets it down` : "" }]);
    this.#over();
  }

  #over(): void {
    const link = this.#link;
    this.state = "idle";
    this.begun = this.answer = this.held = this.#link = null;
    clearInterval(this.#timer);
    this.#off();
    link?.close();
  }

  /** The window goes to the background, or away. Returns what ends the listening. */
  watch(): () => void {
    const hidden = (): void => { if (document.hidden) this.release("the tab was hidden"); };
    const blurred = (): void => this.release("the window lost the focus");
    const left = (): void => this.release("the page was left");
    addEventListener("blur", blurred);
    addEventListener("pagehide", left);
    document.addEventListener("visibilitychange", hidden);
    document.addEventListener("freeze", left);
    return () => {
      removeEventListener("blur", blurred);
      removeEventListener("pagehide", left);
      document.removeEventListener("visibilitychange", hidden);
      document.removeEventListener("freeze", left);
    };
  }
}

export const steering = new Steering();
