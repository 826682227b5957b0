// What moves without being a person: parts in buffers and stores, on benches, belts and vehicles, in hands; lamps.
import { BELT_M, PALLET_M, spot } from "./furniture.js";
import { mix, point } from "./vectors.js";

const BOX_M = 0.27,
  GAP_M = 0.32,
  A_LAYER = 9,
  DRAWN = 45;
const CARDBOARD = 0xd9a55b,
  VEHICLE = 0xf0b429,
  VEHICLE_DARK = 0x4a5563;
const BELT_KIND = 0,
  VEHICLE_KIND = 1;

/** How many boxes the parts of a variant take at most. */
export function partsCount({ stations, stores, workers }) {
  return (DRAWN + 6) * stations.length + DRAWN * stores.length + 2 * workers.length + 600;
}

/** Draw all parts of a world at its time; `busyProduct` is the product in work at each station, -1 unknown. */
export function placeParts(boxes, marks, world, productColours, stateColours) {
  const { variant } = world,
    busy = productsInWork(world);
  const colour = (product) => (product >= 0 ? productColours[product] : CARDBOARD);
  variant.stations.forEach((station, i) => {
    const now = world.station(i);
    if (station.buffer) stack(boxes, station.buffer, now.queue, station.facing);
    if (!station.levels_m) onBench(boxes, station, now.busy, colour(busy[i]));
    lamp(boxes, station, now.state >= 0 ? stateColours[now.state] : 0xd5dae0);
  });
  variant.stores.forEach((store, i) => stack(boxes, store, world.level(i), 0));
  world.moving((kind, worker, product, on) => {
    if (kind === BELT_KIND && on)
      boxes.add(on.x, on.y, BELT_M + BOX_M / 2, BOX_M, BOX_M, BOX_M, on.phi ?? 0, colour(product));
    else if (kind === VEHICLE_KIND && on) vehicle(boxes, marks, on, product >= 0 ? colour(product) : null);
    else if (worker >= 0) carried(boxes, world, worker, colour(product));
  });
}

/** A pallet's load, nine to a layer; what is more than DRAWN is said by the label. */
function stack(boxes, { x, y }, count, yaw) {
  for (let i = 0; i < Math.min(count, DRAWN); i++) {
    const layer = Math.floor(i / A_LAYER),
      cell = i % A_LAYER,
      shade = (i * 7 + layer) % 3;
    const dx = ((cell % 3) - 1) * GAP_M,
      dy = (Math.floor(cell / 3) - 1) * GAP_M,
      c = Math.cos(yaw),
      s = Math.sin(yaw);
    const z = PALLET_M + (layer + 0.5) * BOX_M;
    boxes.add(
      x + c * dx - s * dy,
      y + s * dx + c * dy,
      z,
      BOX_M,
      BOX_M,
      BOX_M - 0.015,
      yaw,
      [CARDBOARD, 0xd19c50, 0xe0ae68][shade],
    );
  }
}

function onBench(boxes, station, count, colour) {
  const high = station.automatic ? Math.max(station.height_m, 1.5) + 0.04 : station.height_m;
  for (let i = 0; i < Math.min(count, 5); i++) {
    const [x, y] = spot(station, 0.08, (i - (Math.min(count, 5) - 1) / 2) * 0.34);
    boxes.add(x, y, high + 0.11, 0.24, 0.28, 0.22, station.facing, colour);
  }
}

function lamp(boxes, station, colour) {
  const high = station.automatic ? Math.max(station.height_m, 1.5) : station.height_m;
  const [x, y] = spot(station, station.depth_m / 2 - 0.05, station.width_m / 2 - 0.07);
  boxes.add(x, y, high + 0.3, 0.025, 0.025, 0.6, 0, VEHICLE_DARK);
  boxes.add(x, y, high + 0.68, 0.1, 0.1, 0.2, station.facing, colour);
}

function vehicle(boxes, marks, { x, y, phi }, load) {
  const yaw = phi ?? 0,
    at = (ahead) => [x + Math.cos(yaw) * ahead, y + Math.sin(yaw) * ahead];
  boxes.add(x, y, 0.17, 1.05, 0.7, 0.22, yaw, VEHICLE);
  boxes.add(...at(-0.42), 0.5, 0.16, 0.66, 0.5, yaw, VEHICLE_DARK);
  if (load !== null) boxes.add(...at(0.1), 0.45, 0.5, 0.5, 0.34, yaw, load);
  marks.shadow(x, y, 0.003, 0.85, 0.4);
}

/** Between the hands, in front of who carries it. */
function carried(boxes, world, worker, colour) {
  const skeleton = world.present[worker];
  if (!skeleton) return;
  const joints = world.joints[worker],
    hands = ["left", "right"].map((side) =>
      ["hand", "wrist"].map((name) => skeleton.names.indexOf(`${side}_${name}`)).find((joint) => joint >= 0),
    );
  const root = point(joints, skeleton.root),
    yaw = world.headings[worker];
  const ahead = [root[0] + 0.34 * Math.cos(yaw), root[1] + 0.34 * Math.sin(yaw)];
  const high = hands.every((joint) => joint >= 0)
    ? mix(point(joints, hands[0]), point(joints, hands[1]), 0.5)[2]
    : root[2];
  boxes.add(ahead[0], ahead[1], Math.max(high, root[2] + 0.06), 0.26, 0.34, 0.24, yaw, colour);
}

/** The product that somebody works on at each station, -1 where nobody is known to. */
function productsInWork(world) {
  const busy = world.variant.stations.map(() => -1);
  for (let worker = 0; worker < world.nWorkers; worker++) {
    const { station, product } = world.doing(worker);
    if (station >= 0 && product >= 0) busy[station] = product;
  }
  return busy;
}
