/** What cameras see now, as the bench's edge gives it: small pictures with what kernels say of them. */

import { ask, Refused } from "../api/client";
import { bench } from "./bench.svelte";
import type { Still } from "./seen";

/** One camera that is watched. */
export class Watched {
  still = $state.raw<Still | null>(null);
  /** Why there is none. */
  why = $state("");
  #on = false;

  constructor(readonly component: string, readonly measurable: string, public kernels: string[], readonly every: number) {}

  /** Look again and again, the next time once the last was answered, as long as the page is seen. Returns what ends it. */
  begin(): () => void {
    this.#on = true;
    void this.#look();
    return () => { this.#on = false; };
  }

  async #look(): Promise<void> {
    while (this.#on) {
      if (!document.hidden && bench.edge === "here" && bench.line === "open") await this.#once();
      await new Promise((done) => setTimeout(done, this.every));
    }
  }

  async #once(): Promise<void> {
    try {
      const { value } = await ask<{ value: Still }>("post", "/api/benches/{lab}/{bench}/calls/picture", bench.at, { with: [this.component, this.measurable, this.kernels], session: bench.session });
      this.still = value;
      this.why = "";
    } catch (failure) {
      if (!(failure instanceof Refused)) throw failure;
      this.why = failure.message;
    }
  }
}
