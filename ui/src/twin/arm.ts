/** An arm by its joint angles: forward kinematics as a tree of groups. */

import { Group, Quaternion, Vector3 } from "three";
import { linkPart, place } from "./building";
import type { Arm, Link } from "./scene";

interface Driven { group: Group; drive: number | "width"; at: Vector3; turned: Quaternion; axis: Vector3; kind: Link["kind"]; factor: number }

export class ArmModel {
  readonly root = new Group();
  readonly #driven: Driven[] = [];

  constructor(arm: Arm) {
    this.root.name = arm.name;
    const { x, y, z, yaw } = arm.mount;
    this.root.position.set(x, y, z);
    this.root.rotation.z = (yaw * Math.PI) / 180;
    const links: Group[] = [];
    for (const link of arm.links) {
      const group = new Group();
      group.add(...link.shapes.map(linkPart));
      place(group, link.origin, link.quaternion);
      (link.parent === null ? this.root : links[link.parent]!).add(group);
      links.push(group);
      if (link.drive === null || !link.axis) continue;
      this.#driven.push({
        group, drive: link.drive, at: group.position.clone(), turned: group.quaternion.clone(),
        axis: new Vector3(...link.axis), kind: link.kind, factor: link.factor ?? 1,
      });
    }
    this.move(arm.joints, arm.width);
  }

  /** Stand as the joints say [rad, or m of what slides], the fingers so far apart [mm]. */
  move(joints: ArrayLike<number>, width: number): void {
    const turn = new Quaternion();
    for (const { group, drive, at, turned, axis, kind, factor } of this.#driven) {
      const value = drive === "width" ? width : (joints[drive] ?? 0);
      if (kind === "slides") group.position.copy(at).add(axis.clone().multiplyScalar(value * factor).applyQuaternion(turned));
      else group.quaternion.copy(turned).multiply(turn.setFromAxisAngle(axis, value));
    }
  }
}
