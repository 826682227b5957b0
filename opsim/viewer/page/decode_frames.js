// Bodies kept as frames of a few numbers, which are the control points of cubic splines over time.

/** A model of codec "frames": `performance(row)` decodes one whole performance, `pose` puts it at a moment. */
export class FramesModel {
  constructor(model, columns, skeleton) {
    this.columns = columns;
    this.skeleton = skeleton;
    this.rateHz = model.rate_hz;
    this.nDirections = model.sizes.directions;
    this.nBones = skeleton.bones.length;
    this.channels = new Float64Array(this.nDirections + 4);
  }

  performance(row) {
    const { first, bone_m: bones, duration_s: durations } = this.columns,
      B = this.nBones;
    const frames = first[row + 1] - first[row],
      lengths = Float64Array.from(bones.subarray(row * B, (row + 1) * B));
    const values = this.valuesOf(first[row], frames);
    return { model: this, row, frames, lengths, values, durationS: durations[row] };
  }

  /** Channels (d + 4) x frames, whole steps of `scale`: second differences along time undone. */
  valuesOf(first, frames) {
    const channels = this.nDirections + 4,
      start = first * channels;
    const values = new Int32Array(channels * frames),
      stored = this.columns.values;
    for (let c = 0; c < channels; c++) {
      let step = 0,
        value = 0;
      for (let f = 0; f < frames; f++) {
        step += unfolded(stored[start + c * frames + f]);
        value += step;
        values[c * frames + f] = value;
      }
    }
    return values;
  }

  pose(performance, ownS, directions, root) {
    const { channels, nDirections: d } = this,
      { basis } = this.columns;
    this.between(performance, ownS);
    for (let k = 0; k < 4; k++) root[k] = channels[d + k];
    const width = 3 * this.nBones;
    for (let i = 0; i < width; i++) {
      let sum = basis[i];
      for (let k = 0; k < d; k++) sum += channels[k] * basis[(k + 1) * width + i];
      directions[i] = sum;
    }
    normalise(directions, width);
    if (this.columns.amend_first) this.amend(performance, ownS, directions, width);
  }

  /** What frames miss: the broken lines of some bones, from knot to knot. */
  amend({ row, durationS }, ownS, directions, width) {
    const { amend_first: first, amend_bone: bone, amend_at_s: at, amend_by: by, amend_step: step } = this.columns;
    const now = Math.min(Math.max(ownS, 0), durationS);
    for (let k = first[row]; k + 1 < first[row + 1]; k++) {
      if (bone[k] !== bone[k + 1] || at[k] > now || now >= at[k + 1]) continue;
      const u = (now - at[k]) / (at[k + 1] - at[k]);
      for (let c = 0, i = k; c < 3; c++, i += at.length)
        directions[3 * bone[k] + c] += step[0] * ((1 - u) * unfolded(by[i]) + u * unfolded(by[i + 1]));
    }
    normalise(directions, width);
  }

  /** On the spline, which goes on straight beyond its first and its last control point. */
  between({ values, frames, durationS }, ownS) {
    const place = Math.min(Math.max(Math.min(ownS, durationS) * this.rateHz, 0), frames - 1);
    const cell = Math.max(Math.min(Math.floor(place), frames - 2), 0),
      u = place - cell,
      { scale } = this.columns;
    const v = 1 - u,
      next = Math.min(cell + 1, frames - 1);
    for (let c = 0; c < this.channels.length; c++) {
      const row = c * frames,
        b = values[row + cell],
        e = values[row + next],
        a = cell > 0 ? values[row + cell - 1] : 2 * b - e,
        g = cell + 2 < frames ? values[row + cell + 2] : 2 * e - b;
      const value = (v ** 3 * a + (4 - 3 * u * u * (1 + v)) * b + (4 - 3 * v * v * (1 + u)) * e + u ** 3 * g) / 6;
      this.channels[c] = value * scale[c];
    }
  }
}

/** 0, 1, 2, 3, 4 ... as 0, -1, 1, -2, 2 ... */
const unfolded = (value) => (value >>> 1) ^ -(value & 1);

/** Unit length for each three numbers of the first `width`. */
export function normalise(vectors, width) {
  for (let i = 0; i < width; i += 3) {
    const length = Math.max(Math.hypot(vectors[i], vectors[i + 1], vectors[i + 2]), 1e-12);
    vectors[i] /= length;
    vectors[i + 1] /= length;
    vectors[i + 2] /= length;
  }
}
