// One camera for all views: orbit by mouse, touch and keys, the whole floor, from above, or after a person.
import { MathUtils, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const WIDE_DEGREES = 36,
  LIFT = MathUtils.degToRad(42),
  TURN = MathUtils.degToRad(-68),
  MOVE_MS = 450;
/** In a tall picture there is no width to spare for a floor that lies aslant. */
const TALL = 0.8,
  STRAIGHT = MathUtils.degToRad(-84);
const HALF_TALL = Math.tan(MathUtils.degToRad(WIDE_DEGREES) / 2);
const HIGH_M = 2.0,
  NEAREST_M = 2.2;

export class Rig {
  constructor(element, changed) {
    this.camera = new PerspectiveCamera(WIDE_DEGREES, 1, 0.3, 600);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.03;
    this.controls.minDistance = NEAREST_M;
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => (this.move = null));
    this.changed = changed;
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.move = null;
    this.following = null; // () => [x, y, z] or null
    this.bounds = [0, 0, 1, 1];
    this.free = { above: 0, below: 0 }; // shares of the picture that buttons and words cover
  }

  aspect(share) {
    this.camera.aspect = share;
    this.camera.updateProjectionMatrix();
  }

  /** The whole floor, from the usual side or from above. */
  whole(fromAbove = false, atOnce = false) {
    const [west, south, east, north] = this.bounds,
      lift = fromAbove ? Math.PI / 2 - 0.001 : LIFT,
      usual = fromAbove ? -Math.PI / 2 : this.camera.aspect < TALL ? STRAIGHT : TURN;
    const middle = [(west + east) / 2, (south + north) / 2, fromAbove ? 0 : 0.5];
    const [one, other] = [usual, usual + Math.PI / 2].map((turn) => this.fitting(new Vector3(...middle), lift, turn));
    const { target, far, turn } = other.far < 0.8 * one.far ? other : one;
    this.following = null;
    this.controls.maxDistance = 6 * Math.max(east - west, north - south, 6);
    this.fly(target, far, lift, turn, atOnce);
  }

  /** {target, far, turn}: where to look, and from how far, to have every corner of the floor in the free picture. */
  fitting(target, lift, turn) {
    const ahead = direction(lift, turn),
      right = new Vector3(-Math.sin(turn), Math.cos(turn), 0),
      up = new Vector3().crossVectors(ahead, right);
    const { above, below } = this.free,
      tall = HALF_TALL * (1 - above - below),
      wide = HALF_TALL * this.camera.aspect;
    const level = Math.hypot(up.x, up.y),
      back = new Vector3(up.x, up.y, 0).divideScalar(level ** 2); // 1 up in the picture
    let far = NEAREST_M;
    for (let k = 0; k < 4; k++) {
      const corners = this.corners()
        .map((corner) => corner.sub(target))
        .map((c) => [c.dot(right), c.dot(up), c.dot(ahead)]);
      far =
        Math.max(NEAREST_M, ...corners.map(([x, y, near]) => near + Math.max(Math.abs(y) / tall, Math.abs(x) / wide))) *
        1.03;
      const ys = corners.map(([, y, near]) => y / (far - near)),
        xs = corners.map(([x, , near]) => x / (far - near));
      target
        .addScaledVector(back, (middle(ys) + (k === 3 ? above - below : 0) * HALF_TALL) * far)
        .addScaledVector(right, middle(xs) * far);
    }
    return { target, far, turn };
  }

  corners() {
    const [west, south, east, north] = this.bounds;
    return [west, east].flatMap((x) => [south, north].flatMap((y) => [0, HIGH_M].map((z) => new Vector3(x, y, z))));
  }

  /** After a person: `where` gives his place at any moment, null while he is away. */
  follow(where) {
    this.following = where;
    const at = where();
    if (!at) return;
    const offset = this.camera.position.clone().sub(this.controls.target),
      lift = Math.asin(MathUtils.clamp(offset.z / offset.length(), -1, 1));
    this.fly(
      new Vector3(...at),
      Math.min(offset.length(), 6.5),
      Math.min(lift, 0.5),
      Math.atan2(offset.y, offset.x),
      false,
    );
  }

  fly(target, far, lift, turn, atOnce) {
    const to = { target, position: direction(lift, turn).multiplyScalar(far).add(target) };
    if (atOnce || this.calm) this.place(to.target, to.position);
    else
      this.move = {
        from: { target: this.controls.target.clone(), position: this.camera.position.clone() },
        to,
        since: null,
      };
    this.changed();
  }

  place(target, position) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    this.controls.update();
  }

  /** Closer (below 1) or further (above 1). */
  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    offset.clampLength(NEAREST_M, this.controls.maxDistance);
    this.place(this.controls.target.clone(), offset.add(this.controls.target));
    this.changed();
  }

  turn(aboutUp, lift) {
    const offset = this.camera.position.clone().sub(this.controls.target),
      far = offset.length();
    const now = Math.asin(MathUtils.clamp(offset.z / far, -1, 1)),
      to = MathUtils.clamp(now + lift, 0.03, Math.PI / 2 - 0.001);
    const target = this.controls.target.clone();
    this.place(
      target,
      direction(to, Math.atan2(offset.y, offset.x) + aboutUp)
        .multiplyScalar(far)
        .add(target),
    );
    this.changed();
  }

  /** Move the camera on; returns whether it will move again by itself. */
  tick(now) {
    this.walkAlong();
    if (!this.move) return false;
    this.move.since ??= now;
    const share = Math.min((now - this.move.since) / MOVE_MS, 1),
      u = share * share * (3 - 2 * share),
      { from, to } = this.move;
    this.place(from.target.clone().lerp(to.target, u), from.position.clone().lerp(to.position, u));
    if (share === 1) this.move = null;
    return this.move !== null;
  }

  walkAlong() {
    const at = this.following && this.following();
    if (!at) return;
    const step = new Vector3(...at).sub(this.move ? this.move.to.target : this.controls.target);
    if (step.lengthSq() < 1e-10) return;
    if (this.move) {
      this.move.to.target.add(step);
      this.move.to.position.add(step);
    } else this.place(this.controls.target.clone().add(step), this.camera.position.clone().add(step));
  }
}

const middle = (list) => (Math.min(...list) + Math.max(...list)) / 2;
const direction = (lift, turn) =>
  new Vector3(Math.cos(lift) * Math.cos(turn), Math.cos(lift) * Math.sin(turn), Math.sin(lift));
