// People: limbs, torso, head and cap of any number of bodies in one draw call for near ones and one for far ones, and
// their shadows in another.
import { Group } from "three";
import { Capsules, COARSE, FINE } from "./capsules.js";
import { Marks } from "./marks.js";
import { cross, length, minus, mix, plus, point, times, unit } from "./vectors.js";

const DEFAULT_SHIRT = 0x8fa3b5;
const MARKS_EACH = 8;

/** Each picture: begin(), add(body, joints, shirt, floorZ) for everybody, end(). Bodies are made by body.js. */
export class People {
  constructor(most, pieces = 40) {
    this.fine = new Capsules(most * pieces, FINE);
    this.coarse = new Capsules(most * pieces, COARSE);
    this.marks = new Marks(most * MARKS_EACH);
    this.object = new Group();
    this.object.add(this.fine.object, this.coarse.object, this.marks.object);
  }

  begin() {
    this.fine.begin();
    this.coarse.begin();
    this.marks.begin();
  }

  /** body of bodyOf(), joints (3J) in metres, shirt and ring 0xrrggbb or null, floorZ: where the shadow lies,
   *  isNear: with all its corners. */
  add(body, joints, shirt = null, floorZ = 0, ring = null, isNear = true) {
    this.capsules = isNear ? this.fine : this.coarse;
    const colour = shirt === null ? DEFAULT_SHIRT : shirt;
    for (const { parent, joint, from, to, colour: own } of body.limbs) {
      const p = 3 * parent,
        q = 3 * joint;
      this.capsules.add(
        joints[p],
        joints[p + 1],
        joints[p + 2],
        from,
        joints[q],
        joints[q + 1],
        joints[q + 2],
        to,
        own ?? colour,
      );
    }
    for (const [knee, ankle, toe] of body.soles) this.sole(body, joints, knee, ankle, toe);
    const left = body.torso.length
      ? this.torso(body, joints, body.colours.torso ?? colour, body.colours.hips ?? colour)
      : null;
    if (body.head >= 0) this.head(body, joints, left, colour);
    this.ground(body, joints, ring ?? colour, floorZ);
  }

  end() {
    this.fine.end();
    this.coarse.end();
    this.marks.end();
  }

  piece(a, ra, b, rb, colour, wa = null, wb = null) {
    this.capsules.add(a[0], a[1], a[2], ra, b[0], b[1], b[2], rb, colour, wa, wb);
  }

  /** From behind the ankle to the toe, below the line between them. */
  sole(body, joints, knee, ankle, toe) {
    const at = point(joints, ankle),
      tip = point(joints, toe),
      down = unit(minus(at, point(joints, knee)));
    const ahead = minus(tip, at),
      heel = plus(plus(at, down, 0.035), ahead, -0.28);
    const side = body.names[toe].startsWith("left_") ? body.colours.left("toe") : body.colours.right("toe");
    this.piece(heel, 0.038, tip, 0.034, side);
  }

  /** Hips, chest and shoulders; returns the unit vector to the left along the shoulders. */
  torso(body, joints, colour, below) {
    const [ls, rs, rh, lh] = body.torso.map((joint) => point(joints, joint));
    const hips = mix(lh, rh, 0.5),
      shoulders = mix(ls, rs, 0.5),
      up = minus(shoulders, hips);
    const hipWay = minus(lh, rh),
      shoulderWay = minus(ls, rs),
      left = unit(shoulderWay),
      hipLeft = unit(hipWay);
    const waist =
      body.waist >= 0 ? mix(mix(hips, shoulders, 0.34), point(joints, body.waist), 0.5) : mix(hips, shoulders, 0.34);
    const chest = plus(waist, minus(shoulders, waist), 0.62),
      size = length(up) / 0.5;
    const half = { hips: length(hipWay) / 2 + 0.097 * size, shoulders: length(shoulderWay) / 2 + 0.012 * size };
    const middle = unit(plus(left, hipLeft));
    this.piece(
      plus(hips, up, 0.02),
      0.116 * size,
      plus(hips, up, 0.16),
      0.108 * size,
      below,
      times(hipLeft, half.hips),
      times(hipLeft, half.hips - 0.012),
    );
    this.piece(
      plus(hips, up, 0.3),
      0.108 * size,
      waist,
      0.1 * size,
      colour,
      times(hipLeft, half.hips - 0.004),
      times(middle, 0.142 * size),
    );
    this.piece(
      waist,
      0.1 * size,
      chest,
      0.116 * size,
      colour,
      times(middle, 0.142 * size),
      times(left, half.shoulders * 0.93),
    );
    this.piece(
      chest,
      0.116 * size, // so wide at its end that the one below stays inside
      plus(shoulders, up, -0.05),
      0.09 * size,
      colour,
      times(left, half.shoulders * 0.93),
      times(left, half.shoulders * 0.8),
    );
    const collar = plus(shoulders, up, 0.05);
    this.piece(ls, 0.06 * size, collar, 0.058 * size, colour);
    this.piece(rs, 0.06 * size, collar, 0.058 * size, colour);
    return left;
  }

  head(body, joints, left, colour) {
    const { head, cap, neck } = body.colours,
      at = point(joints, body.head),
      below = point(joints, body.neck);
    const up = unit(minus(at, below)),
      side = left || [0, 1, 0];
    const ahead = unit(cross(side, up)),
      across = cross(up, ahead);
    this.piece(below, 0.052, at, 0.05, neck);
    this.piece(
      plus(at, up, -0.035),
      0.084,
      plus(at, up, 0.035),
      0.092,
      head ?? colour,
      times(across, 0.076),
      times(across, 0.082),
    );
    const crown = plus(plus(at, up, 0.058), ahead, -0.01);
    this.piece(crown, 0.1, plus(crown, up, 0.012), 0.092, cap ?? colour, times(across, 0.09), times(across, 0.084));
    const brim = plus(crown, up, 0.004);
    this.piece(
      plus(brim, ahead, 0.06),
      0.016,
      plus(brim, ahead, 0.135),
      0.01,
      cap ?? colour,
      times(across, 0.078),
      times(across, 0.055),
    );
  }

  /** Under each foot the darker the nearer it is to the floor, under the body a wide faint one. */
  ground(body, joints, colour, floorZ) {
    const z = floorZ + 0.004,
      root = 3 * body.root;
    if (body.colours.ring) this.marks.ring(joints[root], joints[root + 1], z, 0.36, colour);
    this.marks.shadow(joints[root], joints[root + 1], z, 0.5, 0.3);
    for (const foot of body.feet.slice(0, MARKS_EACH - 2)) {
      const high = Math.max(joints[3 * foot + 2] - floorZ, 0);
      this.marks.shadow(joints[3 * foot], joints[3 * foot + 1], z, 0.15, 0.42 * Math.exp(-high / 0.14));
    }
  }
}
