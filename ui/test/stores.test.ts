import { describe, expect, it } from "vitest";
import { filled, placed, Refused, split } from "../src/api/client";
import type { Operation, RunDocument, Status } from "../src/api/documents";
import { needs, type Known } from "../src/stores/attention";
import { mark, number, python, said, seconds, shown, sign, typed } from "../src/stores/say";
import { moved, stepped, tagged } from "../src/stores/moving";
import { edited, wrong } from "../src/stores/editing";
import { changed, type Scene, type Tunable } from "../src/twin/scene";
import { difference } from "../src/twin/ruler";

describe("words", () => {
  it("are typed as a shell takes them", () => {
    expect(typed(["plan", "e1"])).toBe("pico plan e1");
    expect(typed(["commit", "-m", "it's there"])).toBe("pico commit -m 'it'\\''s there'");
  });
  it("have a line of Python where one does the same", () => {
    expect(python(["plan", "e1"])).toContain('bench.plan("e1")');
    expect(python(["apply", "--yes"])).toContain("bench.apply(bench.plan())");
    expect(python(["log"])).toBeNull();
    expect(python(["set", "cam", "exposure=5", "--yes"])).toContain('bench.set({"cam.exposure": 5})');
    expect(python(["set", "laser", "shutter=open"])).toContain('bench.set({"laser.shutter": "open"})');
    expect(python(["set", "cam", "exposure=5", "--manifest"])).toBeNull();
    expect(python(["optimize", "centre", "ly_150", "cam"])).toContain('bench.optimize("centre", "ly_150", "cam")');
    expect(python(["teleop", "p2.pose"])).toContain('bench.teleop("p2", "pose")');
    expect(python(["run", "turning", "-p", "often=[1, 2]"])).toContain('recipes.arguments(made, {"often": "[1, 2]"})');
  });
  it("hold a message whatever it begins with", () => {
    expect([said(""), said("why"), said("-5 mm")]).toEqual([[], ["-m", "why"], ["--message=-5 mm"]]);
  });
  it("say where something is wrong", () => {
    const wrong = { severity: "error" as const, code: "yaml", summary: "no YAML" };
    expect(placed({ ...wrong, source: { path: "state/table.yaml", start: { line: 48, column: 3 } } })).toBe("state/table.yaml:48:3: no YAML");
    expect([placed(wrong), placed({ ...wrong, source: null })]).toEqual(["no YAML", "no YAML"]);
  });
  it("fill paths", () => {
    expect(filled("/api/labs/{lab}/desk", { lab: "a b", since: 3 })).toBe("/api/labs/a%20b/desk?since=3");
  });
});

describe("values", () => {
  it("are read as people write them", () => {
    expect(shown({ x: 520, y: 420, yaw: 30 })).toBe("(520, 420, 30°)");
    expect(shown(0.02, "ms")).toBe("0.02 ms");
    expect(shown(undefined)).toBe("unknown");
    expect(number(1 / 3)).toBe("0.333");
    expect([seconds(7.98), seconds(31.5), seconds(72)]).toEqual(["8.0 s", "32 s", "1 min 12 s"]);
    expect(difference([0, 0, 0], [3, 4, 0]).whole).toBe(5);
  });
});

describe("marks", () => {
  const one = (primitive: string, kind: string, from: object, to: object) => mark({ primitive, reason: { kind }, arguments: { from, to } } as unknown as Operation);
  it("are those of the commands", () => {
    const slot = { slot: "storage/a1" }, pose = { pose: { x: 1, y: 2, yaw: 0 } };
    expect([one("move", "changed", slot, pose), one("move", "changed", pose, slot), one("move", "changed", pose, pose)]).toEqual(["+", "-", "~"]);
    expect([one("move", "staged", pose, slot), one("park", "parked", {}, {}), one("operator", "operator", {}, {}), one("set", "changed", {}, {})]).toEqual(["↷", "·", "!", "~"]);
    expect(sign({ component: "p2", tunable: "pose", before: "storage/a1", after: { x: 1, y: 2, yaw: 0 }, text: "", tolerated: false })).toBe("+");
  });
});

