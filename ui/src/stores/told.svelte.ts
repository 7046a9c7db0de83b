/** What the page tells in passing: what went wrong, what was done. */

import { placed, Refused, type Diagnostic } from "../api/client";

export interface Told { number: number; kind: "said" | "wrong"; text: string; hint: string }

class Telling {
  all = $state<Told[]>([]);
  #number = 0;

  /** Say something for so long [s]. */
  say(text: string, lasts = 6): void {
    const made = this.#add("said", text, "");
    setTimeout(() => this.drop(made), lasts * 1000);
  }

  wrong(found: Diagnostic[]): void {
    for (const one of found) this.#add("wrong", placed(one), one.hint ?? "");
  }

  failed(failure: unknown): void {
    if (failure instanceof Refused) this.wrong(failure.diagnostics.length ? failure.diagnostics : [{ severity: "error", code: "", summary: failure.message }]);
    else if (!(failure instanceof DOMException && failure.name === "AbortError")) throw failure;
  }

  async trying(work: () => Promise<unknown>): Promise<void> {
    try {
      await work();
    } catch (failure) {
      this.failed(failure);
    }
  }

  drop(number: number): void {
    this.all = this.all.filter((one) => one.number !== number);
  }

  #add(kind: Told["kind"], text: string, hint: string): number {
    const same = this.all.find((one) => one.text === text);
    if (same) return same.number;
    const number = ++this.#number;
    this.all = [...this.all, { number, kind, text, hint }].slice(-4);
    return number;
  }
}

export const told = new Telling();
