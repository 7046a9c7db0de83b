/** A socket that is opened again and again, a little later each time, until it is closed here. */

export interface Hears {
  opened(): void;
  text(data: unknown): void;
  binary(data: ArrayBuffer): void;
  state(state: "opening" | "open" | "lost"): void;
}

const WAITS = [200, 500, 1000, 2000];

export class Line {
  #socket: WebSocket | null = null;
  #tries = 0;
  #timer = 0;
  #closed = false;

  constructor(readonly path: string, readonly hears: Hears) {
    hears.state("opening");
    this.#dial();
  }

  close(): void {
    this.#closed = true;
    clearTimeout(this.#timer);
    this.#socket?.close();
  }

  #dial(): void {
    const socket = (this.#socket = new WebSocket(new URL(this.path, location.href.replace(/^http/, "ws"))));
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.#tries = 0;
      this.hears.state("open");
      this.hears.opened();
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === "string") this.hears.text(JSON.parse(data));
      else this.hears.binary(data);
    };
    socket.onclose = () => {
      if (this.#closed) return;
      this.hears.state("lost");
      this.#timer = window.setTimeout(() => this.#dial(), WAITS[Math.min(this.#tries++, WAITS.length - 1)]);
    };
  }
}
