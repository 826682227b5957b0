// The frames of performances that stand side by side: whole mm in the page, metres here.

/** film: what opsim.report.animated writes. */
export class Film {
  constructor(film) {
    this.rate = film.rate_hz;
    this.size = 3 * film.joints;
    this.frames = film.cards.map(unpacked);
    this.longest = Math.max(...this.frames.map((frames) => this.lasts(frames)));
    this.end = this.longest + film.hold_s;
  }

  lasts(frames) {
    return (frames.length / this.size - 1) / this.rate;
  }

  /** The joints of card i, straight between frames; before and after, its first and last posture. */
  joints(i, time) {
    const frames = this.frames[i], n = this.size, last = frames.length / n - 1;
    const place = Math.min(Math.max(time * this.rate, 0), last), low = Math.min(Math.floor(place), last - 1);
    const share = place - low, joints = new Float32Array(n);
    for (let j = 0; j < n; j++) joints[j] = (1 - share) * frames[low * n + j] + share * frames[(low + 1) * n + j];
    return joints;
  }

  /** How far card i is at a time, as a share of the longest. */
  share(i, time) {
    return Math.min(time, this.lasts(this.frames[i])) / this.longest;
  }
}

function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer), metres = new Float32Array(bytes.length / 2);
  for (let i = 0; i < metres.length; i++) metres[i] = view.getInt16(2 * i, true) / 1000;
  return metres;
}
