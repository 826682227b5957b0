// A click on the floor: the person under it, else the station.
import { Vector3 } from "three";

const DRAG_PX = 5,
  NEAR_PX = 14;

export function pick(replay) {
  const canvas = document.getElementById("floor");
  let down = null;
  canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) replay.moved = true;
  });
  canvas.addEventListener("wheel", () => (replay.moved = true), { passive: true });
  canvas.addEventListener("click", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > DRAG_PX) return;
    const box = canvas.getBoundingClientRect(),
      found = under(replay, event.clientX - box.left, event.clientY - box.top);
    replay.choose(found);
    if (found && matchMedia("(max-width: 760px)").matches) replay.sheet(true);
  });
  replay.where = (kind, name) => {
    const box = canvas.getBoundingClientRect();
    for (const view of replay.views) {
      const world = replay.worlds[view.variant],
        index = world.variant[`${kind}s`].findIndex((one) => one.name === name);
      const points =
        index < 0 ? null : kind === "worker" ? spine(world, index) : corners(world.variant.stations[index]);
      if (!points) continue;
      const seen = points.map((point) => project(replay, view, point)),
        mean = (c) => seen.reduce((sum, p) => sum + p[c], 0) / seen.length;
      return [box.left + mean(0), box.top + mean(1)];
    }
    return null;
  };
}

function under(replay, x, y) {
  const view = replay.views.find((v) => x >= v.x && x < v.x + v.width && y >= v.y && y < v.y + v.height);
  if (!view) return null;
  const world = replay.worlds[view.variant],
    found = person(replay, view, world, x, y) ?? station(replay, view, world, x, y);
  return found && { variant: view.variant, ...found };
}

/** Whose line from the feet to the head is nearest, within his own width. */
function person(replay, view, world, x, y) {
  let best = null;
  for (let index = 0; index < world.nWorkers; index++) {
    const line = spine(world, index);
    if (!line) continue;
    const [a, , b] = line.map((point) => project(replay, view, point)),
      wide = Math.max(0.26 * view.height * a[3], NEAR_PX);
    const dx = b[0] - a[0],
      dy = b[1] - a[1],
      share = Math.min(Math.max(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    const off = Math.hypot(x - a[0] - share * dx, y - a[1] - share * dy) / wide;
    if (off < 1 && (!best || off < best.off)) best = { off, index };
  }
  return best && { kind: "worker", index: best.index };
}

/** The nearest station whose corners lie round the click. */
function station(replay, view, world, x, y) {
  let best = null;
  world.variant.stations.forEach((one, index) => {
    const seen = corners(one).map((point) => project(replay, view, point)),
      xs = seen.map((p) => p[0]),
      ys = seen.map((p) => p[1]);
    const inside =
      x >= Math.min(...xs) - 3 && x <= Math.max(...xs) + 3 && y >= Math.min(...ys) - 3 && y <= Math.max(...ys) + 3;
    if (inside && (!best || seen[0][2] < best.far)) best = { far: seen[0][2], index };
  });
  return best && { kind: "station", index: best.index };
}

function spine(world, index) {
  const skeleton = world.present[index];
  if (!skeleton) return null;
  const joints = world.joints[index],
    root = 3 * skeleton.root,
    head = skeleton.names.indexOf("head");
  const at = [joints[root], joints[root + 1], joints[root + 2]];
  const top = head >= 0 ? [joints[3 * head], joints[3 * head + 1], joints[3 * head + 2]] : [at[0], at[1], at[2] + 0.7];
  return [[at[0], at[1], 0.1], at, top];
}

function corners({ x, y, width_m: wide, depth_m: deep, height_m: high, facing }) {
  const c = Math.cos(facing),
    s = Math.sin(facing),
    found = [];
  for (const a of [-deep / 2, deep / 2])
    for (const b of [-wide / 2, wide / 2])
      for (const z of [0, high + 0.2]) found.push([x + c * a - s * b, y + s * a + c * b, z]);
  return found;
}

/** [x, y on the stage, distance, how much of the view's height a metre is there]. */
function project(replay, view, [x, y, z]) {
  const { camera } = replay.rig,
    point = new Vector3(x, y, z),
    far = point.distanceTo(camera.position);
  point.project(camera);
  const metre = camera.projectionMatrix.elements[5] / (2 * far);
  return [view.x + ((point.x + 1) / 2) * view.width, view.y + ((1 - point.y) / 2) * view.height, far, metre];
}
