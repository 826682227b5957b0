// Own time and the common clock, as emulator/warp.py, decode.py (places) and dwell_times.py (moving_share) have them.

/** The warp (T) of centred log ratios x (Q): a monotone cubic through the running sums of their shares. */
export function fromRatios(x, nTimes) {
  const n = x.length,
    most = Math.max(...x),
    rise = Float64Array.from(x, (value) => Math.exp(value - most));
  const sum = rise.reduce((a, b) => a + b, 0);
  for (let k = 0; k < n; k++) rise[k] /= sum;
  const level = new Float64Array(n + 1),
    slope = new Float64Array(n + 1);
  for (let k = 0; k < n; k++) level[k + 1] = level[k] + rise[k];
  slope[0] = rise[0];
  slope[n] = rise[n - 1];
  for (let k = 1; k < n; k++) slope[k] = (2 * rise[k - 1] * rise[k]) / (rise[k - 1] + rise[k]);
  const gamma = new Float64Array(nTimes);
  for (let t = 0; t < nTimes; t++) {
    const at = (t / (nTimes - 1)) * n,
      cell = Math.min(Math.floor(at), n - 1),
      u = at - cell;
    const h1 = u * u * (3 - 2 * u),
      h2 = u * (1 - u) ** 2,
      h3 = u * u * (u - 1);
    gamma[t] = (level[cell] + rise[cell] * h1 + slope[cell] * h2 + slope[cell + 1] * h3) / level[n];
  }
  return gamma;
}

/** A warp at a common moment in [0, 1], linear between. */
export function evaluate(gamma, at) {
  const cells = gamma.length - 1,
    place = Math.min(Math.max(at, 0), 1) * cells,
    low = Math.min(Math.floor(place), cells - 1);
  return gamma[low] + (gamma[low + 1] - gamma[low]) * (place - low);
}

/** Where a share of own time lies on the common clock, in cells; the ends are held. */
export function placeOf(gamma, share) {
  const last = gamma.length - 1,
    at = Math.min(Math.max(share, gamma[0]), gamma[last]);
  let low = 0,
    high = last - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (gamma[middle] <= at) low = middle;
    else high = middle - 1;
  }
  return low + (at - gamma[low]) / (gamma[low + 1] - gamma[low]);
}

/** Share of the moving time at a share of the whole time: it stands still while a pause lasts. */
export function movingShare(share, durationS, dwellS, dwellStartS) {
  let timeS = share * durationS,
    movingS = durationS;
  for (let j = 0; j < dwellS.length; j++) {
    movingS -= dwellS[j];
    timeS -= Math.min(Math.max(timeS - dwellStartS[j], 0), dwellS[j]);
  }
  return timeS / movingS;
}
