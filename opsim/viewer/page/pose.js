// A posture in the room: skeleton, directions, lengths, root and heading; and the way from one posture to another.
import { normalise } from "./decode_frames.js";
import { stand } from "./skeleton.js";
import { turn } from "./vectors.js";

export class Pose {
  constructor(mostBones) {
    this.skeleton = null;
    this.directions = new Float64Array(3 * mostBones);
    this.lengths = new Float64Array(mostBones);
    this.root = new Float64Array(4); // x, y, z, heading
  }

  take(skeleton, lengths) {
    this.skeleton = skeleton;
    this.lengths.set(lengths);
  }

  /** At share u from `a` to `b`, bodies of one skeleton: directions and root straight, heading the shorter way. */
  between(a, b, u) {
    this.take(b.skeleton, b.lengths);
    const bones = b.skeleton.bones.length;
    for (let i = 0; i < 3 * bones; i++) this.directions[i] = a.directions[i] + u * (b.directions[i] - a.directions[i]);
    normalise(this.directions, 3 * bones);
    for (let i = 0; i < bones; i++) this.lengths[i] = a.lengths[i] + u * (b.lengths[i] - a.lengths[i]);
    for (let c = 0; c < 3; c++) this.root[c] = a.root[c] + u * (b.root[c] - a.root[c]);
    this.root[3] = a.root[3] + u * turn(a.root[3], b.root[3]);
  }

  joints(out) {
    const [x, y, z, heading] = this.root;
    stand(this.skeleton, this.directions, this.lengths, x, y, z, heading, out);
  }
}

/** The height of the root at which the lowest joint touches the floor. */
export function standingHeight(skeleton, directions, lengths) {
  const joints = new Float64Array(3 * skeleton.names.length);
  stand(skeleton, directions, lengths, 0, 0, 0, 0, joints);
  let lowest = Infinity;
  for (let j = 2; j < joints.length; j += 3) lowest = Math.min(lowest, joints[j]);
  return -lowest;
}
