// What stands still: benches, racks, machines, belts, pallets for buffers and stores.

const TOP = 0xc9d1da,
  LEG = 0x9aa5b1,
  MACHINE = 0xb9c4cf,
  WINDOW = 0x5b6b7c,
  PALLET = 0xd8c3a0,
  BELT = 0x6b7580,
  BELT_SIDE = 0xaab4be;
export const BELT_M = 0.72,
  BELT_WIDE_M = 0.5,
  PALLET_M = 0.1;

/** How many boxes the furniture of a variant takes at most. */
export function furnitureCount({ stations, stores, belts }) {
  const boards = stations.reduce((sum, { levels_m }) => sum + (levels_m || []).length, 0),
    rollers = belts.reduce((sum, belt) => sum + 4 * belt.points.length, 0);
  return 8 * stations.length + boards + 2 * stores.length + rollers + 1;
}

export function furnish(boxes, marks, variant) {
  variant.stations.forEach((station) =>
    (station.automatic ? machine : station.levels_m ? rack : bench)(boxes, marks, station),
  );
  for (const { buffer } of variant.stations) if (buffer) pallet(boxes, marks, buffer);
  for (const store of variant.stores) pallet(boxes, marks, store);
  for (const belt of variant.belts) conveyor(boxes, belt.points);
}

/** A spot in a station's own axes: `ahead` from who stands there, `left` of him. */
export function spot({ x, y, facing }, ahead, left) {
  const c = Math.cos(facing),
    s = Math.sin(facing);
  return [x + c * ahead - s * left, y + s * ahead + c * left];
}

function bench(boxes, marks, station) {
  const { width_m: wide, depth_m: deep, height_m: high, facing } = station;
  boxes.add(...spot(station, 0, 0), high - 0.025, deep, wide, 0.05, facing, TOP);
  for (const side of [-1, 1])
    boxes.add(
      ...spot(station, 0.02, side * (wide / 2 - 0.05)),
      (high - 0.05) / 2,
      deep * 0.86,
      0.05,
      high - 0.05,
      facing,
      LEG,
    );
  boxes.add(...spot(station, deep / 2 - 0.06, 0), (high - 0.05) * 0.6, 0.04, wide - 0.12, high * 0.5, facing, LEG);
  boxes.add(...spot(station, deep / 2 - 0.02, 0), high + 0.12, 0.03, wide, 0.24, facing, TOP);
  marks.shadow(station.x, station.y, 0.002, 0.62 * Math.hypot(wide, deep), 0.3);
}

/** Four posts, and a board whose top is at each level. */
function rack(boxes, marks, station) {
  const { width_m: wide, depth_m: deep, height_m: high, facing } = station;
  for (const ahead of [-1, 1])
    for (const side of [-1, 1])
      boxes.add(
        ...spot(station, ahead * (deep / 2 - 0.03), side * (wide / 2 - 0.03)),
        high / 2,
        0.06,
        0.06,
        high,
        facing,
        LEG,
      );
  for (const level of station.levels_m)
    boxes.add(...spot(station, 0, 0), Math.max(level - 0.02, 0.02), deep, wide, 0.04, facing, TOP);
  marks.shadow(station.x, station.y, 0.002, 0.62 * Math.hypot(wide, deep), 0.3);
}

function machine(boxes, marks, station) {
  const { width_m: wide, depth_m: deep, height_m, facing } = station,
    high = Math.max(height_m, 1.5);
  boxes.add(station.x, station.y, high / 2, deep, wide, high, facing, MACHINE);
  boxes.add(...spot(station, -deep / 2 - 0.005, 0), high * 0.66, 0.02, wide * 0.72, high * 0.36, facing, WINDOW);
  boxes.add(...spot(station, 0, 0), high + 0.02, deep * 0.9, wide * 0.94, 0.04, facing, TOP);
  marks.shadow(station.x, station.y, 0.002, 0.68 * Math.hypot(wide, deep), 0.34);
}

function pallet(boxes, marks, { x, y }) {
  boxes.add(x, y, PALLET_M / 2, 0.98, 0.98, PALLET_M, 0, PALLET);
  marks.shadow(x, y, 0.002, 0.85, 0.28);
}

function conveyor(boxes, points) {
  for (let i = 0; i + 1 < points.length; i++) {
    const [ax, ay] = points[i],
      [bx, by] = points[i + 1],
      far = Math.hypot(bx - ax, by - ay),
      yaw = Math.atan2(by - ay, bx - ax);
    const x = (ax + bx) / 2,
      y = (ay + by) / 2;
    boxes.add(x, y, BELT_M - 0.04, far, BELT_WIDE_M, 0.05, yaw, BELT);
    for (const side of [-1, 1]) {
      const ox = -Math.sin(yaw) * side * (BELT_WIDE_M / 2),
        oy = Math.cos(yaw) * side * (BELT_WIDE_M / 2);
      boxes.add(x + ox, y + oy, BELT_M - 0.04, far, 0.04, 0.1, yaw, BELT_SIDE);
    }
  }
}
