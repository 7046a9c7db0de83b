import { describe, expect, it } from "vitest";
import { at, doneAt, phaseAt, reel, sceneAt, stepped, telling, translated, turned, type Frames } from "../src/replay/frames";
import { filtered, kept, late, measured, paths, type OperationRun, type Search } from "../src/replay/recorded";
import { decades, roomy, told } from "../src/parts/plotting";
import { FAR, Playing } from "../src/live/playing";
import type { Frame } from "../src/live/frame";
import { named } from "../src/stores/shown.svelte";
import type { Component, Scene } from "../src/twin/scene";
import type { RunDocument } from "../src/api/documents";

const part = (index: number, name: string, x: number) =>
  ({ index, name, type: "mirror", state: "seen", position: [x, 0, 0], quaternion: [1, 0, 0, 0], bodies: [], values: {}, tunables: {} }) as unknown as Component;
const scene = (components: Component[]) =>
  ({ schema: "pico.scene/v1", lab: "shel", epoch: 0, rev: 0, time: 0, table: { size: [1200, 750] }, arms: [{ index: 0, name: "arm1", joints: [0, 1], width: 80, links: [] }], components, beams: [] }) as unknown as Scene;
const half = Math.SQRT1_2;
const FRAMES: Frames = {
  schema: "pico.frames/v1", run: "r1", number: 1, goal: "e1", origin: "reconstructed", evidence: "kinematic", seconds: 10,
  scene: scene([part(0, "m1", 100), part(1, "m2", 200)]),
  steps: [
    { operation: "op1", attempt: 1, primitive: "move", component: "m1", address: "m1", robot: "arm1", start: 0, seconds: 6, outcome: "done" },
    { operation: "op2", attempt: 1, primitive: "set", component: "m2", address: "m2.tip", start: 6, seconds: 4, outcome: "done" },
  ],
  moved: [
    { time: 0, arms: [[0, [0, 1], 80]], bodies: [] },
    { time: 2, arms: [[0, [1, 1], 40]], bodies: [[0, 100, 0, 0, 1, 0, 0, 0]] },
    { time: 4, arms: [[0, [3, 1], 40]], bodies: [[0, 300, 0, 50, half, 0, 0, half]] },
  ],
  told: [
    { time: 2, kind: "component", rev: 1, data: { index: 0, name: "m1", state: "held" } },
    { time: 4, kind: "component", rev: 2, data: { index: 0, name: "m1", state: "seen" } },
    { time: 4, kind: "beams", rev: 3, data: { beams: [{ lit: true }] } },
  ],
  phases: [[0, "arm1", "approach"], [2, "arm1", "lift"], [3, "arm1", "transit"], [4, "arm1", "lower"]],
  diagnostics: [],
};
const film = reel(FRAMES, -1);
const bodyOf = (time: number, index: number) => at(film, time).bodies.find((one) => one.index === index)!;

