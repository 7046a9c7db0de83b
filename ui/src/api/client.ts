/** How the page speaks to the coordinator: the same requests that scripts make, with the cookie of its session. */

import type { paths } from "./schema";

export interface Diagnostic {
  severity: "error" | "warning" | "note";
  code: string;
  summary: string;
  detail?: string;
  hint?: string;
  address?: string;
  /** The place in a file where it is. */
  source?: { path: string; start: { line: number; column: number } } | null;
}

export type Path = keyof paths;
type Method = "get" | "post" | "put" | "delete";

/** The coordinator said no; what is wrong stands in `diagnostics`. */
export class Refused extends Error {
  constructor(readonly status: number, readonly diagnostics: Diagnostic[]) {
    super(diagnostics.map((one) => one.summary).join("; ") || `the coordinator answered ${status}`);
  }
}

/** What is wrong, and where in a file that is. */
export function placed(one: Diagnostic): string {
  return one.source ? `${one.source.path}:${one.source.start.line}:${one.source.start.column}: ${one.summary}` : one.summary;
}

/** A path with its parameters put in: `/api/benches/{lab}/{bench}/lease`. */
export function filled(path: string, parameters: Record<string, string | number> = {}): string {
  const rest = new URLSearchParams();
  let found = path;
  for (const [name, value] of Object.entries(parameters)) {
    const mark = `{${name}}`;
    if (found.includes(mark)) found = found.replace(mark, encodeURIComponent(value));
    else rest.set(name, String(value));
  }
  return rest.size ? `${found}?${rest}` : found;
}

async function answered(method: Method, path: string, body?: unknown, signal?: AbortSignal): Promise<Response> {
  const init: RequestInit = { method: method.toUpperCase(), credentials: "same-origin", signal: signal ?? null };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { "content-type": "application/json" };
  }
  let response: Response;
  try {
    response = await fetch(path, init);
  } catch (failure) {
    if (signal?.aborted) throw failure;
    throw new Refused(0, [{ severity: "error", code: "away", summary: "the coordinator does not answer", hint: "is it still served?" }]);
  }
  if (response.ok) return response;
  const said = (await response.json().catch(() => null)) as { error?: Diagnostic[] } | null;
  throw new Refused(response.status, said?.error ?? []);
}

/** Ask, and return what is answered; throws Refused. */
export async function ask<T>(method: Method, path: Path, parameters: Record<string, string | number> = {}, body?: unknown, signal?: AbortSignal): Promise<T> {
  const response = await answered(method, filled(path, parameters), body, signal);
  return (response.status === 204 ? null : await response.json()) as T;
}

/** Ask for a stream of JSON lines; throws Refused. */
export async function* lines<T>(
  method: "get" | "post", path: string, body?: unknown, hears: { begun?(run: string): void; signal?: AbortSignal } = {},
): AsyncGenerator<T> {
  const response = await answered(method, path, body, hears.signal);
  const run = response.headers.get("x-pico-run");
  if (run) hears.begun?.(run);
  yield* split<T>(response.body!);
}

/** What the end of a line in the middle of an answer means to who asked. */
function cut(failure: unknown): unknown {
  if (failure instanceof DOMException && failure.name === "AbortError") return failure;
  return new Refused(0, [{ severity: "error", code: "away", summary: "the coordinator was lost in the middle of its answer", hint: "what was begun may go on: Runs tells once it is back" }]);
}

/** The JSON documents in a stream of bytes, a line each; throws Refused where it is cut off. */
export async function* split<T>(stream: ReadableStream<Uint8Array>): AsyncGenerator<T> {
  const reader = stream.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  try {
    for (;;) {
      const { value, done } = await reader.read().catch((failure: unknown) => { throw cut(failure); });
      rest += decoder.decode(value, { stream: !done });
      const found = rest.split("\n");
      rest = found.pop()!;
      for (const line of found) if (line.trim()) yield JSON.parse(line) as T;
      if (done) break;
    }
    if (rest.trim()) yield JSON.parse(rest) as T;
  } finally {
    await reader.cancel().catch(() => undefined);
  }
}
