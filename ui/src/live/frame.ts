/** The binary frames of a bench that moves: `pico/server/live` writes them, this reads them. */

export const VERSION = 1;

export interface ArmPose {
  index: number;
  /** Angles of the joints [rad]. */
  joints: Float32Array;
  /** How far the gripper is open [mm]. */
  gripper: number;
}

export interface BodyPose {
  index: number;
  /** Where it is [mm]. */
  position: [number, number, number];
  /** How it is turned, w x y z. */
  quaternion: [number, number, number, number];
}

export interface Frame {
  epoch: number;
  rev: number;
  /** Seconds of the bench's clock. */
  time: number;
  arms: ArmPose[];
  bodies: BodyPose[];
}

/** Read a frame; throws RangeError for what is none. */
export function decode(data: ArrayBuffer): Frame {
  const view = new DataView(data);
  let at = 0;
  const u8 = () => view.getUint8(at++);
  const u16 = () => view.getUint16((at += 2) - 2, true);
  const u32 = () => view.getUint32((at += 4) - 4, true);
  const f32 = () => view.getFloat32((at += 4) - 4, true);
  const f64 = () => view.getFloat64((at += 8) - 8, true);
  const version = u8();
  if (version !== VERSION) throw new RangeError(`a frame of version ${version}, and this page reads version ${VERSION}`);
  const frame: Frame = { epoch: u32(), rev: u32(), time: f64(), arms: [], bodies: [] };
  for (let left = u8(); left > 0; left--) {
    const index = u8();
    const joints = Float32Array.from({ length: u8() }, f32);
    frame.arms.push({ index, joints, gripper: f32() });
  }
  for (let left = u16(); left > 0; left--) {
    const index = u16();
    frame.bodies.push({ index, position: [f32(), f32(), f32()], quaternion: [f32(), f32(), f32(), f32()] });
  }
  if (at !== data.byteLength) throw new RangeError(`${data.byteLength - at} bytes too many in a frame`);
  return frame;
}
