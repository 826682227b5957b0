// The emulator's own way back from coefficients to a moving body: emulator/performances.py, decode.py, sphere.py.
import { ride } from "./ride.js";
import { evaluate, fromRatios, movingShare, placeOf } from "./warp.js";

const BLOCKS = ["posture", "root", "pace", "bones"];

/** A model of codec "scores": `performance(row)` decodes one whole performance, `pose` puts it at a moment. */
export class ScoresModel {
  constructor(model, columns, skeleton) {
    this.columns = columns;
    this.skeleton = skeleton;
    this.nTimes = model.n_times;
    this.n = model.n;
    this.sizes = model.sizes;
    this.nBones = skeleton.bones.length;
  }

  performance(row) {
    const { columns: c, nTimes, skeleton } = this,
      [posture, channel, ratios, logLengths] = BLOCKS.map((block) => this.block(block, row));
    const lengths = logLengths.map((value) => Math.exp(value) * c.body_scale[row]);
    ratios.forEach((ratio, k) => (ratios[k] = Math.min(Math.max(ratio, c.slope_least[k]), c.slope_most[k])));
    const gamma = fromRatios(ratios, nTimes),
      directions = onSpheres(posture, c.frame, this.nBones);
    const path = ride(skeleton, directions, lengths, channel, nTimes);
    return { model: this, lengths, directions, path, gamma, durationS: c.duration_s[row], ...this.dwells(row, gamma) };
  }

  /** Directions (3B) into `directions` and the root's x, y, z, heading into `root` (4) at a moment of own time. */
  pose(performance, ownS, directions, root) {
    const { gamma, durationS, dwellS, dwellStartS, path } = performance;
    const own = ownS / durationS,
      share = dwellS.length ? movingShare(own, durationS, dwellS, dwellStartS) : own;
    const place = placeOf(gamma, share),
      cell = Math.min(Math.floor(place), this.nTimes - 2),
      u = place - cell;
    between(performance.directions, 3 * this.nBones * cell, 3 * this.nBones, u, directions);
    for (let k = 0; k < 4; k++) root[k] = (1 - u) * path[4 * cell + k] + u * path[4 * cell + 4 + k];
  }

  /** mean (P) + coefficients (K) @ basis (K x P) of a block, in float64; the coefficients stand column by column. */
  block(name, row) {
    const { columns: c, n } = this,
      values = c[name],
      scale = c[`${name}_scale`],
      basis = c[`${name}_basis`];
    const out = Float64Array.from(c[`${name}_mean`]),
      P = out.length;
    for (let k = 0; k < this.sizes[name]; k++) {
      const factor = values[k * n + row] * scale[k],
        start = k * P;
      for (let i = 0; i < P; i++) out[i] += factor * basis[start + i];
    }
    return out;
  }

  dwells(row, gamma) {
    const { dwell_s: all, dwell_clock: clock, duration_s: durations } = this.columns;
    const dwellS = Float64Array.from(clock, (_, j) => all[j * this.n + row]);
    const movingS = dwellS.reduce((left, dwell) => left - dwell, durations[row]);
    return { dwellS, dwellStartS: Float64Array.from(clock, (at) => movingS * evaluate(gamma, at)) };
  }
}

/** Tangent coordinates (T x 2B) -> unit directions (T x 3B); frame (B x 9): reference, first and second axis. */
function onSpheres(flat, frame, nBones) {
  const out = new Float64Array((flat.length / 2) * 3);
  for (let i = 0, b = 0; i < flat.length / 2; i++, b = b + 1 === nBones ? 0 : b + 1) {
    const x = flat[2 * i],
      y = flat[2 * i + 1],
      angle = Math.hypot(x, y);
    const ahead = Math.cos(angle),
      across = angle > 1e-9 ? Math.sin(angle) / angle : 1;
    for (let c = 0; c < 3; c++)
      out[3 * i + c] = ahead * frame[9 * b + c] + across * (x * frame[9 * b + 3 + c] + y * frame[9 * b + 6 + c]);
  }
  return out;
}

/** Each bone at share u of the geodesic from the posture at `at` to the next one. */
function between(directions, at, width, u, out) {
  for (let b = 0; b < width; b += 3) {
    const p = at + b,
      q = p + width;
    const px = directions[p],
      py = directions[p + 1],
      pz = directions[p + 2];
    const qx = directions[q],
      qy = directions[q + 1],
      qz = directions[q + 2];
    const cosine = px * qx + py * qy + pz * qz;
    const ax = qx - cosine * px,
      ay = qy - cosine * py,
      az = qz - cosine * pz,
      sine = Math.hypot(ax, ay, az);
    const angle = Math.atan2(sine, cosine),
      ahead = Math.cos(u * angle),
      across = sine > 1e-12 ? Math.sin(u * angle) / sine : u;
    out[b] = ahead * px + across * ax;
    out[b + 1] = ahead * py + across * ay;
    out[b + 2] = ahead * pz + across * az;
  }
}
