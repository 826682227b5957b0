// Who is where and in which posture at any moment: opsim/viewer/posed.py is the definition.
import { rowAt } from "./columns.js";
import { Pose, standingHeight } from "./pose.js";
import { smooth, turn } from "./vectors.js";
import { alongWay } from "./ways.js";

const EASE_S = 0.4;
const AWAY = new Set(["off", "absent"]);

export class Crew {
  constructor(variant, columns, skeletons, performances, ways) {
    Object.assign(this, { variant, c: columns, skeletons, performances, ways });
    this.end = endsOf(columns, variant);
    this.away = variant.states.map((state) => AWAY.has(state.name));
    const most = Math.max(...skeletons.map((skeleton) => skeleton.bones.length), 1);
    [this.shown, this.before, this.after, this.still] = [0, 1, 2, 3].map(() => new Pose(most));
    this.own = new Float64Array(4);
    this.standing = variant.workers.map((_, worker) => this.standingOf(worker));
  }

  /** The row of the worker's segment at a time of the run; a boundary belongs to the later one. */
  segment(worker, timeS) {
    return rowAt(this.c.seg_start_s, this.c.seg_first[worker], this.c.seg_first[worker + 1], timeS);
  }

  /** The posture of a worker, or null where he is not on the floor. It holds until the next call. */
  pose(worker, timeS) {
    if (this.c.seg_first[worker] === this.c.seg_first[worker + 1]) return null;
    const row = this.segment(worker, timeS);
    if (!this.isThere(row)) return null;
    if (this.c.seg_performance[row] >= 0) return this.performed(worker, row, timeS, this.shown);
    return this.stood(worker, row, timeS);
  }

  isThere(row) {
    return !this.away[this.c.seg_state[row]] && Number.isFinite(this.c.seg_x[row]);
  }

  /** Waiting in a standing posture, eased from the end of the segment before and to the start of the one after. */
  stood(worker, row, timeS) {
    const start = this.c.seg_start_s[row],
      end = this.end[row],
      ease = Math.min(EASE_S, (end - start) / 3);
    const still = this.stands(worker, row, timeS, this.still);
    if (timeS - start < ease && this.neighbour(worker, row - 1)) {
      const before = this.at(worker, row - 1, this.end[row - 1], this.before);
      if (before.skeleton === still.skeleton) return this.eased(before, still, (timeS - start) / ease);
    }
    if (end - timeS < ease && this.neighbour(worker, row + 1) && this.c.seg_performance[row + 1] >= 0) {
      const after = this.performed(worker, row + 1, this.c.seg_start_s[row + 1], this.after);
      if (after.skeleton === still.skeleton) return this.eased(after, still, (end - timeS) / ease);
    }
    return still;
  }

  eased(from, to, share) {
    this.shown.between(from, to, smooth(share));
    return this.shown;
  }

  neighbour(worker, row) {
    return row >= this.c.seg_first[worker] && row < this.c.seg_first[worker + 1] && this.isThere(row);
  }

  /** The posture of a segment by itself, without easing. */
  at(worker, row, timeS, into) {
    return this.c.seg_performance[row] >= 0
      ? this.performed(worker, row, timeS, into)
      : this.stands(worker, row, timeS, into);
  }

  stands(worker, row, timeS, into) {
    const { skeleton, directions, lengths, height } = this.standing[worker],
      share = this.share(row, timeS);
    into.take(skeleton, lengths);
    into.directions.set(directions);
    into.root.set([this.x(row, share), this.y(row, share), height, this.c.seg_yaw[row]]);
    return into;
  }

  performed(worker, row, timeS, into) {
    const { c } = this,
      performance = this.performances.of(c.seg_performance[row]),
      share = this.share(row, timeS);
    performance.model.pose(
      performance,
      c.seg_from_s[row] + share * (c.seg_to_s[row] - c.seg_from_s[row]),
      into.directions,
      this.own,
    );
    into.take(performance.model.skeleton, performance.lengths);
    if (c.seg_way[row] >= 0) this.walked(row, timeS, into);
    else this.worked(row, share, into);
    return into;
  }

  /** How much of a segment is over. */
  share(row, timeS) {
    const start = this.c.seg_start_s[row],
      long = this.end[row] - start;
    return long > 0 ? Math.min(Math.max((timeS - start) / long, 0), 1) : 0;
  }

  /** Where a segment's frame is: on a moving line people are carried along. */
  x(row, share) {
    return this.c.seg_x[row] + (this.c.seg_dx ? share * this.c.seg_dx[row] : 0);
  }

  y(row, share) {
    return this.c.seg_y[row] + (this.c.seg_dy ? share * this.c.seg_dy[row] : 0);
  }

  worked(row, share, into) {
    const { c, own } = this,
      yaw = c.seg_yaw[row],
      cosine = Math.cos(yaw),
      sine = Math.sin(yaw);
    into.root[0] = this.x(row, share) + cosine * own[0] - sine * own[1];
    into.root[1] = this.y(row, share) + sine * own[0] + cosine * own[1];
    into.root[2] = own[2];
    into.root[3] = yaw + own[3];
  }

  walked(row, timeS, into) {
    const { c, own } = this,
      number = c.seg_way[row],
      way = this.ways[number],
      ownM = c.way_own_m[number];
    const s = Math.min(Math.max(ownM > 0 ? (own[0] * way.longM) / ownM : 0, 0), way.longM),
      on = alongWay(way, s);
    const phi = this.turned(row, timeS, on.phi ?? 0);
    into.root[0] = on.x - own[1] * Math.sin(phi);
    into.root[1] = on.y + own[1] * Math.cos(phi);
    into.root[2] = own[2];
    into.root[3] = phi + own[3];
  }

  /** Out of the heading before a walk and into the one after it. */
  turned(row, timeS, phi) {
    const { c } = this,
      start = c.seg_start_s[row],
      end = this.end[row],
      ease = Math.min(EASE_S, (end - start) / 3);
    const before = c.way_yaw_from[c.seg_way[row]],
      after = c.way_yaw_to[c.seg_way[row]]; // nan: as the way goes
    if (timeS - start < ease && !Number.isNaN(before))
      return before + smooth((timeS - start) / ease) * turn(before, phi);
    if (end - timeS < ease && !Number.isNaN(after)) return after + smooth((end - timeS) / ease) * turn(after, phi);
    return phi;
  }

  /** How a worker stands: a posture of his skeleton, his own bones, the root so high that the feet are on the floor. */
  standingOf(worker) {
    const { c } = this,
      number = c.stand_skeleton[worker],
      skeleton = this.skeletons[number],
      bones = skeleton.bones.length;
    const first = this.skeletons.slice(0, number).reduce((sum, before) => sum + 3 * before.bones.length, 0);
    const directions = c.standing.slice(first, first + 3 * bones),
      lengths = c.stand_bone_m.slice(worker * bones, (worker + 1) * bones);
    return { skeleton, directions, lengths, height: standingHeight(skeleton, directions, lengths) };
  }
}

/** When each segment ends: with the worker's next one, the last with what is shown. */
function endsOf({ seg_first: first, seg_start_s: start }, variant) {
  const end = new Float64Array(start.length);
  end.set(start.subarray(1));
  for (let worker = 0; worker + 1 < first.length; worker++)
    if (first[worker + 1] > first[worker]) end[first[worker + 1] - 1] = variant.high_s;
  return end;
}
