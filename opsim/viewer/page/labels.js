// Names over the floor. Where they would lie on each other those of people move a little, then the less important ones
// are left out; that of who is chosen never.
import { Vector3 } from "three";

/** So many pixels a metre must measure there for a name to be shown. */
const SMALLEST_PX = { station: 5, store: 5, worker: 11, place: 8 };

const SLACK_PX = 40; // that the name of who is chosen may be outside, and is pulled in
/** Where names of people may go: to the right in halves of their width, down in heights of theirs. */
const MOVES = [[0, 0], [0, -1], [0, 1], [1.1, 0], [-1.1, 0], [1.1, -1], [-1.1, -1], [0, -2], [0, 2]];

export class Labels {
  constructor(layer) {
    this.layer = layer;
    this.all = [];
    this.seen = new Vector3();
  }

  /** kind: a class for the style; rank: the lower the sooner it is shown; where: () => [x, y, z] or null;
   *  asideM: how far it is moved off its thing when seen from above. */
  add(text, kind, rank, where, asideM = 0) {
    const element = document.createElement("span");
    element.className = `label ${kind}`;
    element.textContent = text;
    element.hidden = true;
    this.layer.append(element);
    const label = { element, kind, rank, where, text, asideM, width: 0, height: 0, shown: false, chosen: false };
    this.all.push(label);
    return label;
  }

  write(label, text) {
    if (label.text === text) return;
    label.text = text;
    label.element.textContent = text;
    label.width = 0;
  }

  choose(label) {
    for (const one of this.all) {
      one.chosen = one === label;
      one.element.classList.toggle("chosen", one.chosen);
    }
  }

  /** Place them in a view of width x height pixels seen by the camera, clear of the boxes that are taken. */
  draw(camera, width, height, reserved = []) {
    const wanted = [];
    this.fromAbove = Math.max(0, camera.matrixWorld.elements[10] - 0.5) * 2; // 1 from above, 0 from 30 degrees on
    for (const label of this.all) {
      const at = label.where();
      const on = at && this.project(label, at, camera, width, height);
      if (on) wanted.push(label);
      else this.hide(label);
    }
    this.measure(wanted);
    wanted.sort((a, b) => b.chosen - a.chosen || a.rank - b.rank || b.shown - a.shown || a.far - b.far);
    const taken = [...reserved];
    for (const label of wanted) {
      const box = this.free(label, width, height, taken);
      if (!box) this.hide(label);
      else {
        taken.push(box);
        this.show(label);
      }
    }
  }

  /** Put a name where nothing is taken, the nearer to its thing the better; its box, or null where there is no room. */
  free(label, width, height, taken) {
    const { x, y } = label;
    for (const [right, down] of label.kind === "worker" ? MOVES : MOVES.slice(0, 1)) {
      const half = label.width / 2 + 2;
      label.x = Math.min(Math.max(x + right * half, half), width - half);
      label.y = Math.min(Math.max(y + down * (label.height + 2), label.height + 2), height - 2);
      const box = [label.x - half, label.y - label.height - 1, label.x + half, label.y + 1];
      if (!taken.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]) || label.chosen)
        return box;
    }
    return null;
  }

  project(label, at, camera, width, height) {
    this.seen.set(at[0], at[1], at[2]);
    label.far = this.seen.distanceTo(camera.position);
    this.seen.project(camera);
    const metre = (camera.projectionMatrix.elements[5] * height) / (2 * label.far);
    label.x = ((this.seen.x + 1) / 2) * width;
    label.y = ((1 - this.seen.y) / 2) * height - label.asideM * this.fromAbove * metre;
    const slack = label.chosen ? SLACK_PX : 0;
    return (
      this.seen.z < 1 &&
      (label.chosen || metre > SMALLEST_PX[label.kind]) &&
      label.x > 4 - slack &&
      label.x < width - 4 + slack &&
      label.y > 14 - slack &&
      label.y < height + slack
    );
  }

  /** Sizes are read once a text, all together: reading one by one would lay the page out again each time. */
  measure(labels) {
    const unknown = labels.filter((label) => !label.width);
    for (const label of unknown) label.element.hidden = false;
    for (const label of unknown) {
      label.width = label.element.offsetWidth;
      label.height = label.element.offsetHeight;
    }
  }

  show(label) {
    const place = `translate(${Math.round(label.x - label.width / 2)}px, ${Math.round(label.y - label.height)}px)`;
    if (label.place !== place) label.element.style.transform = label.place = place;
    if (!label.shown || label.element.hidden) label.element.hidden = false;
    label.shown = true;
  }

  hide(label) {
    if (!label.element.hidden) label.element.hidden = true;
    label.shown = false;
  }
}
