/** The bench that the page shows: its scene, its line, who has it, and the red button. */

import { ask, filled, Refused, type Diagnostic } from "../api/client";
import { decode, type Frame } from "../live/frame";
import { Line } from "../live/line";
import { changed, read, type Scene } from "../twin/scene";
import { session, type Holder, type Lease } from "./session.svelte";
import { told } from "./told.svelte";

const MINE = `page-${sessionStorage.getItem("pico-session") ?? fresh()}`;

function fresh(): string {
  const made = Array.from(crypto.getRandomValues(new Uint8Array(6)), (one) => one.toString(16).padStart(2, "0")).join("");
  sessionStorage.setItem("pico-session", made);
  return made;
}

export interface LiveEvent { seq: number; epoch: number; rev: number; kind: string; data: unknown }

/** Under which the page remembers, in its tab, of which bench it asked for the lease. */
const ASKED = "pico-asked";
/** How long a lease goes on that is not renewed, where nobody says so [s]. */
const LASTS = 10;
/** How long STOP waits until it says that nobody answered [s]. */
const ANSWERS = 5;

class Bench {
  name = $state<string | null>(null);
  scene = $state.raw<Scene | null>(null);
  line = $state<"opening" | "open" | "lost">("opening");
  lease = $state<Lease | null>(null);
  /** When the lease was asked for [ms of this page's clock]: what is left of it counts from there. */
  asked = $state(0);
  token = $state<number | null>(null);
  /** Whether this page waits for the lease. */
  waits = $state(false);
  /** Whether it became this page's turn while it waited, and nobody has looked yet. */
  turn = $state(false);
  /** How many commands were begun at desks for this bench since it was opened, elsewhere than here. */
  begun = $state(0);
  /** Who hears each frame; the twin does. */
  onframe: (frame: Frame) => void = () => undefined;
  #events = new Set<(event: LiveEvent) => void>();
  #line: Line | null = null;
  #watch: Line | null = null;
  #renewing = 0;
  #seq = 0;
  /** Whether the bench's edge is connected to the coordinator. */
  edge = $state<"here" | "away">("here");

  readonly session = MINE;