describe("what needs attention", () => {
  const row = { component: "p2", tunable: "pose", edited: false, off: false, drifted: false, note: "" };
  const calm: Known = { status: null, scene: null, runs: [], line: "open", edge: "here", busy: false, asks: null };
  const status = (...rows: object[]) => ({ rows: rows.map((more) => ({ ...row, ...more })) }) as unknown as Status;
  it("is nothing where all is well", () => expect(needs({ ...calm, status: status({}) })).toEqual([]));
  it("is a recipe that waits for an answer, before what is only otherwise", () => {
    const found = needs({ ...calm, asks: "Put it in.", status: status({ off: true }) });
    expect(found.map((one) => [one.tone, one.to?.tab])).toEqual([["warn", "do"], ["warn", "plan"]]);
    expect(found[0]!.to?.query).toEqual({ act: "recipes" });
  });
  it("leads to where it is mended, the worst first", () => {
    const found = needs({
      ...calm, edge: "away",
      scene: { components: [{ name: "hwp", type: "waveplate", state: "lost" }] } as unknown as Scene,
      runs: [{ id: "r1", number: 3, outcome: "failed", goal: "e1", cause: { kind: "apply" } }] as unknown as RunDocument[],
      status: status({ off: true, drifted: true }, { tunable: "angle", off: true, desired: { null_of: ["a", "b"] } }, { component: "p1", tunable: "angle", edited: true, off: true }),
    });
    expect(found.map((one) => [one.tone, one.to?.tab ?? null])).toEqual([
      ["bad", null], ["bad", "inspect"], ["bad", "runs"], ["warn", "plan"], ["warn", "plan"], ["warn", "plan"], ["warn", "inspect"],
    ]);
    expect(found.at(-1)!.text).toBe("1 edit in no commit: p1.angle");
    const held = { ...calm, scene: { components: [{ name: "p2", type: "polarizer", state: "held", held_by: "arm1" }] } as unknown as Scene };
    expect(needs(held).map((one) => one.text)).toEqual(["arm1 holds p2, and nothing goes on"]);
    expect(needs({ ...held, busy: true })).toEqual([]);
    expect(found[3]!.text).toMatch(/^1 goal found by light is not reached any more: p2.angle/);
  });
});

describe("light that the guard ended", () => {
  const calm: Known = { status: null, scene: null, runs: [], line: "open", edge: "here", busy: false, asks: null };
  const shut = { severity: "warning" as const, code: "guard", summary: "guard: light of laser was ended at 14:02:03 because door_box (door) is not safe", detail: "dark now: laser.shutter", hint: "make the table safe, then let light out anew" };
  const scene = { components: [], beams: [], rev: 3 } as unknown as Scene;
  it("is told with why, what is dark and what to do, as soon as the stream tells it", () => {
    const now = changed(scene, { kind: "guard", rev: 4, data: { notices: [shut] } });
    expect(needs({ ...calm, scene: now })).toEqual([{ tone: "bad", text: shut.summary, detail: shut.detail, mend: shut.hint, to: null }]);
    const over = changed(now, { kind: "guard", rev: 5, data: { notices: [] } });
    expect([over.rev, needs({ ...calm, scene: over, status: { rows: [], cut_short: [shut] } as unknown as Status })]).toEqual([5, []]);
  });
  it("is told by the status where the stream says nothing of a guard, and once", () => {
    const status = { rows: [], cut_short: [shut] } as unknown as Status;
    expect(needs({ ...calm, status, scene }).map((one) => one.text)).toEqual([shut.summary]);
    expect(needs({ ...calm, status, scene: { ...scene, guard: [shut] } })).toHaveLength(1);
  });
  it("stands beside a run that was cut short, a device that can't be used, and no note", () => {
    const killed = { severity: "warning", code: "cut-short", summary: "run r1 was killed", hint: "`pico resume` takes the run up again" };
    const also = [{ ...killed, code: "goes-on" }, { ...killed, severity: "note", code: "dose" }, { ...killed, code: "table-lock", summary: "ada locked the bench", hint: "`pico lease unlock`" }];
    const status = { rows: [], cut_short: [shut, killed, ...also], lacking: [{ ...killed, code: "driver", summary: "pm can't be used", hint: "install it" }] } as unknown as Status;
    const runs = [{ id: "r1", number: 3, outcome: "interrupted", goal: "e1", cause: { kind: "apply" } }] as unknown as RunDocument[];
    expect(needs({ ...calm, status, runs }).map((one) => [one.tone, one.text, one.to?.query.run ?? one.mend])).toEqual([
      ["bad", shut.summary, shut.hint], ["bad", "run r1 was killed", "r1"], ["bad", "ada locked the bench", "`pico lease unlock`"], ["warn", "pm can't be used", "install it"],
    ]);
  });
});