describe("a replay", () => {
  it("goes straight from key to key, and stays before the first and after the last", () => {
    expect([...at(film, 1).arms[0]!.joints]).toEqual([0.5, 1]);
    expect(at(film, 1).arms[0]!.gripper).toBe(60);
    expect([...at(film, 3).arms[0]!.joints]).toEqual([2, 1]);
    expect(bodyOf(1, 0).position).toEqual([100, 0, 0]);
    expect(bodyOf(3, 0).position).toEqual([200, 0, 25]);
    expect(bodyOf(99, 0).position).toEqual([300, 0, 50]);
    expect(bodyOf(3, 1).position).toEqual([200, 0, 0]);
  });
  it("turns the short way round, and keeps quaternions of length one", () => {
    const found = bodyOf(3, 0).quaternion;
    expect(found[3]).toBeCloseTo(Math.sin(Math.PI / 8), 6);
    expect(Math.hypot(...turned([1, 0, 0, 0], [-half, 0, 0, -half], 0.5))).toBeCloseTo(1, 9);
    expect(turned([1, 0, 0, 0], [-half, 0, 0, -half], 0.5)[0]).toBeGreaterThan(0.9);
  });
  it("knows how components stand at a time, whichever way one goes in it", () => {
    const state = (time: number) => sceneAt(film, time).components[0]!.state;
    expect([state(0), state(2), state(3.9), state(4), state(1)]).toEqual(["seen", "held", "held", "seen", "seen"]);
    expect(sceneAt(film, 4).beams).toHaveLength(1);
    expect(sceneAt(film, 3).epoch).toBe(-1);
    expect(FRAMES.scene.epoch).toBe(0);
  });
  it("goes step by step", () => {
    expect([stepped(FRAMES, 0, 1), stepped(FRAMES, 6, 1), stepped(FRAMES, 10, 1)]).toEqual([6, 10, 10]);
    expect([stepped(FRAMES, 10, -1), stepped(FRAMES, 5, -1), stepped(FRAMES, 0, -1)]).toEqual([6, 0, 0]);
  });
  it("says what is done, and shows a move with the part in the hand", () => {
    expect(doneAt(FRAMES, 6).map((one) => one.address)).toEqual(["m2.tip"]);
    expect(phaseAt(FRAMES, "arm1", 3.5)).toBe("transit");
    expect([telling(FRAMES, "op1"), telling(FRAMES, "op2"), telling(FRAMES, "op9")]).toEqual([3.5, 10, null]);
  });
  it("is shown over another scene by names, and only what is elsewhere in it", () => {
    const live = scene([part(7, "m2", 200), part(8, "m1", 100)]);
    const frame = translated(film, 4, live);
    expect(frame.bodies.map((one) => one.index)).toEqual([8]);
    expect(frame.arms.map((one) => one.index)).toEqual([0]);
    expect(translated(film, 0, live).bodies).toEqual([]);
  });
});

const frame = (time: number, joint: number, epoch = 5): Frame => ({ epoch, rev: 0, time, arms: [{ index: 0, joints: Float32Array.of(joint), gripper: 0 }], bodies: [] });
const joint = (playing: Playing, now: number) => playing.at(now).arms[0]!.joints[0]!;

describe("a live bench", () => {
  it("glides from frame to frame, and never beyond the newest", () => {
    const playing = new Playing();
    playing.push(frame(0, 0), 1000);
    expect(joint(playing, 1000)).toBe(0);
    playing.push(frame(0.5, 1), 1100);
    expect(joint(playing, 1150)).toBeCloseTo(0.5, 6);
    expect(playing.over(1150)).toBe(false);
    expect([joint(playing, 1200), joint(playing, 9000), playing.over(1200)]).toEqual([1, 1, true]);
  });
  it("goes on from where it is shown when the next one comes early", () => {
    const playing = new Playing();
    playing.push(frame(0, 0), 1000);
    playing.push(frame(0.5, 1), 1100);
    playing.push(frame(1, 3), 1150);
    expect(joint(playing, 1150)).toBeCloseTo(0.5, 6);
    expect(joint(playing, 1200)).toBe(3);
  });
  it("shows only what moves, or was told last, unless all is asked for", () => {
    const playing = new Playing();
    playing.push({ ...frame(0, 0), bodies: [{ index: 3, position: [1, 2, 3], quaternion: [1, 0, 0, 0] }] }, 1000);
    expect(playing.at(1000).bodies).toHaveLength(1);
    playing.push(frame(0.1, 1), 1100);
    expect(playing.at(1150).bodies).toEqual([]);
    expect(playing.at(1150, true).bodies[0]!.position).toEqual([1, 2, 3]);
  });
  it("jumps where nobody knows the way", () => {
    const playing = new Playing();
    playing.push(frame(0, 0), 1000);
    playing.push(frame(FAR + 0.1, 1), 1100);
    expect(joint(playing, 1100)).toBe(1);
    playing.push(frame(FAR + 0.2, 2, 6), 1200);
    expect([joint(playing, 1200), playing.at(1200).epoch]).toEqual([2, 6]);
  });
});

describe("what is wrong with a plan", () => {
  it("is about all the components that it names", () => {
    const live = scene([part(0, "p1", 0), part(1, "p2", 0), part(2, "p", 0)]);
    const wrong = { severity: "error" as const, code: "overlap", summary: "p2 at (1, 2, 0°) would overlap p1 by 5 mm", address: "p2.pose" };
    expect(named([wrong], live)).toEqual(["p1", "p2"]);
  });
});

