/** What a hand on a key says to the edge that it steers at: frames and answers of `pico/teleop/frames.py`. */

export interface Frame { seq: number; seen: number; press: number; tunable: string; by: number; release: boolean; end: boolean }

export interface Heard {
  /** The edge's clock [s]. */
  clock: number;
  refused: string;
  phase: "taking" | "ready" | "letting go" | "over";
  values: Record<string, number>;
  steps: number;
  missed: number;
  limit: string;
  stopped: "" | "released" | "silent" | "late" | "refused";
}

/** Counts frames and presses; a press that was refused is over until a key is pressed anew. */
export class Hand {
  #seq = 0;
  #press = 0;
  #missed = 0;
  #seen = 0;
  held: { tunable: string; by: number } | null = null;

  /** A key goes down. */
  hold(tunable: string, by: number): Frame {
    this.#press += 1;
    this.held = { tunable, by };
    return this.frame();
  }

  /** No key is down any more. */
  release(): Frame {
    this.held = null;
    return { ...this.frame(), release: true };
  }

  /** What is said now: the key that is held, else only that somebody is there. */
  frame(end = false): Frame {
    const held = end ? null : this.held;
    return { seq: ++this.#seq, seen: this.#seen, press: held ? this.#press : 0, tunable: held?.tunable ?? "", by: held?.by ?? 0, release: false, end };
  }

  heard(answer: Heard): void {
    this.#seen = answer.clock;
    if (answer.refused || answer.missed > this.#missed) this.held = null;
    this.#missed = answer.missed;
  }
}

const WHY = {
  "": "",
  released: "it was let go",
  silent: "the edge heard nothing for 0.2 s",
  late: "what it heard was too long on its way",
  refused: "the step was refused",
} as const;

/** Why nothing moves, as the edge says it. */
export function stopped(answer: Heard): string {
  return answer.stopped === "refused" && answer.limit ? answer.limit : WHY[answer.stopped];
}

/** With so many decimals as a step changes: `30.50`. */
export function decimals(value: number | undefined, step: number): string {
  return value === undefined ? "?" : value.toFixed(Math.max(0, Math.min(6, -Math.floor(Math.log10(step)))));
}

/** The step next to one that is chosen, of those that there are. */
export function rung(steps: number[], chosen: number, way: number): number {
  const at = steps.findIndex((one) => one >= chosen);
  return steps[Math.max(0, Math.min(steps.length - 1, (at < 0 ? steps.length - 1 : at) + way))]!;
}
