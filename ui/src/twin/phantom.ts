/** The bench as it would be: translucent arms, and the parts that would stand elsewhere, beside what is there. */

import { Group, Mesh, MeshBasicMaterial, type Object3D } from "three";
import type { Frame } from "../live/frame";
import { ArmModel } from "./arm";
import { component, dropped, place } from "./building";
import type { Scene } from "./scene";

const ARM = new MeshBasicMaterial({ color: 0x1f8fff, transparent: true, opacity: 0.3, depthWrite: false });
const PART = new MeshBasicMaterial({ color: 0x1f8fff, transparent: true, opacity: 0.5, depthWrite: false });

export class Phantom {
  readonly root = new Group();
  readonly #arms = new Map<number, ArmModel>();
  readonly #parts = new Map<number, Group>();
  #epoch = 0;

  /** Show the arms and parts of a frame; none of them where it is null. */
  show(scene: Scene, frame: Frame | null): void {
    if (scene.epoch !== this.#epoch) this.clear();
    this.#epoch = scene.epoch;
    this.root.visible = frame !== null;
    if (!frame) return;
    for (const one of frame.arms) {
      const known = scene.arms.find((arm) => arm.index === one.index);
      if (known && !this.#arms.has(one.index)) this.#arms.set(one.index, this.#added(new ArmModel(known)));
      this.#arms.get(one.index)?.move(one.joints, one.gripper);
    }
    for (const group of this.#parts.values()) group.visible = false;
    for (const one of frame.bodies) {
      const known = scene.components.find((part) => part.index === one.index);
      if (!known) continue;
      let group = this.#parts.get(one.index);
      if (!group) {
        group = component(known);
        this.#parts.set(one.index, group);
        this.root.add(looking(group, PART));
      }
      group.visible = true;
      place(group, one.position, one.quaternion);
    }
  }

  clear(): void {
    for (const one of [...this.root.children]) dropped(one);
    this.#arms.clear();
    this.#parts.clear();
  }

  #added(model: ArmModel): ArmModel {
    this.root.add(looking(model.root, ARM));
    return model;
  }
}

function looking<T extends Object3D>(tree: T, look: MeshBasicMaterial): T {
  tree.name = "";
  tree.traverse((one) => {
    if (one instanceof Mesh) Object.assign(one, { material: look, castShadow: false, receiveShadow: false });
  });
  return tree;
}
