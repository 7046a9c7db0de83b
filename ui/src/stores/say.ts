/** How commands and values are written. */

import type { Change, Operation, Pose, Value } from "../api/documents";

/** How commands mark what is done: `+` placed from storage, `-` stowed, `~` changed where it is, `↷` makes room, `!` a
 * person must act, `·` changes nothing that was asked for. */
export function mark(one: Operation): string {
  const slot = (said: unknown) => (typeof said === "object" && said !== null && "slot" in said ? (said as { slot?: string }).slot : undefined);
  if (one.primitive === "operator") return "!";
  if (["park", "measure", "verify"].includes(one.primitive)) return "·";
  if (["staged", "in_the_way"].includes(one.reason.kind)) return "↷";
  if (slot(one.arguments.to)) return "-";
  return slot(one.arguments.from) ? "+" : "~";
}

/** The same of a value that differs. */
export function sign(one: Change): string {
  if (one.tunable !== "pose") return "~";
  if (typeof one.after === "string") return "-";
  return typeof one.before === "string" && one.after !== null && one.after !== undefined ? "+" : "~";
}

/** Words as one types them. */
export function typed(words: string[]): string {
  return ["pico", ...words].map((one) => (/^[\w@%+=:,./-]+$/.test(one) ? one : `'${one.replaceAll("'", `'\\''`)}'`)).join(" ");
}

/** A message as an option of a command, which may begin as options do. */
export function said(message: string): string[] {
  if (!message) return [];
  return message.startsWith("-") ? [`--message=${message}`] : ["-m", message];
}

const quoted = (text: string): string => JSON.stringify(text);
const texts = (pair: string): string => `${quoted(pair.slice(0, pair.indexOf("=")))}: ${quoted(pair.slice(pair.indexOf("=") + 1))}`;
const given = (pair: string, before: string): string => {
  const [name = "", value = ""] = pair.split("=");
  return `${quoted(before + name)}: ${value.trim() && !Number.isNaN(Number(value)) ? value : quoted(value)}`;
};

const KEPT: Record<string, (rest: string[]) => string | null> = {
  plan: ([rev]) => `print(bench.plan(${rev ? JSON.stringify(rev) : ""}))`,
  apply: ([rev]) => `bench.apply(bench.plan(${rev ? JSON.stringify(rev) : ""}))`,
  status: () => "print(bench.status())",
  measure: ([what]) => (what ? `print(bench.measure(${quoted(what)}))` : null),
  optimize: (goal) => (goal.length ? `print(bench.optimize(${goal.map(quoted).join(", ")}))` : null),
  set: ([part, ...pairs]) => (pairs.length ? `bench.set({${pairs.map((one) => given(one, `${part}.`)).join(", ")}})` : null),
  do: ([part, what, ...more]) => (part && what && !more.length ? `bench.do(${quoted(part)}, ${quoted(what)})` : null),
  capture: () => "bench.capture()",
  undo: () => "bench.apply(bench.recovery.undo_plan())",
  teleop: ([what]) => `with bench.teleop(${(what ?? "").split(".").map(quoted).join(", ")}) as jog:\n    print(jog.values)  # jog.step(NAME, BY) moves it`,
  run: ([name, ...pairs]) => (name
    ? `from pico.recipes.recipes import Recipes\n\nrecipes = Recipes(bench)\nmade = recipes.read(${quoted(name)})\nrecipes.run(made, recipes.begin(made, recipes.arguments(made, {${pairs.map((one) => texts(one)).join(", ")}})))`
    : null),
  runs: ([what, a, b]) => ({
    list: "for run, commit in bench.history.runs():\n    print(run.id, run.goal, run.outcome)",
    show: `run, commit = bench.history.recorded_run(${JSON.stringify(a ?? "")})\nprint(run)`,
    compare: `print(bench.history.compare_runs(${JSON.stringify(a ?? "")}, ${JSON.stringify(b ?? "")}))`,
    plot: `from pico.bench.picturing.plots import points_of\n\nrun, commit = bench.history.recorded_run(${JSON.stringify(a ?? "")})\nprint(points_of(bench.setup, run))`,
    pictures: `from pico.bench.picturing.kept import drawn, kept\n\nrun, commit = bench.history.recorded_run(${JSON.stringify(a ?? "")})\nfor one in kept(run):\n    picture = drawn(bench.history.folder, one).picture()  # (height, width, 3)`,
  } as Record<string, string>)[what ?? "list"] ?? null,
};

/** The same in Python, where a line of it does the same. */
export function python(words: string[]): string | null {
  const [command = "", ...rest] = words.filter((one) => one !== "--yes");
  const otherwise = ["set", "do", "move", "run", "optimize", "measure"].includes(command) && rest.some((one) => /^-/.test(one) && !/^-(p|-param|[\d.].*)$/.test(one));
  if (otherwise) return null; // such as `--manifest`, which moves nothing
  const said = KEPT[command]?.(rest.filter((one) => !/^-(?![\d.])/.test(one)));
  return said ? `import pico\n\nbench = pico.open(".")\n${said}` : null;
}

export function isPose(value: Value): value is Pose {
  return typeof value === "object" && value !== null;
}

export function number(value: number, digits = 3): string {
  return String(Number(value.toFixed(digits)));
}

/** A value as people read it: `(520, 420, 30°)`, `3 deg`, `storage/b2`. */
export function shown(value: Value, unit = ""): string {
  if (value === null || value === undefined) return "unknown";
  if (isPose(value)) return `(${number(value.x, 2)}, ${number(value.y, 2)}, ${number(value.yaw, 2)}°)`;
  if (typeof value === "number") return unit ? `${number(value)} ${unit}` : number(value);
  return String(value);
}

/** How long: `8.0 s`, `1 min 12 s`. */
export function seconds(value: number): string {
  if (value < 60) return `${value < 10 ? value.toFixed(1) : Math.round(value)} s`;
  const whole = Math.round(value);
  return `${Math.floor(whole / 60)} min ${whole % 60} s`;
}

/** Whether an operation takes notably longer than foretold, as reports have it; what light or a person takes is open. */
export function late(one: Operation, took: number): boolean {
  const open = ["optimize", "operator", "teleoperate"].includes(one.primitive) || one.reason.kind === "align" || (one.reason.kind === "interlock" && one.reason.of.length > 0);
  return one.seconds > 0 && !open && took > 1.5 * one.seconds + 2;
}

/** When, as this place has it: `26 Nov 09:03`. */
export function when(iso: string): string {
  return new Date(iso).toLocaleString(undefined, { day: "numeric", month: "short", hour: "2-digit", minute: "2-digit" });
}

/** What a run was for: `apply e1`, `p2.angle to 30 deg`. */
export function entitled({ cause, goal }: { cause: { kind: string }; goal: string }): string {
  return ["single", "teleoperation"].includes(cause.kind) ? goal : `${cause.kind} ${goal}`;
}
