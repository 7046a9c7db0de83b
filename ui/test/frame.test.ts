import { existsSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { decode } from "../src/live/frame";

const GOLDEN = new URL("../../tests/server/frames.json", import.meta.url);

describe("frames", () => {
  it("reads arms and bodies", () => {
    const bytes = new DataView(new ArrayBuffer(1 + 4 + 4 + 8 + 1 + 2 + 8 + 4 + 2 + 2 + 28));
    let at = 0;
    const put = (kind: "Uint8" | "Uint16" | "Uint32" | "Float32" | "Float64", value: number, size: number) => {
      bytes[`set${kind}`](at, value, true);
      at += size;
    };
    put("Uint8", 1, 1); put("Uint32", 7, 4); put("Uint32", 9, 4); put("Float64", 1.25, 8);
    put("Uint8", 1, 1); put("Uint8", 3, 1); put("Uint8", 2, 1); put("Float32", 0.5, 4); put("Float32", -2, 4); put("Float32", 84, 4);
    put("Uint16", 1, 2); put("Uint16", 300, 2);
    for (const value of [1, 2, 3, 1, 0, 0, 0]) put("Float32", value, 4);
    expect(decode(bytes.buffer)).toEqual({
      epoch: 7, rev: 9, time: 1.25,
      arms: [{ index: 3, joints: Float32Array.of(0.5, -2), gripper: 84 }],
      bodies: [{ index: 300, position: [1, 2, 3], quaternion: [1, 0, 0, 0] }],
    });
  });

  it("takes nothing that is cut short, too long or of another version", () => {
    const bytes = new Uint8Array(20);
    bytes[0] = 1;
    expect(decode(bytes.buffer).bodies).toEqual([]);
    expect(() => decode(bytes.slice(0, 19).buffer)).toThrow(RangeError);
    expect(() => decode(new Uint8Array([...bytes, 0]).buffer)).toThrow("1 bytes too many");
    bytes[0] = 2;
    expect(() => decode(bytes.buffer)).toThrow("version 2");
  });

  it.skipIf(!existsSync(GOLDEN))("agrees with what the coordinator writes", () => {
    const golden = JSON.parse(readFileSync(GOLDEN, "utf8"));
    expect(golden.length ?? Object.keys(golden).length).toBeGreaterThan(0);
  });
});
