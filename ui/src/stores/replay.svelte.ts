/** A run that is replayed in the twin instead of the live bench, and the one clock of that. */

import { at, reel, sceneAt, stepped, type Frames, type Reel } from "../replay/frames";
import type { Frame } from "../live/frame";
import type { Scene } from "../twin/scene";
import { address } from "./address.svelte";
import { desk } from "./desk.svelte";

let epochs = 0;
/** Milliseconds between two times that are written into the address while it plays. */
const WRITTEN = 1000;

class Replay {
  film = $state.raw<Reel | null>(null);
  /** Seconds since the run began. */
  time = $state(0);
  playing = $state(false);
  /** So many times as fast as it was. */
  speed = $state(4);
  /** The run that is being fetched. */
  opening = $state<string | null>(null);
  /** The run that was asked for, by the word in the address. */
  of = $state<string | null>(null);
  #last = 0;
  #wrote = 0;

  get frames(): Frames | null { return this.film?.frames ?? null; }
  readonly scene: Scene | null = $derived(this.film ? sceneAt(this.film, this.time) : null);
  readonly frame: Frame | null = $derived(this.film ? at(this.film, this.time) : null);

  /** Replay a run from a time on, paused. */
  async open(run: string, time = 0): Promise<void> {
    if (this.opening === run) return;
    this.opening = this.of = run;
    this.playing = false;
    const found = await desk.read<Frames>("pico.frames/v1", "runs", "show", run, "--frames");
    if (this.opening !== run) return;
    this.opening = null;
    if (!found) return this.close();
    this.film = reel(found, -++epochs);
    this.seek(time);
  }

  /** Back to the live bench. */
  close(): void {
    this.film = this.opening = this.of = null;
    this.playing = false;
    address.set({ t: null });
  }

  seek(time: number): void {
    this.time = Math.max(0, Math.min(time, this.frames?.seconds ?? 0));
    this.#write();
  }

  step(by: 1 | -1): void {
    if (!this.frames) return;
    this.playing = false;
    this.seek(stepped(this.frames, this.time, by));
  }

  toggle(): void {
    if (!this.frames) return;
    if (!this.playing && this.time >= this.frames.seconds) this.time = 0;
    this.playing = !this.playing;
    this.#last = performance.now();
    if (this.playing) requestAnimationFrame(this.#tick);
    else this.#write();
  }

  #tick = (now: number): void => {
    if (!this.playing || !this.frames) return;
    const next = this.time + (this.speed * Math.max(0, now - this.#last)) / 1000;
    this.#last = now;
    this.time = Math.min(next, this.frames.seconds);
    if (this.time >= this.frames.seconds) this.playing = false;
    if (!this.playing || now - this.#wrote > WRITTEN) this.#write(now);
    if (this.playing) requestAnimationFrame(this.#tick);
  };

  #write(now = performance.now()): void {
    this.#wrote = now;
    if (this.frames) address.set({ t: this.time.toFixed(2) });
  }
}

export const replay = new Replay();
