// The way of a root that rides on planted feet, as emulator/kernels/body.py (ride_all) and emulator/root.py have it.
import { stand } from "./skeleton.js";

const SOFT_M = 0.01;
const FEET = ["left_ankle", "left_toe", "right_ankle", "right_toe"];
const LEGS = ["left_knee", "left_ankle", "right_knee", "right_ankle"];

/** What slip and clearance are measured in: mean thigh and shank, or a quarter of all bones where no knees are. */
export function legM(skeleton, lengths) {
  const bones = LEGS.map((name) => skeleton.bones.indexOf(skeleton.names.indexOf(name))).filter((bone) => bone >= 0);
  if (bones.length === 4) return bones.reduce((sum, bone) => sum + lengths[bone], 0) / 2;
  return lengths.reduce((sum, length) => sum + length, 0) / 4;
}

/** Path (T x 4: x, y, z, heading) from directions (T x 3B), lengths (B) and the side channel (T x 4). */
export function ride(skeleton, directions, lengths, channel, nTimes) {
  const feet = FEET.map((name) => skeleton.names.indexOf(name)).filter((joint) => joint >= 0),
    n = feet.length;
  const leg = legM(skeleton, lengths),
    width = 3 * lengths.length;
  const joints = new Float64Array(3 * skeleton.names.length),
    path = new Float64Array(4 * nTimes);
  const x = [new Float64Array(n), new Float64Array(n)],
    y = [new Float64Array(n), new Float64Array(n)];
  const share = [new Float64Array(n), new Float64Array(n)];
  let wayX = 0,
    wayY = 0;
  for (let t = 0; t < nTimes; t++) {
    const now = t % 2,
      last = 1 - now,
      yaw = channel[4 * t + 3];
    stand(skeleton, directions.subarray(t * width, (t + 1) * width), lengths, 0, 0, 0, yaw, joints);
    let lowest = Infinity,
      lowestFoot = Infinity,
      weight = 0;
    for (let j = 2; j < joints.length; j += 3) lowest = Math.min(lowest, joints[j]);
    for (let f = 0; f < n; f++) lowestFoot = Math.min(lowestFoot, joints[3 * feet[f] + 2]);
    for (let f = 0; f < n; f++) {
      x[now][f] = joints[3 * feet[f]];
      y[now][f] = joints[3 * feet[f] + 1];
      share[now][f] = Math.exp((lowestFoot - joints[3 * feet[f] + 2]) / SOFT_M);
      weight += share[now][f];
    }
    for (let f = 0; f < n; f++) {
      share[now][f] /= weight;
      if (t === 0) continue;
      const both = 0.5 * (share[now][f] + share[last][f]);
      wayX -= both * (x[now][f] - x[last][f]);
      wayY -= both * (y[now][f] - y[last][f]);
    }
    const floor = n ? SOFT_M * Math.log(weight / n) - lowestFoot : 0;
    path[4 * t] = wayX + channel[4 * t] * leg;
    path[4 * t + 1] = wayY + channel[4 * t + 1] * leg;
    path[4 * t + 2] = Math.max(floor + channel[4 * t + 2] * leg, -lowest);
    path[4 * t + 3] = yaw;
  }
  const startX = path[0],
    startY = path[1];
  for (let t = 0; t < nTimes; t++) {
    path[4 * t] -= startX;
    path[4 * t + 1] -= startY;
  }
  return path;
}
