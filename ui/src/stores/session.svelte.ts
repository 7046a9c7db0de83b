/** Who looks at the page, and which benches there are for them. */

import { ask, Refused, type Diagnostic } from "../api/client";
import { address } from "./address.svelte";

export interface Holder { who: string; session: string; token: number; since: number; left: number; fenced: boolean; run: string | null; you?: boolean }
export interface Lease { bench: string; holder: Holder | null; waiting: string[] }
export interface Bench { bench: string; lease: Lease; connected: boolean | null }
interface Me { name: string; rights: string[] }

class Session {
  me = $state<Me | null>(null);
  benches = $state<Bench[]>([]);
  state = $state<"asking" | "out" | "in">("asking");
  trouble = $state<Diagnostic[]>([]);

  /** Log in by the one-time code in the address, else by the cookie that there is. */
  async begin(): Promise<void> {
    const code = /^#code=([\w.-]+)$/.exec(location.hash)?.[1];
    if (code) {
      history.replaceState(null, "", location.pathname + location.search);
      address.now = { ...address.now, bench: null };
      await this.enter({ code });
    } else await this.#look();
  }

  /** Log in with a token, or a code. */
  async enter(said: { secret: string } | { code: string }): Promise<void> {
    try {
      await ask("post", "/api/session", {}, said);
      await this.#look();
    } catch (failure) {
      this.#refused(failure);
    }
  }

  async leave(): Promise<void> {
    await ask("delete", "/api/session").catch(() => undefined);
    this.me = null;
    this.state = "out";
  }

  async #look(): Promise<void> {
    try {
      this.me = await ask<Me>("get", "/api/whoami");
      this.benches = await ask<Bench[]>("get", "/api/benches");
      this.trouble = [];
      this.state = "in";
      const first = this.benches[0];
      if (first && !this.benches.some((one) => one.bench === address.now.bench)) address.open(first.bench);
    } catch (failure) {
      this.#refused(failure);
    }
  }

  #refused(failure: unknown): void {
    this.state = "out";
    if (!(failure instanceof Refused)) throw failure;
    this.trouble = failure.status === 401 && !failure.diagnostics[0]?.code.includes("code") ? [] : failure.diagnostics;
  }

  /** Whether one has a role in a lab. */
  may(role: string, lab: string): boolean {
    const holds: Record<string, string[]> = { viewer: ["viewer", "operator", "admin"], operator: ["operator", "admin"] };
    const enough = holds[role] ?? [role];
    return (this.me?.rights ?? []).some((right) => {
      const [what = "", where = "*"] = right.split("@");
      return enough.includes(what) && (where === "*" || where === lab);
    });
  }
}

export const session = new Session();
