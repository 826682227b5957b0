// The main angles of a body, in degrees, as opsim/ergonomics/angles.py has them; z is up.
import { cross, dot, length, minus, plus, point, times, unit } from "./vectors.js";

const DEGREES = 180 / Math.PI;

/** {name: degrees, or null where the posture has none or the skeleton lacks a joint}. */
export function anglesOf(names, joints) {
  const at = (name) => (names.includes(name) ? point(joints, names.indexOf(name)) : [NaN, NaN, NaN]);
  const found = { ...trunk(at) };
  for (const side of ["left", "right"]) {
    found[`${side}_arm`] = arm(at, side);
    found[`${side}_elbow`] = bend(at, side, "shoulder", "elbow", "wrist");
    found[`${side}_knee`] = bend(at, side, "hip", "knee", "ankle");
  }
  return Object.fromEntries(
    Object.entries(found).map(([name, angle]) => [name, Number.isFinite(angle) ? angle * DEGREES : null]),
  );
}

/** Flexion forward, side bend to the left, twist of the shoulders to the left, against the levelled hip line. */
function trunk(at) {
  const across = minus(at("left_hip"), at("right_hip")),
    left = unit([across[0], across[1], 0]);
  const frame = [cross(left, [0, 0, 1]), left, [0, 0, 1]];
  const v = within(frame, unit(minus(at("neck"), at("pelvis"))));
  const shoulders = within(frame, minus(at("left_shoulder"), at("right_shoulder")));
  return {
    flexion: Math.atan2(v[0], v[2]),
    side_bend: Math.atan2(v[1], Math.hypot(v[0], v[2])),
    twist: twist(v, shoulders),
  };
}

const within = (frame, vector) => frame.map((axis) => dot(axis, vector));

/** Of the shoulder line about v, against y brought along by the smallest rotation that brings up to v. */
function twist(v, shoulders) {
  const half = plus(v, [0, 0, 1]),
    fold = half[2] > 1e-6 ? times(half, 1 / half[2]) : [NaN, NaN, NaN];
  const x = minus([1, 0, 0], times(fold, v[0])),
    y = minus([0, 1, 0], times(fold, v[1]));
  return Math.atan2(-dot(shoulders, x), dot(shoulders, y));
}

/** From hanging along the trunk (0) to straight up, whatever the direction. */
function arm(at, side) {
  const along = unit(minus(at("neck"), at("pelvis"))),
    u = unit(minus(at(`${side}_elbow`), at(`${side}_shoulder`)));
  return Math.atan2(length(cross(u, along)), -dot(u, along));
}

function bend(at, side, ...chain) {
  const [top, middle, end] = chain.map((joint) => at(`${side}_${joint}`));
  const a = minus(middle, top),
    b = minus(end, middle);
  return Math.atan2(length(cross(unit(a), unit(b))), dot(unit(a), unit(b)));
}