describe("runs", () => {
  const run = (id: string, goal: string, evidence: string) => ({ id, number: 1, goal, evidence, cause: { kind: "apply" }, operator: "ann", outcome: "done", changes: [{ component: "p2", tunable: "angle" }] }) as unknown as RunDocument;
  const all = [run("a", "e1", "kinematic"), run("b", "e2", "hardware")];
  it("are found by words and by evidence", () => {
    expect(filtered(all, "apply E2", "").map((one) => one.id)).toEqual(["b"]);
    expect(filtered(all, "p2.angle", "kinematic").map((one) => one.id)).toEqual(["a"]);
    expect(filtered(all, "e1", "hardware")).toEqual([]);
  });
  it("say what was measured, and how much later than planned", () => {
    const of = { component: "cam", measurable: "power" };
    expect(measured(of, [{ name: "", value: 1.23456789, sigma: 0.0123, unit: "mW" }])).toBe("1.235 ± 0.012 mW");
    expect(measured(of, [{ name: "x", value: 3, sigma: null, unit: "um" }, { name: "round", value: 0.5, sigma: null, unit: "1" }])).toBe("x 3 um, round 0.5");
    expect(measured({ ...of, unknown: "no light" })).toBe("unknown: no light");
    expect(measured({ ...of, array: { sha256: "ab", shape: [2, 2] } })).toBe("an image");
    const operation = { seconds: 9.3, planned: 8 } as OperationRun;
    expect([late(operation), late({ ...operation, seconds: 8.01 }), late({ ...operation, planned: null })]).toEqual(["+1.3 s", "", ""]);
  });
});

describe("what a run kept", () => {
  const array = (sha256: string) => ({ sha256, shape: [2, 2] });
  it("is found in what was measured, and in each goal that was sought", () => {
    const operations = [
      { data: { measurement: { component: "cam", measurable: "image", array: array("a") } } }, { data: {} },
      { data: { stages: [{ points: array("b") }, {}], points: array("c") } },
    ] as unknown as OperationRun[];
    expect(kept(operations).map((one) => one.sha256)).toEqual(["a", "b", "c"]);
  });
  it("has the ways of tunables by unit, four in a plot, and gaps where nothing was", () => {
    const tunables = [..."abcde"].map((name) => ({ name, unit: "mm", range: [0, 1] })).concat({ name: "t", unit: "deg", range: [0, 1] });
    const found = paths({ tunables, rows: [{ values: { a: 1, t: 2 } }, { values: { a: 2 } }] } as unknown as Search);
    expect(found.map((one) => [one.name, one.unit, one.series.length])).toEqual([["tunables", "mm", 4], ["e", "mm", 1], ["t", "deg", 1]]);
    expect(found[0]!.series[0]!.values).toEqual([1, 2]);
    expect(found[2]!.series[0]!.values).toEqual([2, null]);
  });
});

describe("a plot", () => {
  it("has room for bars and for what is to be reached", () => {
    const [low, high] = roomy([{ name: "x", values: [1, null, 3], sigmas: [2, null, 0.5] }], [5]);
    expect(low).toBeLessThan(-1);
    expect(high).toBeGreaterThan(5);
    expect(roomy([{ name: "x", values: [] }])).toEqual([0, 1]);
    expect(roomy([{ name: "x", values: [4] }])).toEqual([3.6, 4.4]);
  });
  it("goes by powers of ten where numbers range over several, and all are positive", () => {
    const of = (...values: (number | null)[]) => [{ name: "x", values }];
    expect(decades(of(124, null, 0.02))).toEqual([0.01, 1000]);
    expect(decades(of(20), [0, 0.5])).toEqual([0.1, 100]);
    expect(decades(of(2, 4))).toBeNull();
    expect(decades(of(124, 0))).toBeNull();
  });
  it("is told in words with the last number that there is", () => {
    expect(told([1, 2], [{ name: "x", values: [1.23456, null], sigmas: [0.02, null] }])).toBe("2 points; x last 1.2346 ± 0.02");
  });
});
