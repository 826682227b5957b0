// Small plots with a cursor: RULA over time, jobs in a queue over time. A click goes to that moment.
import { rulaClass } from "./colours.js";

const INK = "#22262b",
  MUTED = "#5c6570",
  LINE = "#e3e6ea",
  BAR = "#0072B2";
const LEFT = 22,
  FOOT = 4,
  TOP = 5;

/** One plot on a canvas: `paint(g, x, y)` draws what is behind the cursor, once for each `key`. */
export class Plot {
  constructor(canvas, seek) {
    this.canvas = canvas;
    this.still = document.createElement("canvas");
    this.key = null;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.go(event, seek);
    });
    canvas.addEventListener(
      "pointermove",
      (event) => canvas.hasPointerCapture(event.pointerId) && this.go(event, seek),
    );
  }

  go(event, seek) {
    const box = this.canvas.getBoundingClientRect();
    const share = (event.clientX - box.left - LEFT) / (box.width - LEFT - 1);
    seek(this.lowS + Math.min(Math.max(share, 0), 1) * (this.highS - this.lowS));
  }

  draw(key, lowS, highS, timeS, most, ticks, paint) {
    const dense = Math.min(window.devicePixelRatio || 1, 2),
      { canvas, still } = this;
    const width = Math.round(canvas.clientWidth * dense),
      height = Math.round(canvas.clientHeight * dense);
    if (!width) return;
    Object.assign(this, { lowS, highS });
    const full = `${key} ${width} ${height} ${lowS} ${highS}`;
    if (this.key !== full) {
      this.key = full;
      canvas.width = still.width = width;
      canvas.height = still.height = height;
      this.background(still.getContext("2d"), dense, width, height, most, ticks, paint);
    }
    const g = canvas.getContext("2d"),
      x = LEFT * dense + ((timeS - lowS) / (highS - lowS || 1)) * (width - (LEFT + 1) * dense);
    g.clearRect(0, 0, width, height);
    g.drawImage(still, 0, 0);
    g.fillStyle = INK;
    g.fillRect(Math.round(x - dense / 2), 0, Math.max(1.5 * dense, 1), height);
  }

  background(g, dense, width, height, most, ticks, paint) {
    const y = (value) => height - FOOT * dense - (value / most) * (height - (FOOT + TOP) * dense);
    g.clearRect(0, 0, width, height);
    g.font = `${10 * dense}px system-ui, sans-serif`;
    g.textAlign = "right";
    g.textBaseline = "middle";
    for (const tick of ticks) {
      g.fillStyle = LINE;
      g.fillRect(LEFT * dense, Math.round(y(tick)), width, Math.max(1, Math.round(dense)));
      g.fillStyle = MUTED;
      g.fillText(String(tick), (LEFT - 5) * dense, y(tick));
    }
    paint(g, LEFT * dense, width - (LEFT + 1) * dense, y, dense);
  }
}

/** For each pixel column the range of RULA scores within it, each score in the colour of its class. */
export function paintRula(world, worker, lowS, highS) {
  return (g, left, wide, y) => {
    for (let x = 0; x < wide; x++) {
      const from = lowS + (x / wide) * (highS - lowS),
        to = lowS + ((x + 1) / wide) * (highS - lowS);
      const found = range(world, worker, from, to);
      if (!found) continue;
      for (let score = found[0]; score <= found[1]; score++) {
        g.fillStyle = rulaClass(score).colour;
        g.fillRect(left + x, y(score + 0.5), 1, y(score - 0.5) - y(score + 0.5));
      }
    }
  };
}

function range(world, worker, from, to) {
  let least = 8,
    most = 0;
  for (let at = from; at < Math.max(to, from + 1e-6); at += 0.25) {
    const score = world.rula(worker, at);
    if (!score) continue;
    least = Math.min(least, score[0]);
    most = Math.max(most, score[1]);
  }
  return most ? [least, most] : null;
}

/** Steps of a station's queue as a filled line. */
export function paintQueue(world, station, lowS, highS) {
  const { st_first: first, st_at_s: at, st_queue: queue } = world.c;
  return (g, left, wide, y) => {
    const x = (timeS) => left + ((Math.min(Math.max(timeS, lowS), highS) - lowS) / (highS - lowS || 1)) * wide;
    g.fillStyle = BAR;
    for (let row = first[station]; row < first[station + 1]; row++) {
      const end = row + 1 < first[station + 1] ? at[row + 1] : highS;
      if (end < lowS || at[row] > highS || !queue[row]) continue;
      g.fillRect(x(at[row]), y(queue[row]), Math.max(x(end) - x(at[row]), 1), y(0) - y(queue[row]));
    }
  };
}

export function longestQueue(world, station) {
  let most = 1;
  for (let row = world.c.st_first[station]; row < world.c.st_first[station + 1]; row++)
    most = Math.max(most, world.c.st_queue[row]);
  return most;
}
