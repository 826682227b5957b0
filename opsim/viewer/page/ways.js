// Ways as they are drawn: points, lengths, and the heading of who walks along one.
import { rowAt } from "./columns.js";
import { turn } from "./vectors.js";

const CORNER_M = 0.35;

/** {x, y, at: metres from its start to each point, heading of each leg, long_m}; points that fall together are one. */
export function wayOf(xs, ys, first, end) {
  const x = [xs[first]],
    y = [ys[first]],
    at = [0],
    heading = [];
  for (let i = first + 1; i < end; i++) {
    const dx = xs[i] - x[x.length - 1],
      dy = ys[i] - y[y.length - 1],
      far = Math.hypot(dx, dy);
    if (far < 1e-9) continue;
    heading.push(Math.atan2(dy, dx));
    at.push(at[at.length - 1] + far);
    x.push(xs[i]);
    y.push(ys[i]);
  }
  return { x, y, at, heading, longM: at[at.length - 1] };
}

/** {x, y, phi} at s metres along a way: phi is the leg's direction, turned linearly about each inner corner. */
export function alongWay(way, s) {
  if (!way.heading.length) return { x: way.x[0], y: way.y[0], phi: null };
  const leg = rowAt(way.at, 0, way.heading.length, s),
    on = s - way.at[leg],
    phi = way.heading[leg];
  const x = way.x[leg] + on * Math.cos(phi),
    y = way.y[leg] + on * Math.sin(phi);
  return { x, y, phi: phi + turning(way, leg, on) };
}

function turning(way, leg, on) {
  const long = way.at[leg + 1] - way.at[leg],
    last = way.heading.length - 1;
  if (leg > 0) {
    const near = reach(way, leg - 1);
    if (on < near) return turn(way.heading[leg - 1], way.heading[leg]) * ((on + near) / (2 * near) - 1);
  }
  if (leg < last) {
    const near = reach(way, leg);
    if (long - on < near) return turn(way.heading[leg], way.heading[leg + 1]) * ((near - (long - on)) / (2 * near));
  }
  return 0;
}

/** How far before and after the corner behind this leg the heading turns. */
function reach(way, leg) {
  const before = way.at[leg + 1] - way.at[leg],
    after = way.at[leg + 2] - way.at[leg + 1];
  return Math.min(CORNER_M, before / 2, after / 2);
}
