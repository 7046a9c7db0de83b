import { describe, expect, it } from "vitest";
import type { BenchEvent, Said } from "../src/api/documents";
import { sure, tried } from "../src/stores/goals";
import { asks, depth, given, recipeOf, rows, typedDefault, type Input } from "../src/stores/recipes";
import { lines, withSigma } from "../src/stores/seen";

const input = (name: string, usual: unknown): Input => ({ name, kind: "number", unit: "", default: usual, low: null, high: null, choices: [], description: "" });
const step = (event: "step" | "done", path: string, more: object = {}): Said => ({ schema: "pico.recipe_event/v1", event, path, ...more });

describe("a recipe", () => {
  it("is given what differs from its defaults", () => {
    expect(given([input("tilt", 30), input("tilts", [0, 15]), input("series", "a")], { tilt: "30", tilts: " [0] ", series: "" })).toEqual(["-p", "tilts=[0]"]);
    expect([typedDefault(null), typedDefault([0, 15]), typedDefault("a")]).toEqual(["", "[0,15]", "a"]);
  });
  it("has the steps that are known, and those that come up on the way, as far as they are", () => {
    const found = rows([{ path: "1", title: "checkout C1", known: true }, { path: "2", title: "set a", known: true }], [
      step("step", "1", { title: "checkout C1" }), step("done", "1", { result: { "": "at C1" } }), step("step", "2", { title: "set a: 3" }),
      step("step", "2?"), step("step", "3[2].1", { title: "move p2", turn: 2, turns: 5 }),
    ]);
    expect(found.map(({ path, state, said, turn }) => [path, state, said, turn])).toEqual([
      ["1", "done", "at C1", ""], ["2", "done", "", ""], ["3[2].1", "going", "", "2 of 5"]]);
    const loop = [step("step", "2", { title: "foreach" }), step("step", "2[1].1"), step("done", "2[1].1")];
    expect(rows([], loop).map(({ state }) => state)).toEqual(["going", "done"]);
    expect(rows([], [...loop, step("step", "3")]).map(({ state }) => state)).toEqual(["done", "done", "going"]);
    expect(rows([], loop, true).map(({ state }) => state)).toEqual(["done", "done"]);
    expect([depth("3[2].1"), depth("3")]).toEqual([1, 0]);
  });
});

describe("a question", () => {
  const asked: Said = { schema: "pico.question/v1", id: "q1", path: "2", text: "Read the meter.", unit: "mW" };
  it("is asked until anything is said after it", () => {
    expect(asks([step("step", "2"), asked])?.text).toBe("Read the meter.");
    expect(asks([asked, step("done", "2")])).toBe(null);
    expect(asks([])).toBe(null);
  });
  it("leaves its value and who answered at its step", () => {
    const said = [step("step", "1"), step("done", "1", { result: { by: "anna" } }), step("step", "2"), asked, step("done", "2", { result: { "": 0.4, by: "ben" } })];
    expect(rows([], said).map(({ said: told }) => told)).toEqual(["by anna", "0.4 mW, by ben"]);
  });
  it("is of the recipe that the words run", () => {
    expect([["run", "recipes/a.yaml", "-y"], ["run", "a"], ["run", "--resume"], ["apply", "a"]].map(recipeOf)).toEqual(["a", "a", "", ""]);
  });
});

describe("numbers", () => {
  it("are told as far as they are known", () => {
    expect(withSigma(-624.3105, 0.0201)).toBe("-624.311 ± 0.020");
    expect(withSigma(0.5, null)).toBe("0.5");
    expect(lines({ value: { x: 1, y: 2 }, sigma: { x: 0.1, y: 0.2 }, unit: "um, deg", unknown: "", kernel: "" }).map(({ name, unit }) => [name, unit])).toEqual([["x", "um"], ["y", "deg"]]);
    expect(sure({ a: 1, a_sigma: 0.1, b: 2 })).toEqual([{ name: "a", value: 1, sigma: 0.1 }, { name: "b", value: 2, sigma: null }]);
  });
  it("of a search are a row each", () => {
    const event = (data: object): BenchEvent => ({ schema: "pico.event/v1", run: "r", seq: 1, kind: "operation_progress", time: 0, data: data as Record<string, unknown> });
    expect(tried([event({ phase: "lift" }), event({ measured: 2, objective: { name: "from the goal", value: 3, best: 1 }, values: {} })])).toMatchObject([{ measured: 2, value: 3, best: 1 }]);
  });
});
