/** Shapes of the scene as meshes. */

import {
  BoxGeometry, CapsuleGeometry, Color, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3,
  type BufferGeometry, type Object3D,
} from "three";
import type { Body, Colour, Component, LinkShape, Quat, Vec } from "./scene";

const materials = new Map<string, MeshStandardMaterial>();
const UP = new Vector3(0, 1, 0);

function material([r, g, b, a = 1]: Colour): MeshStandardMaterial {
  const key = [r, g, b, a].join();
  let found = materials.get(key);
  if (!found) {
    found = new MeshStandardMaterial({ color: new Color().setRGB(r, g, b, "srgb"), roughness: 0.55, metalness: 0.1 });
    if (a < 1) Object.assign(found, { transparent: true, opacity: Math.max(a, 0.3), depthWrite: false });
    materials.set(key, found);
  }
  return found;
}

export function place(object: Object3D, position: Vec, [w, x, y, z]: Quat): void {
  object.position.set(...position);
  object.quaternion.set(x, y, z, w);
}

function mesh(geometry: BufferGeometry, color: Colour): Mesh {
  const made = new Mesh(geometry, material(color));
  made.castShadow = made.receiveShadow = true;
  return made;
}

/** A part of a link of an arm. */
export function linkPart(shape: LinkShape): Mesh {
  if (shape.shape === "box") {
    const made = mesh(new BoxGeometry(...shape.size), shape.color);
    made.position.set(...shape.at);
    return made;
  }
  const a = new Vector3(...shape.a), along = new Vector3(...shape.b).sub(a), length = along.length();
  const geometry = shape.shape === "capsule" ? new CapsuleGeometry(shape.radius, length, 6, 20) : new CylinderGeometry(shape.radius, shape.radius, length, 28);
  const made = mesh(geometry, shape.color);
  made.position.copy(a).addScaledVector(along, 0.5);
  if (length > 0) made.quaternion.copy(new Quaternion().setFromUnitVectors(UP, along.normalize()));
  return made;
}

function bodyPart(body: Body, shift: number): Mesh {
  const [a = 1, b = 1, c = 1] = body.size;
  const geometry = body.shape === "box" ? new BoxGeometry(a, b, c) : new CylinderGeometry(a / 2, a / 2, b, 32).rotateX(Math.PI / 2);
  const made = mesh(geometry, body.color);
  place(made, body.at, body.quaternion);
  const axis = body.rides?.at(-1);
  if (axis === "x" || axis === "y" || axis === "z") made.position[axis] += shift;
  return made;
}

/** A component in its own frame. */
export function component(one: Component): Group {
  const made = new Group();
  made.name = one.name;
  made.add(...one.bodies.map((body) => bodyPart(body, (body.rides && one.stages?.[body.rides]) || 0)));
  return made;
}

/** Let go of what a tree of objects holds on the graphics card. */
export function dropped(tree: Object3D): void {
  tree.traverse((one) => {
    if (one instanceof Mesh) (one.geometry as BufferGeometry).dispose();
  });
  tree.removeFromParent();
}
