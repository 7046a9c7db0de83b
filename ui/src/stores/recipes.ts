/** Recipes of the lab, what is known of one in advance, and how far one that runs has come. */

import type { Said } from "../api/documents";

export interface Input { name: string; kind: "number" | "bool" | "text" | "numbers" | "texts"; unit: string; default: unknown; low: number | null; high: number | null; choices: string[]; description: string }
export interface Listed { name: string; title: string; parameters: string; wrong: boolean; inputs: Input[]; asks: string[]; steered: string[] }
export interface Listing { schema: "pico.recipes/v1"; recipes: Listed[]; cut_short: { run: string; recipe: string; at: string }[] }
export interface AheadStep { path: string; title: string; known: boolean; seconds?: number }
export interface Foreseen { schema: "pico.recipe_ahead/v1"; recipe: string; seconds: number; whole: boolean; steps: AheadStep[] }
export interface Row { path: string; title: string; depth: number; state: "waiting" | "going" | "done" | "before"; turn: string; said: string }
interface RecipeEvent { schema: "pico.recipe_event/v1"; event: "step" | "done"; path: string; title?: string; turn?: number; turns?: number; result?: Record<string, unknown>; before?: boolean }

/** What a step asks a person, with what an answer may be (`wanted`, in words). */
export interface Question {
  schema: "pico.question/v1"; id: string; path: string; text: string; kind: "confirm" | "number" | "bool" | "text"; name: string; unit: string;
  default: unknown; low: number | null; high: number | null; choices: string[]; unattended: "fail" | "skip"; wanted: string;
}

/** What is asked now: a question is over with whatever is said next. */
export function asks(said: Said[]): Question | null {
  const last = said.at(-1);
  return last && "schema" in last && last.schema === "pico.question/v1" ? (last as unknown as Question) : null;
}

/** The recipe that words run; empty where they do not say. */
export function recipeOf(words: string[]): string {
  const [command, name = "-"] = words;
  return command !== "run" || name.startsWith("-") ? "" : name.replace(/^.*\//, "").replace(/\.yaml$/, "");
}

/** What came of a step in a few words: its value, and who answered where it asked. */
function result(event: RecipeEvent, unit: string): string {
  const { "": value, by } = event.result ?? {};
  return [value === undefined ? "" : `${value}${unit && ` ${unit}`}`, by ? `by ${by}` : ""].filter(Boolean).join(", ");
}

/** How deep a step lies: `28.1` and `28[2].1` lie in 28. */
export function depth(path: string): number {
  return path.split(".").length - 1;
}

/** A default as one types it: `30`, `[0, 15]`. */
export function typedDefault(value: unknown): string {
  return value === null || value === undefined ? "" : typeof value === "string" ? value : JSON.stringify(value);
}

/** The words that give what differs from the defaults. */
export function given(inputs: Input[], fields: Record<string, string>): string[] {
  return inputs.flatMap(({ name, default: usual }) => {
    const said = (fields[name] ?? "").trim();
    return said && said !== typedDefault(usual) ? ["-p", `${name}=${said}`] : [];
  });
}

/** Whether a step lies in another: `2[1].1` in 2, and not 21 in 2. */
function inside(path: string, other: string): boolean {
  return path.startsWith(other) && /^[.[]/.test(path.slice(other.length));
}

/**
 * The steps with how far they are: those that are known in advance, and those that came up on the way. Of a loop nobody
 * says that it is done: it is so once a step beside it begins, or all is `over`.
 */
export function rows(ahead: AheadStep[], said: Said[], over = false): Row[] {
  const found = new Map<string, Row>(ahead.map(({ path, title }) => [path, { path, title, depth: depth(path), state: "waiting", turn: "", said: "" }]));
  const units = new Map<string, string>();
  for (const one of said) {
    if ("schema" in one && one.schema === "pico.question/v1") units.set(String(one.path), String(one.unit));
    if (!("schema" in one) || one.schema !== "pico.recipe_event/v1") continue;
    const event = one as unknown as RecipeEvent;
    if (event.path.endsWith("?")) continue;
    const row = found.get(event.path) ?? { path: event.path, title: event.title ?? "", depth: depth(event.path), state: "waiting", turn: "", said: "" };
    found.set(event.path, row);
    if (event.event === "step") {
      for (const each of found.values()) if (each.state === "going" && !inside(event.path, each.path)) each.state = "done";
    }
    if (event.event === "step") Object.assign(row, { state: "going", title: event.title ?? row.title, turn: event.turns ? `${event.turn} of ${event.turns}` : "" });
    else {
      row.state = event.before ? "before" : "done";
      row.said = result(event, units.get(event.path) ?? "") || row.said;
    }
  }
  if (over) for (const each of found.values()) if (each.state === "going") each.state = "done";
  return [...found.values()];
}
