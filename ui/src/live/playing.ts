/**
 * Lets a bench glide from one frame to the next: nothing is shown that is not straight between two frames that were
 * told, and nothing later than the newest. A kinematic run passes faster than it is told, and would jump.
 */

import { mixed, turned } from "../replay/frames";
import type { ArmPose, BodyPose, Frame } from "./frame";

/** Seconds of the bench's clock between two frames between which nobody knows the way any more: then it jumps. */
export const FAR = 1.5;
/** Milliseconds in which one frame becomes the next: as long as they were apart when they came, within these. */
const LEAST = 16, MOST = 150;

interface Motion<T> { from: T; to: T }

export class Playing {
  #arms = new Map<number, Motion<ArmPose>>();
  #bodies = new Map<number, Motion<BodyPose>>();
  #latest: Frame | null = null;
  #came = 0;
  #lasts = 0;

  /** Take a frame in that came now [ms]. */
  push(frame: Frame, now: number): void {
    const before = this.#latest;
    const far = before === null || before.epoch !== frame.epoch || Math.abs(frame.time - before.time) > FAR;
    if (before && before.epoch !== frame.epoch) { this.#arms.clear(); this.#bodies.clear(); }
    const share = this.#share(now);
    for (const [index, one] of this.#arms) this.#arms.set(index, { from: arm(one, share), to: one.to });
    for (const [index, one] of this.#bodies) this.#bodies.set(index, { from: body(one, share), to: one.to });
    for (const to of frame.arms) this.#arms.set(to.index, { from: (!far && this.#arms.get(to.index)?.from) || to, to });
    for (const to of frame.bodies) this.#bodies.set(to.index, { from: (!far && this.#bodies.get(to.index)?.from) || to, to });
    this.#lasts = far ? 0 : Math.max(LEAST, Math.min(MOST, now - this.#came));
    this.#came = now;
    this.#latest = frame;
  }

  /** Where all is at a moment [ms] that moves, or that was told last; `whole`: all that was ever told of this epoch. */
  at(now: number, whole = false): Frame {
    const share = this.#share(now), { epoch = 0, rev = 0, time = 0, arms = [], bodies = [] } = this.#latest ?? {};
    const shown = <T>(told: T[]) => (one: Motion<T>) => whole || one.from !== one.to || told.includes(one.to);
    return {
      epoch, rev, time,
      arms: [...this.#arms.values()].filter(shown(arms)).map((one) => arm(one, share)),
      bodies: [...this.#bodies.values()].filter(shown(bodies)).map((one) => body(one, share)),
    };
  }

  /** Whether all is where it was told last. */
  over(now: number): boolean {
    return this.#share(now) >= 1;
  }

  #share(now: number): number {
    return this.#lasts ? Math.max(0, Math.min(1, (now - this.#came) / this.#lasts)) : 1;
  }
}

function arm({ from, to }: Motion<ArmPose>, share: number): ArmPose {
  if (share >= 1 || from === to) return to;
  return { index: to.index, joints: Float32Array.from(mixed(from.joints, to.joints, share)), gripper: from.gripper + share * (to.gripper - from.gripper) };
}

function body({ from, to }: Motion<BodyPose>, share: number): BodyPose {
  if (share >= 1 || from === to) return to;
  const [x = 0, y = 0, z = 0] = mixed(from.position, to.position, share);
  return { index: to.index, position: [x, y, z], quaternion: turned(from.quaternion, to.quaternion, share) };
}
