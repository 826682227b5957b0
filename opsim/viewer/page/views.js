// The views on the stage, one a shown variant: where each lies, its title and the names in it.
import { spot } from "./furniture.js";
import { Labels } from "./labels.js";

/** A view of one variant of the replay. */
export function viewOf(replay, variant) {
  const world = replay.worlds[variant],
    element = document.createElement("div");
  const title = document.createElement("h2"),
    words = document.createElement("small");
  element.className = "view";
  title.append(world.variant.name, words);
  title.hidden = replay.shown.length < 2;
  element.append(title);
  const labels = new Labels(element),
    view = { variant, element, title, words, labels, named: namesIn(world, labels) };
  const { chosen } = replay;
  if (chosen && chosen.variant === variant) labels.choose(view.named[chosen.kind][chosen.index]);
  return view;
}

/** Lay n views beside each other on a stage, or below each other where it is tall. */
export function layViews(views, width, height) {
  const n = views.length,
    beside = width >= height,
    at = (k, all) => Math.round((k * all) / n);
  views.forEach((view, i) => {
    view.x = beside ? at(i, width) : 0;
    view.y = beside ? 0 : at(i, height);
    view.width = beside ? at(i + 1, width) - view.x : width;
    view.height = beside ? height : at(i + 1, height) - view.y;
    const box = { left: view.x, top: view.y, width: view.width, height: view.height };
    for (const [name, px] of Object.entries(box)) view.element.style[name] = `${px}px`;
  });
}

/** What of a view the names must leave free. */
export function reservedIn({ title }) {
  const { offsetLeft: x, offsetTop: y, offsetWidth: wide, offsetHeight: high } = title;
  return title.hidden ? [] : [[x, y, x + wide, y + high]];
}

/** Labels for everything that has a name; returns those of workers and stations by number. */
function namesIn(world, labels) {
  const { stations, workers, stores, places } = world.variant,
    named = { worker: [], station: [] };
  stations.forEach((station, i) => {
    const [x, y] = spot(station, station.depth_m / 2 + 0.5, 0),
      where = () => [x, y, -0.1]; // in front of the bench, nobody's face
    named.station[i] = labels.add(station.name, "station", 1, where, -0.2);
  });
  workers.forEach(
    (worker, i) => (named.worker[i] = labels.add(worker.name, "worker", 2, () => headOf(world, i), 0.42)),
  );
  stores.forEach((store) => labels.add(store.name, "store", 3, () => [store.x, store.y, 0]));
  const taken = new Set([...stations.map((s) => (places[s.place] || s).name), ...stores.map((s) => s.name)]);
  for (const place of places)
    if (!taken.has(place.name)) labels.add(place.name, "place", 4, () => [place.x, place.y, 0]);
  return named;
}

/** Just above a worker; null while he is away. */
function headOf(world, worker) {
  const skeleton = world.present[worker],
    joints = world.joints[worker];
  if (!skeleton) return null;
  let high = 0;
  for (let j = 2; j < 3 * skeleton.names.length; j += 3) high = Math.max(high, joints[j]);
  return [joints[3 * skeleton.root], joints[3 * skeleton.root + 1], high + 0.24];
}
