import { describe, expect, it } from "vitest";
import { decimals, Hand, rung, stopped, type Heard } from "../src/stores/teleop";

const heard = (more: Partial<Heard>): Heard => ({ clock: 0, refused: "", phase: "ready", values: {}, steps: 0, missed: 0, limit: "", stopped: "", ...more });

describe("a hand on a key", () => {
  it("counts presses and frames, and says when the edge was heard last", () => {
    const hand = new Hand();
    expect(hand.frame()).toMatchObject({ seq: 1, press: 0, tunable: "", by: 0 });
    hand.heard(heard({ clock: 7 }));
    expect(hand.hold("angle", 0.5)).toEqual({ seq: 2, seen: 7, press: 1, tunable: "angle", by: 0.5, release: false, end: false });
    expect(hand.frame()).toMatchObject({ seq: 3, press: 1 });
    expect(hand.release()).toMatchObject({ seq: 4, press: 0, tunable: "", release: true });
    expect(hand.frame()).toMatchObject({ press: 0 });
    expect(hand.hold("angle", -0.5)).toMatchObject({ press: 2, by: -0.5 });
    expect(hand.frame(true)).toMatchObject({ press: 0, end: true });
  });
  it("goes on with no press that the edge refused", () => {
    const hand = new Hand();
    hand.hold("angle", 1);
    hand.heard(heard({ steps: 1 }));
    expect(hand.frame().press).toBe(1);
    hand.heard(heard({ missed: 1 }));
    expect(hand.frame().press).toBe(0);
    hand.hold("angle", 1);
    hand.heard(heard({ missed: 1 }));
    expect(hand.frame().press).toBe(2);
    hand.heard(heard({ missed: 1, refused: "late" }));
    expect(hand.held).toBeNull();
  });
  it("is told why nothing moves", () => {
    expect(stopped(heard({ stopped: "silent" }))).toContain("heard nothing");
    expect(stopped(heard({ stopped: "refused", limit: "angle ends at 5 deg" }))).toBe("angle ends at 5 deg");
  });
});

describe("steps", () => {
  it("are chosen one by one, and values shown as far as they change", () => {
    expect(rung([0.1, 0.2, 0.5], 0.2, 1)).toBe(0.5);
    expect(rung([0.1, 0.2, 0.5], 0.5, 1)).toBe(0.5);
    expect(rung([0.1, 0.2, 0.5], 0.1, -1)).toBe(0.1);
    expect([decimals(30.5, 0.1), decimals(3, 5), decimals(undefined, 1), decimals(0.00012, 1e-5)]).toEqual(["30.5", "3", "?", "0.00012"]);
  });
});