describe("what is moved by hand", () => {
  const holes = { pitch: 25, first: [12.5, 12.5] } as never;
  it("ends at a hole, or at a tenth", () => {
    expect(stepped({ x: 26, y: 40, yaw: 370 }, holes)).toEqual({ x: 37.5, y: 37.5, yaw: 10 });
    expect(stepped({ x: 26.04, y: -0.01, yaw: -180 }, null)).toMatchObject({ x: 26, yaw: 180 });
  });
  it("is the command that writes it", () => {
    expect(moved("p2", { x: 500, y: 420.5, yaw: -15 })).toEqual(["move", "p2", "x=500", "y=420.5", "yaw=-15", "--manifest"]);
    expect(tagged({ x: 500, y: 420.5, yaw: -15 })).toBe("x 500.0  y 420.5 mm  -15.0°");
  });
});

describe("lines", () => {
  it("are read also where they come in pieces", async () => {
    const bytes = new TextEncoder().encode('{"a":"°"}\n\n{"b":2}');
    const stream = new ReadableStream<Uint8Array>({
      start(controller) {
        for (const byte of bytes) controller.enqueue(Uint8Array.of(byte));
        controller.close();
      },
    });
    const found = [];
    for await (const one of split(stream)) found.push(one);
    expect(found).toEqual([{ a: "°" }, { b: 2 }]);
  });
  it("end as a refusal where the coordinator is lost, and as it is where nobody listens any more", async () => {
    const broken = (why: unknown): ReadableStream<Uint8Array> => new ReadableStream({ pull: (control) => control.error(why) });
    await expect(split(broken(new TypeError("network error"))).next()).rejects.toBeInstanceOf(Refused);
    await expect(split(broken(new DOMException("", "AbortError"))).next()).rejects.not.toBeInstanceOf(Refused);
  });
});

describe("the scene", () => {
  const scene = { epoch: 1, rev: 0, components: [{ index: 0, name: "p2", state: "seen" }], beams: [] } as unknown as Scene;
  it("takes in what changed of a component, and new ones", () => {
    const held = changed(scene, { kind: "component", rev: 1, data: { index: 0, state: "held" } });
    expect(held.components[0]).toMatchObject({ name: "p2", state: "held" });
    expect(scene.components[0]!.state).toBe("seen");
    expect(changed(held, { kind: "component", rev: 2, data: { index: 5, name: "unknown/9" } }).components).toHaveLength(2);
    expect(changed(scene, { kind: "beams", rev: 3, data: { beams: [{}] } })).toMatchObject({ rev: 3, beams: [{}] });
  });
});


describe("fields", () => {
  const kind = { datatype: "float", unit: "ms", range: [0.02, 1000], choices: [] } as unknown as Tunable;
  it("are looked at as they are typed", () => {
    expect([wrong("10", kind), wrong("0,5", kind), wrong("", kind), wrong("x", undefined)]).toEqual([null, null, "a number is wanted", "a number is wanted"]);
    expect(wrong("2000", kind)).toBe("2000 is beyond 0.02 to 1000 ms");
  });
  it("become the command that writes them", () => {
    expect(edited("cam", "exposure", { value: " 0,5" })).toEqual(["set", "cam", "exposure=0.5", "--manifest"]);
    expect(edited("p2", "pose", { x: "1", y: "2", yaw: "3" })).toEqual(["move", "p2", "x=1", "y=2", "yaw=3", "--manifest"]);
  });
});
