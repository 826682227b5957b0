// The clock of the page. Everything that shows whether it plays is told by `changed`, whoever started or stopped it.

const LONGEST_STEP_S = 0.25; // a page that slept does not leap when it wakes

export class Player {
  constructor(lowS, highS, changed) {
    Object.assign(this, { lowS, highS, changed, timeS: lowS, speed: 1, playing: false, before: null });
  }

  get atEnd() {
    return this.timeS >= this.highS;
  }

  play() {
    if (this.playing) return;
    if (this.atEnd) this.timeS = this.lowS;
    this.playing = this.highS > this.lowS;
    this.before = null;
    this.changed();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  /** Go to a time; playing goes on, but not beyond the end. */
  seek(timeS) {
    this.timeS = Math.min(Math.max(Number.isFinite(timeS) ? timeS : this.lowS, this.lowS), this.highS);
    this.before = null;
    if (this.atEnd) this.playing = false;
    this.changed();
  }

  atSpeed(speed) {
    this.speed = speed;
    this.changed();
  }

  /** The next picture, at `now` ms. */
  tick(now) {
    if (!this.playing) return;
    const step = this.before === null ? 0 : Math.min((now - this.before) / 1000, LONGEST_STEP_S);
    this.before = now;
    this.timeS = Math.min(this.timeS + step * this.speed, this.highS);
    if (this.atEnd) this.pause();
  }
}

const DAYS = ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"];

/** Seconds after a Monday 00:00 as "Tue 13:05:09"; from the second week on "Tue 13:05:09, week 2". */
export function clockText(seconds) {
  const whole = Math.floor(seconds + 1e-6),
    day = Math.floor(whole / 86400),
    two = (n) => String(n).padStart(2, "0");
  const of = whole - day * 86400,
    week = Math.floor(day / 7);
  const time = [of / 3600, (of / 60) % 60, of % 60].map((part) => two(Math.floor(part))).join(":");
  const text = `${DAYS[((day % 7) + 7) % 7]} ${time}`;
  return week > 0 ? `${text}, week ${week + 1}` : text;
}