  /** Whether this page has the bench; `you` in the lease is the person, who may have it in another page or terminal. */
  get mine(): boolean { return this.#ours(this.lease?.holder ?? null); }
  #ours(holder: Holder | null): boolean { return holder?.you === true && holder.session.endsWith(`/${MINE}`); }
  /** Whether a command that this page began has it, for as long as that takes: its session goes on after a `~`. */
  get runs(): boolean {
    const holder = this.lease?.holder;
    return holder?.you === true && holder.session.includes(`/${MINE}~`);
  }
  get lab(): string { return this.name?.split("/")[0] ?? ""; }
  get at(): Record<string, string> {
    const [lab = "", bench = ""] = (this.name ?? "").split("/");
    return { lab, bench };
  }

  listen(hears: (event: LiveEvent) => void): () => void {
    this.#events.add(hears);
    return () => this.#events.delete(hears);
  }

  open(name: string): void {
    this.close();
    this.name = name;
    const path = filled("/api/benches/{lab}/{bench}/live", this.at);
    this.#line = new Line(path, {
      opened: () => undefined,
      text: (data) => this.#said(data as LiveEvent),
      binary: (data) => this.#moved(data),
      state: (state) => (this.line = state),
    });
    this.#watch = new Line("/api/events", {
      opened: () => void this.look(),
      text: (data) => {
        const said = data as { bench?: string; kind?: string; data?: { session?: string } };
        if (said.bench !== this.name) return;
        if (said.kind === "desk" && said.data?.session !== MINE) this.begun++;
        void this.look();
      },
      binary: () => undefined,
      state: () => undefined,
    });
  }

  close(): void {
    this.#line?.close();
    this.#watch?.close();
    clearInterval(this.#renewing);
    this.scene = this.lease = this.token = null;
  }

  async #snapshot(): Promise<void> {
    try {
      this.scene = read(await ask("get", "/api/benches/{lab}/{bench}/scene", this.at));
      this.edge = "here";
    } catch (failure) {
      if (failure instanceof Refused && failure.status >= 500) this.edge = "away";
      else told.failed(failure);
    }
  }

  #said(said: LiveEvent | { hello: { epoch: number | null; seq: number } }): void {
    if ("hello" in said) {
      this.#seq = said.hello.seq;
      if (said.hello.epoch === null) this.edge = "away";
      return void this.#snapshot();
    }
    const hole = said.seq !== this.#seq + 1;
    this.#seq = said.seq;
    if (said.kind === "away") this.edge = "away";
    else if (said.kind === "lease") void this.look();
    else if (hole || said.kind === "scene" || said.epoch !== this.scene?.epoch) void this.#snapshot();
    else if (said.rev > this.scene.rev) this.scene = changed(this.scene, said);
    if (said.kind === "guard") told.wrong((said.data as { notices: Diagnostic[] }).notices);
    for (const hears of this.#events) hears(said);
  }

  #moved(data: ArrayBuffer): void {
    const frame = decode(data);
    if (this.scene && frame.epoch === this.scene.epoch) this.onframe(frame);
  }

  // who has it

  async look(): Promise<void> {
    try {
      this.lease = await ask<Lease>("get", "/api/benches/{lab}/{bench}/lease", this.at);
      this.asked = performance.now();
      this.#granted(this.lease.holder);
    } catch (failure) {
      if (!(failure instanceof Refused && failure.status === 0)) told.failed(failure);
    }
  }

  /** Keep the lease that this page asked for, also where it is granted later, or the page was loaded anew. */
  #granted(holder: Holder | null): void {
    if (this.token !== null || sessionStorage.getItem(ASKED) !== this.name || !holder || !this.#ours(holder)) return;
    if (!holder.fenced) return void setTimeout(() => void this.look(), 300);
    this.turn = this.waits;
    if (this.turn) told.say(`It is your turn: you have ${this.name}.`, 60);
    this.#keep(holder.token, LASTS);
  }

  async take(): Promise<void> {
    sessionStorage.setItem(ASKED, this.name ?? "");
    await told.trying(async () => {
      const found = await ask<{ state: string; token?: number; lasts?: number }>(
        "post", "/api/benches/{lab}/{bench}/lease", this.at, { session: MINE, wait: 2 });
      if (found.token !== undefined) this.#keep(found.token, found.lasts!);
      else {
        this.waits = true;
        told.say("Asked for: you are told when it is your turn.");
      }
    });
    await this.look();
  }

  async release(): Promise<void> {
    this.#forget();
    await told.trying(() => ask("delete", "/api/benches/{lab}/{bench}/lease", { ...this.at, session: MINE, token: this.token ?? 0 }));
    this.token = null;
    await this.look();
  }

  async steal(reason: string): Promise<void> {
    sessionStorage.setItem(ASKED, this.name ?? "");
    await told.trying(async () => {
      const found = await ask<{ token: number; lasts: number }>(
        "post", "/api/benches/{lab}/{bench}/lease/steal", this.at, { session: MINE, reason });
      this.#keep(found.token, found.lasts);
    });
    await this.look();
  }

  #forget(): void {
    clearInterval(this.#renewing);
    sessionStorage.removeItem(ASKED);
    this.waits = this.turn = false;
  }

  #keep(token: number, lasts: number): void {
    this.token = token;
    this.waits = false;
    clearInterval(this.#renewing);
    this.#renewing = window.setInterval(async () => {
      try {
        await ask("put", "/api/benches/{lab}/{bench}/lease", this.at, { session: MINE, token });
      } catch (failure) {
        if (failure instanceof Refused && failure.status === 0) return;
        this.#forget();
        this.token = null;
        told.failed(failure);
      }
      await this.look();
    }, (lasts * 1000) / 3);
  }

  // the red button

  /** Stop at once: arms brake, shutters close, grippers hold. Needs nobody's leave. */
  async stop(): Promise<void> {
    try {
      await ask("post", "/api/benches/{lab}/{bench}/calls/stop", this.at, { with: [] }, AbortSignal.timeout(ANSWERS * 1000));
      told.say("Stopped: arms brake, shutters close, grippers hold.");
    } catch (failure) {
      const why = failure instanceof Refused ? failure.message : `no answer within ${ANSWERS} s`;
      told.wrong([{ severity: "error", code: "stop", summary: `Not known to have stopped: ${why}`, hint: "use the emergency stop beside the table" }]);
    }
  }

  /** Stop safely, as Ctrl-C would: nothing more starts, and a part in the hand is set down. */
  async halt(): Promise<void> {
    await told.trying(() => ask("post", "/api/benches/{lab}/{bench}/calls/halt", this.at, { with: [] }));
  }

  /** Why one may not move this bench; null where one may. */
  get barred(): string | null {
    if (!this.name) return "no bench is chosen";
    if (!session.may("operator", this.lab)) return "you may watch here; moving needs the role operator";
    if (this.line === "lost") return "the line to the coordinator is lost";
    if (this.edge === "away") return "the bench's edge is not connected";
    const holder = this.lease?.holder;
    if (holder && !holder.you) return `${holder.who} has the bench`;
    if (holder && !this.mine) return holder.run || this.runs ? "a run of yours goes on" : "you have the bench in another page or terminal";
    return null;
  }
}

export const bench = new Bench();
