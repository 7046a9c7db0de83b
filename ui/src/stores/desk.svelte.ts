/** The checkout at the coordinator where the page has its commands run: what the page says is what one would type. */

import { ask, filled, lines, Refused, type Diagnostic } from "../api/client";
import type {
  BenchEvent, Diagnostics, Diff, Laser, Log, Plan, Report, Revision, RunDocument, Said, Status,
} from "../api/documents";
import { reel, type Frames, type Reel } from "../replay/frames";
import { bench } from "./bench.svelte";
import { asks, type Question } from "./recipes";
import { session } from "./session.svelte";
import { told } from "./told.svelte";

/** One step of what is under way. */
export interface Step { state: "waiting" | "going" | "done" | "failed" | "unknown"; fraction: number; phase: string; /** By the bench's clock [s]. */ began?: number; took?: number }

export interface Going {
  words: string[];
  /** What it is called among the desk's runs, and who began it where that is somebody else. */
  run: string | null;
  who: string | null;
  plan: Plan | null;
  events: BenchEvent[];
  /** What was said that is neither plan, event nor report. */
  said: Said[];
  steps: Record<string, Step>;
  report: Report | null;
  exit: number | null;
  diagnostics: Diagnostic[];
}

export interface Answer { said: Said[]; exit: number; diagnostics: Diagnostic[] }

/** Where this tab keeps what it began, to follow it after a reload. */
const KEPT = "pico-run";

interface DeskRun { id: string; who: string; bench: string; command: string; words: string[]; exit: number | null }

function none(): Going {
  return { words: [], run: null, who: null, plan: null, events: [], said: [], steps: {}, report: null, exit: null, diagnostics: [] };
}

class Desk {
  status = $state.raw<Status | null>(null);
  plan = $state.raw<Plan | null>(null);
  /** What would move in the plan, moment by moment. */
  ahead = $state.raw<Reel | null>(null);
  thinking = $state(false);
  #thought = 0;
  /** Of which words the plan is: `["plan", "e1"]`. */
  planned = $state<string[]>([]);
  log = $state.raw<Log | null>(null);
  diff = $state.raw<Diff | null>(null);
  runs = $state.raw<RunDocument[]>([]);
  /** What others began at the bench, and is in no commit here. */
  others = $state.raw<RunDocument[]>([]);
  lasers = $state.raw<Laser[]>([]);
  going = $state<Going | null>(null);
  /** What is wrong with the answer that was given last. */
  refused = $state<Diagnostic[]>([]);
  /** The question that was answered, until something is said after it. */
  #answered = $state("");
  /** The lines that were last written into the manifest. */
  patch = $state("");
  /** Commands that are under way. */
  busy = $state<string[]>([]);

  /** Run a command to its end, and return all that it said; `hears` gets each document when it comes. */
  async run(words: string[], hears: (said: Said) => void = () => undefined, begun: (run: string) => void = () => undefined): Promise<Answer> {
    const { path, rest } = asked(words);
    const answer: Answer = { said: [], exit: 1, diagnostics: [] };
    const shown = words.join(" ");
    this.busy = [...this.busy, shown];
    try {
      const body = { words: rest, session: bench.session, bench: bench.at.bench };
      for await (const said of lines<Said>("post", filled(path, { lab: bench.lab }), body, { begun })) {
        if ("exit" in said && !("schema" in said)) answer.exit = (said as { exit: number }).exit;
        else {
          answer.said.push(said);
          const found = (said as unknown as Diagnostics).diagnostics;
          if (found) answer.diagnostics.push(...found);
          hears(said);
        }
      }
    } catch (failure) {
      if (!(failure instanceof Refused)) throw failure;
      answer.diagnostics.push(...failure.diagnostics);
    } finally {
      const at = this.busy.indexOf(shown);
      this.busy = this.busy.filter((_, i) => i !== at);
    }
    return answer;
  }

  /** Run a command that says one document; tells what is wrong, and returns null where it says none. */
  async read<T extends { schema: string }>(schema: T["schema"], ...words: string[]): Promise<T | null> {
    const answer = await this.run(words);
    const found = answer.said.find((one) => "schema" in one && one.schema === schema) as unknown as T | undefined;
    if (!found) told.wrong(answer.diagnostics.filter((one) => one.severity === "error"));
    return found ?? null;
  }

