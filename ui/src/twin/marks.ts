/** What is drawn over the bench: ghosts with numbers, outlines, beams, slots, the ruler. */

import {
  BufferGeometry, CanvasTexture, Color, CylinderGeometry, DoubleSide, Group, Line, LineBasicMaterial, LineDashedMaterial, Mesh,
  MeshBasicMaterial, Path, Quaternion, Shape as Outline, ShapeGeometry, Sprite, SpriteMaterial, SRGBColorSpace, Vector2, Vector3,
} from "three";
import { component } from "./building";
import type { Area, Beam, Component, Table } from "./scene";

export interface Ghost {
  part: number;
  x: number;
  y: number;
  /** Degrees, counter-clockwise from above. */
  yaw: number;
  label: string;
  tone: "to" | "from" | "staged" | "bad";
}

const TONES = { to: 0x1f8fff, from: 0x8a94a0, staged: 0xd98e04, bad: 0xe0413a };
/** The same below white words. */
const PLATES = { to: 0x0f6fd0, from: 0x66717d, staged: 0x9a6200, bad: 0xc4302a };

/** A part where it is to stand, with a number above. */
export function ghost(one: Ghost, part: Component, from: [number, number] | null, height: number): Group {
  const made = new Group();
  const model = component(part);
  model.name = "";
  const look = new MeshBasicMaterial({ color: TONES[one.tone], transparent: true, opacity: 0.34, depthWrite: false });
  model.traverse((mesh) => { if (mesh instanceof Mesh) { mesh.material = look; mesh.castShadow = false; } });
  model.position.set(one.x, one.y, part.position?.[2] ?? 0);
  model.rotation.z = (one.yaw * Math.PI) / 180;
  made.add(model);
  if (one.label) {
    const label = one.label.length > 3 ? tag(one.label, PLATES[one.tone]) : badge(one.label, PLATES[one.tone]);
    label.position.set(one.x, one.y, height);
    made.add(label);
  }
  if (from) {
    const line = new Line(
      new BufferGeometry().setFromPoints([new Vector3(...from, 4), new Vector3(one.x, one.y, 4)]),
      new LineDashedMaterial({ color: TONES[one.tone], dashSize: 12, gapSize: 8 }),
    );
    line.computeLineDistances();
    made.add(line);
  }
  return made;
}

/** A round badge that always faces who looks. */
export function badge(text: string, colour: number): Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = `#${new Color(colour).getHexString()}`;
  pen.beginPath();
  pen.arc(32, 32, 30, 0, 7);
  pen.fill();
  pen.fillStyle = "#fff";
  pen.font = `600 ${text.length > 2 ? 24 : 34}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, 32, 34);
  const made = new Sprite(new SpriteMaterial({ map: painted(canvas), depthTest: false, sizeAttenuation: false, toneMapped: false }));
  made.scale.setScalar(0.03);
  made.renderOrder = 10;
  return made;
}

/** Words on a plate that always faces who looks. */
export function tag(text: string, colour: number): Sprite {
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d")!;
  const font = "600 34px system-ui, sans-serif";
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + 32;
  canvas.height = 56;
  pen.fillStyle = `#${new Color(colour).getHexString()}`;
  pen.beginPath();
  pen.roundRect(0, 0, canvas.width, canvas.height, 14);
  pen.fill();
  Object.assign(pen, { fillStyle: "#fff", font, textAlign: "center", textBaseline: "middle" });
  pen.fillText(text, canvas.width / 2, 30);
  const made = new Sprite(new SpriteMaterial({ map: painted(canvas), depthTest: false, sizeAttenuation: false, toneMapped: false }));
  made.scale.set((0.026 * canvas.width) / canvas.height, 0.026, 1);
  made.renderOrder = 11;
  return made;
}

function painted(canvas: HTMLCanvasElement): CanvasTexture {
  const made = new CanvasTexture(canvas);
  made.colorSpace = SRGBColorSpace;
  return made;
}

/** A band around the footprint of a part. */
export function ring(part: Component, colour: number): Mesh {
  const { box } = part.footprint ?? {};
  const [width, depth] = box ?? [60, 60];
  const corners = (by: number) => (box ? rectangle(width + by, depth + by) : circle(30 + by / 2)).map(([x, y]) => new Vector2(x, y));
  const shape = new Outline(corners(18));
  shape.holes.push(new Path(corners(6)));
  const made = new Mesh(new ShapeGeometry(shape), new MeshBasicMaterial({ color: colour, toneMapped: false, transparent: true, depthTest: false, side: DoubleSide }));
  made.renderOrder = 9;
  return made;
}

export function circle(radius: number, steps = 64): [number, number][] {
  return Array.from({ length: steps }, (_, i) => {
    const angle = (2 * Math.PI * i) / steps;
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
}

/** A stretch of light, as wide as it must be to be seen and the wider the more power it carries. */
export function ray(beam: Beam, strongest: number): Mesh {
  const from = new Vector3(...beam.start), along = new Vector3(...beam.end).sub(from), length = along.length();
  const share = strongest > 0 ? Math.max(beam.power / strongest, 0) : 0;
  const [r, g, b] = beam.color;
  const look = new MeshBasicMaterial({
    color: new Color().setRGB(r, g, b, "srgb"), transparent: true, opacity: !beam.lit ? 0.22 : beam.ghost ? 0.3 : 0.4 + 0.55 * share, depthWrite: false,
  });
  const made = new Mesh(new CylinderGeometry(1, 1, length, 10, 1, true).scale(0.9 + 1.2 * share, 1, 0.9 + 1.2 * share), look);
  made.position.copy(from).addScaledVector(along, 0.5);
  made.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize()));
  return made;
}

/** A place for a part in storage, or another outline on the table. */
export function outline(points: [number, number][], colour: number, fill = 0): Group {
  const made = new Group();
  const closed = [...points, points[0]!].map(([x, y]) => new Vector3(x, y, 0.8));
  made.add(new Line(new BufferGeometry().setFromPoints(closed), new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.8 })));
  if (fill) {
    const shape = new Outline(points.map(([x, y]) => new Vector3(x, y, 0) as never));
    const look = new MeshBasicMaterial({ color: colour, transparent: true, opacity: fill, side: DoubleSide, depthWrite: false });
    const area = new Mesh(new ShapeGeometry(shape), look);
    area.position.z = 0.5;
    made.add(area);
  }
  return made;
}

export function rectangle(width: number, depth: number): [number, number][] {
  const x = width / 2, y = depth / 2;
  return [[-x, -y], [x, -y], [x, y], [-x, y]];
}

export function areaOutline({ x, y }: Area): [number, number][] {
  return [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
}

export function slotOutline(slot: Table["slots"][number]): [number, number][] {
  const c = Math.cos((slot.yaw * Math.PI) / 180), s = Math.sin((slot.yaw * Math.PI) / 180);
  return rectangle(64, 64).map(([x, y]) => [slot.x + x * c - y * s, slot.y + x * s + y * c]);
}
