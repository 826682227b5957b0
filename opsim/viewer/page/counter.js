// Pictures a second, over the last second in which pictures followed each other.

const APART_MS = 500,
  OVER_MS = 1000;

export class Counter {
  constructor() {
    this.fps = 0;
    this.drawn = [];
  }

  /** A picture at `now` ms. */
  count(now) {
    if (this.drawn.length && now - this.drawn[this.drawn.length - 1] > APART_MS) this.drawn = [];
    this.drawn.push(now);
    while (now - this.drawn[0] > OVER_MS) this.drawn.shift();
    if (this.drawn.length > 2) this.fps = ((this.drawn.length - 1) * 1000) / (now - this.drawn[0]);
  }
}