  async look(): Promise<void> {
    this.status = (await this.read<Status>("pico.status/v1", "status")) ?? this.status;
  }

  async history(): Promise<void> {
    this.log = (await this.read<Log>("pico.log/v1", "log", "--graph", "--all")) ?? this.log;
  }

  async recorded(): Promise<void> {
    const found = await this.read<{ schema: "pico.runs/v1"; runs: { document: RunDocument }[]; others: { document: RunDocument }[] }>("pico.runs/v1", "runs", "list", "--all", "--others");
    if (!found) return;
    this.runs = found.runs.map((one) => one.document);
    this.others = found.others.map((one) => one.document);
  }

  /** Look at what lets lasers emit. */
  async lit(): Promise<void> {
    this.lasers = (await this.read<{ schema: "pico.lasers/v1"; lasers: Laser[] }>("pico.lasers/v1", "laser"))?.lasers ?? this.lasers;
  }

  async compare(from: string, to: string): Promise<void> {
    this.diff = await this.read<Diff>("pico.diff/v1", "diff", from, to);
  }

  async show(revision: string): Promise<Revision | null> {
    return this.read<Revision>("pico.revision/v1", "show", revision);
  }

  /** Plan; the plan is there as soon as it is made, and what would move when as soon as the ways are found. */
  async think(words: string[]): Promise<void> {
    this.planned = words;
    this.ahead = null;
    this.thinking = true;
    const number = ++this.#thought;
    const answer = await this.run([...words, "--frames"], (said) => {
      if (number !== this.#thought || !("schema" in said)) return;
      if (said.schema === "pico.plan/v1") {
        this.plan = said as unknown as Plan;
        this.thinking = false;
      } else if (said.schema === "pico.frames/v1") this.ahead = reel(said as unknown as Frames, 0);
    });
    if (number !== this.#thought) return;
    this.thinking = false;
    if (answer.said.some((one) => "schema" in one && one.schema === "pico.plan/v1")) return;
    this.plan = null;
    told.wrong(answer.diagnostics.filter((one) => one.severity === "error"));
  }

  /** Write into the manifest; returns whether that was done. */
  async wrote(words: string[]): Promise<boolean> {
    const found = await this.read<{ schema: "pico.capture/v1"; changes: unknown[]; patch: string }>("pico.capture/v1", ...words);
    if (!found) return false;
    if (!found.changes.length) told.say("The manifest says so already, within the tolerance.");
    this.patch = found.patch;
    await this.look();
    return true;
  }

  /** Run what changes files or history; returns whether it was done. */
  async did(words: string[]): Promise<boolean> {
    const answer = await this.run(words);
    told.wrong(answer.diagnostics.filter((one) => one.severity === "error"));
    this.patch = "";
    await Promise.all([this.look(), this.history(), ...(words[0] === "laser" ? [this.lit()] : [])]);
    return answer.exit === 0;
  }

  /** What is asked now by what is under way. */
  get question(): Question | null {
    const found = this.going && this.going.exit === null ? asks(this.going.said) : null;
    return found && `${this.going?.run} ${found.id}` !== this.#answered ? found : null;
  }

  /** Why one may not answer it; null where one may. */
  get mayAnswer(): string | null {
    if (!session.may("operator", bench.lab)) return "needs the role operator";
    const who = this.going?.who ?? session.me?.name;
    return who !== session.me?.name && !session.may("admin", bench.lab) ? `${who} began it, and answers it` : null;
  }

  /** Answer it, as one would at a terminal. */
  async answer(word: string): Promise<void> {
    const run = this.going?.run, { question } = this;
    if (!run || !question) return;
    this.refused = [];
    try {
      await ask("post", "/api/labs/{lab}/desk/runs/{run}/answers", { lab: bench.lab, run }, { question: question.id, answer: word });
      this.#answered = `${run} ${question.id}`;
    } catch (failure) {
      if (!(failure instanceof Refused)) throw failure;
      this.refused = failure.diagnostics;
    }
  }

  /** Cancel what is under way, as Ctrl-C would: nothing more starts, and a part in the hand is set down. */
  async cancel(): Promise<void> {
    const run = this.going?.run;
    if (run) await told.trying(() => ask("delete", "/api/labs/{lab}/desk/runs/{run}", { lab: bench.lab, run }));
    else await bench.halt();
  }

  /**
   * Follow what goes on at the desk for this bench, if something does, and what this tab had begun when it was
   * loaded anew, though that has ended meanwhile.
   */
  async follow(): Promise<void> {
    if (this.going && this.going.exit === null) return;
    const { runs } = await ask<{ runs: DeskRun[] }>("get", "/api/labs/{lab}/desk/runs", { lab: bench.lab });
    const mine = sessionStorage.getItem(KEPT);
    sessionStorage.removeItem(KEPT);
    const one = runs.find((each) => each.id === mine) ?? runs.find((each) => each.exit === null && [bench.name, bench.at.bench].includes(each.bench));
    if (!one || (this.going && this.going.exit === null)) return;
    this.going = { ...none(), words: [...one.command.split(" "), ...one.words], run: one.id, who: one.who };
    const live = this.going;
    try {
      for await (const said of lines<Said>("get", filled("/api/labs/{lab}/desk/runs/{run}/events", { lab: bench.lab, run: one.id }))) {
        if ("exit" in said && !("schema" in said)) live.exit = (said as { exit: number }).exit;
        else {
          live.diagnostics.push(...((said as unknown as Diagnostics).diagnostics ?? []));
          heard(live, said);
        }
      }
    } finally {
      live.exit ??= 1;
    }
    await Promise.all([this.look(), this.history(), this.recorded()]);
  }

  /** Run what moves the bench, and follow it. */
  async move(words: string[]): Promise<number> {
    this.going = { ...none(), words };
    const live = this.going; // the proxy that is watched
    const answer = await this.run(words, (said) => heard(live, said), (run) => { live.run = run; sessionStorage.setItem(KEPT, run); });
    sessionStorage.removeItem(KEPT);
    live.exit = answer.exit;
    live.diagnostics = answer.diagnostics;
    await Promise.all([this.look(), this.history(), this.recorded()]);
    return answer.exit;
  }
}

const TWO = ["catalog", "git", "laser", "recipe", "runs", "sim"];
/** Commands that are said alone, too. */
const ALONE = ["laser"];

/** Where words are said: a command of two words has two parts. */
export function asked(words: string[]): { path: string; rest: string[] } {
  const [first = "", second = "-"] = words;
  const count = TWO.includes(first) && !(ALONE.includes(first) && second.startsWith("-")) ? 2 : 1;
  return { path: `/api/labs/{lab}/desk/${words.slice(0, count).join("/")}`, rest: words.slice(count) };
}

/** Take in one document of a command that moves the bench. */
export function heard(going: Going, said: Said): void {
  if (!("schema" in said)) return;
  if (said.schema === "pico.plan/v1") {
    going.plan = said as unknown as Plan;
    for (const one of going.plan.operations) going.steps[one.id] = { state: "waiting", fraction: 0, phase: "" };
  } else if (said.schema === "pico.report/v1") going.report = said as unknown as Report;
  else if (said.schema === "pico.event/v1") {
    const event = said as unknown as BenchEvent;
    going.events.push(event);
    const step = event.operation ? (going.steps[event.operation] ??= { state: "waiting", fraction: 0, phase: "" }) : null;
    if (!step) return;
    if (event.kind === "operation_started") Object.assign(step, { state: "going", began: event.time });
    else if (event.kind === "operation_progress") {
      step.fraction = Number(event.data.fraction ?? 0);
      step.phase = String(event.data.phase ?? "");
      step.took = event.time - (step.began ?? event.time);
    } else if (event.kind === "operation_done") Object.assign(step, { state: "done", fraction: 1, phase: "" });
    else if (event.kind === "operation_failed") step.state = "failed";
    else if (event.kind === "operation_unknown") step.state = "unknown";
  } else {
    going.said.push(said);
    if (said.schema === "pico.question/v1") desk.refused = [];
  }
}

export const desk = new Desk();
