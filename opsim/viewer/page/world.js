// One variant of a run: its floor, its people and everything that is known of them at a moment.
import { columnsOf, rowAt } from "./columns.js";
import { Crew } from "./crew.js";
import { Performances } from "./bodies.js";
import { skeletonOf } from "./skeleton.js";
import { alongWay, wayOf } from "./ways.js";

const A_SECOND = 4; // RULA scores

export class World {
  constructor(variant, buffer) {
    this.variant = variant;
    this.stood = [...variant.stations, ...variant.stores, ...variant.belts]; // what seg_station counts
    this.c = columnsOf(buffer, variant.columns);
    this.skeletons = variant.skeletons.map(skeletonOf);
    this.ways = this.waysOf();
    this.performances = new Performances(variant.models, this.c, this.skeletons);
    this.crew = new Crew(variant, this.c, this.skeletons, this.performances, this.ways);
    this.joints = variant.workers.map(
      () => new Float64Array(3 * Math.max(...this.skeletons.map((s) => s.names.length), 1)),
    );
    this.headings = new Float64Array(variant.workers.length);
    this.present = variant.workers.map(() => null); // the skeleton of who is on the floor
    this.longestMoveS = this.c.mv_start_s
      ? this.c.mv_start_s.reduce((most, at, i) => Math.max(most, this.c.mv_end_s[i] - at), 0)
      : 0;
    this.headingsOfStanding = new Map();
    this.timeS = variant.low_s;
  }

  get nWorkers() {
    return this.variant.workers.length;
  }

  /** Put everybody where he is at this time of the run. */
  seek(timeS) {
    this.timeS = Math.min(Math.max(timeS, this.variant.low_s), this.variant.high_s);
    for (let worker = 0; worker < this.nWorkers; worker++) {
      const pose = this.crew.pose(worker, this.timeS);
      this.present[worker] = pose ? pose.skeleton : null;
      if (!pose) continue;
      pose.joints(this.joints[worker]);
      this.headings[worker] = pose.root[3];
    }
  }

  /** What a worker does: numbers into the variant's lists, -1 none; moving: a performance is shown. */
  doing(worker, timeS = this.timeS) {
    const { c } = this,
      row = this.crew.segment(worker, timeS);
    return {
      row,
      state: c.seg_state[row],
      station: c.seg_station[row],
      task: c.seg_task[row],
      product: c.seg_product[row],
      job: c.seg_job[row],
      moving: c.seg_performance[row] >= 0,
    };
  }

  /** [least, most] RULA score, or null where it is not known. */
  rula(worker, timeS = this.timeS) {
    if (!this.c.rula) return null;
    const { low_s: low, high_s: high } = this.variant,
      each = Math.ceil((high - low) * A_SECOND);
    const packed = this.c.rula[worker * each + Math.min(Math.max(Math.floor((timeS - low) * A_SECOND), 0), each - 1)];
    return packed ? [packed & 15, packed >> 4] : null;
  }

  /** {queue, busy, state} of a station. */
  station(station, timeS = this.timeS) {
    const { c } = this,
      row = rowAt(c.st_at_s, c.st_first[station], c.st_first[station + 1], timeS);
    if (c.st_first[station] === c.st_first[station + 1]) return { queue: 0, busy: 0, state: -1 };
    return { queue: c.st_queue[row], busy: c.st_busy[row], state: c.st_state[row] };
  }

  level(store, timeS = this.timeS) {
    const { c } = this;
    if (!c.so_first || c.so_first[store] === c.so_first[store + 1]) return 0;
    return c.so_level[rowAt(c.so_at_s, c.so_first[store], c.so_first[store + 1], timeS)];
  }

  /** Parts under way now: calls tell(kind, worker, product, {x, y, phi}). */
  moving(tell) {
    const { c, timeS } = this,
      n = c.mv_start_s ? c.mv_start_s.length : 0;
    if (!n || c.mv_start_s[0] > timeS) return;
    for (
      let row = rowAt(c.mv_start_s, 0, n, timeS);
      row >= 0 && c.mv_start_s[row] >= timeS - this.longestMoveS;
      row--
    ) {
      if (c.mv_end_s[row] < timeS || (c.mv_end_s[row] === timeS && timeS < this.variant.high_s)) continue;
      const long = c.mv_end_s[row] - c.mv_start_s[row],
        way = this.ways[c.mv_way[row]];
      const on = way ? alongWay(way, (long > 0 ? (timeS - c.mv_start_s[row]) / long : 1) * way.longM) : null;
      if (on && on.phi === null) on.phi = this.stoodFrom(row);
      tell(c.mv_kind[row], c.mv_worker[row], c.mv_product[row], on);
    }
  }

  /** The heading of what stands: that with which it came. */
  stoodFrom(row) {
    const { c } = this;
    if (this.headingsOfStanding.has(row)) return this.headingsOfStanding.get(row);
    const here = this.ways[c.mv_way[row]];
    let phi = 0;
    for (let before = row - 1; before >= 0; before--) {
      const way = this.ways[c.mv_way[before]];
      if (
        !way ||
        !way.heading.length ||
        Math.abs(c.mv_end_s[before] - c.mv_start_s[row]) > 0.01 ||
        c.mv_kind[before] !== c.mv_kind[row]
      )
        continue;
      if (Math.hypot(way.x.at(-1) - here.x[0], way.y.at(-1) - here.y[0]) > 0.01) continue;
      phi = way.heading.at(-1);
      break;
    }
    this.headingsOfStanding.set(row, phi);
    return phi;
  }

  waysOf() {
    const { way_first: first, way_x: x, way_y: y } = this.c;
    return first ? Array.from({ length: first.length - 1 }, (_, i) => wayOf(x, y, first[i], first[i + 1])) : [];
  }
}
