/** The socket of clients: calls to the edge of a bench, answered one by one. */

import { Refused, type Diagnostic } from "../api/client";

interface Reply { id?: number; value?: unknown; error?: Diagnostic[] }

/** It is not opened again: who steers begins anew. */
export class Link {
  #socket: WebSocket;
  #waits = new Map<number, { done(value: unknown): void; failed(why: Refused): void }>();
  #number = 0;
  readonly opened: Promise<void>;

  constructor(path: string, session: string, closed: () => void) {
    this.#socket = new WebSocket(new URL(path, location.href.replace(/^http/, "ws")));
    this.opened = new Promise((done) => {
      this.#socket.onopen = () => {
        this.#socket.send(JSON.stringify({ hello: { session } }));
        done();
      };
    });
    this.#socket.onmessage = ({ data }: MessageEvent<string>) => this.#said(JSON.parse(data) as Reply);
    this.#socket.onclose = () => {
      for (const one of this.#waits.values()) one.failed(new Refused(0, [{ severity: "error", code: "away", summary: "the line to the coordinator is lost" }]));
      this.#waits.clear();
      closed();
    };
  }

  /** How many calls are not answered yet. */
  get waiting(): number { return this.#waits.size; }

  /** Make a call at once, whatever others are not answered yet; throws Refused. */
  call<T>(name: string, ...given: unknown[]): Promise<T> {
    if (this.#socket.readyState !== WebSocket.OPEN) return Promise.reject(new Refused(0, []));
    const id = ++this.#number;
    this.#socket.send(JSON.stringify({ id, call: name, with: given }));
    return new Promise<T>((done, failed) => this.#waits.set(id, { done: (value) => done(value as T), failed }));
  }

  close(): void { this.#socket.close(); }

  #said(reply: Reply): void {
    const waits = reply.id === undefined ? undefined : this.#waits.get(reply.id);
    if (!waits) return;
    this.#waits.delete(reply.id!);
    if (reply.error) waits.failed(new Refused(400, reply.error));
    else waits.done(reply.value);
  }
}
