import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { decode } from "../src/live/frame";

interface Golden { name: string; epoch: number; rev: number; time: number; arms: [number, number[], number][]; bodies: number[][]; hex: string }
const GOLDEN: Golden[] = JSON.parse(readFileSync(new URL("../../tests/server/frames.json", import.meta.url), "utf8"));

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

  it.each(GOLDEN)("are read as the coordinator writes them: $name", ({ epoch, rev, time, arms, bodies, hex }) => {
    const bytes = Uint8Array.from(hex.match(/../g) ?? [], (pair) => parseInt(pair, 16));
    const found = decode(bytes.buffer);
    expect(found).toMatchObject({ epoch, rev, time });
    expect(found.arms).toEqual(
      arms.map(([index, joints, width]) => ({ index, joints: Float32Array.from(joints), gripper: Math.fround(width) })),
    );
    expect(found.bodies).toEqual(
      bodies.map(([index, ...numbers]) => {
        const [x, y, z, ...turned] = numbers.map(Math.fround);
        return { index, position: [x, y, z], quaternion: turned };
      }),
    );
  });
});
