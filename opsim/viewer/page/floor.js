// The picture of one variant: a three.js scene of its ground, furniture, parts and people, drawn at the world's time.
import { Scene } from "three";
import { bodyOf } from "./body.js";
import { Boxes } from "./boxes.js";
import { furnish, furnitureCount } from "./furniture.js";
import { groundOf } from "./ground.js";
import { Marks } from "./marks.js";
import { partsCount, placeParts } from "./parts.js";
import { People } from "./people.js";

const NEAR_PX = 75; // that a metre measures: below, nobody sees the corners
const MARGIN_M = 1.6,
  ACCENT = 0x111827;

export class Floor {
  constructor(world) {
    const { variant } = world;
    this.world = world;
    this.bounds = boundsOf(variant);
    this.scene = new Scene();
    this.bodies = new Map(world.skeletons.map((skeleton) => [skeleton, bodyOf(skeleton)]));
    this.people = new People(variant.workers.length);
    this.parts = new Boxes(partsCount(variant));
    this.marks = new Marks(300);
    this.productColours = variant.products.map((product) => colourOf(product.colour));
    this.stationColours = variant.station_states.map((state) => colourOf(state.colour));
    this.scene.add(groundOf(grown(this.bounds, MARGIN_M), variant.paths), ...this.still(variant));
    this.scene.add(this.marks.object, this.parts.object, this.people.object);
  }

  still(variant) {
    const boxes = new Boxes(furnitureCount(variant)),
      marks = new Marks(2 * variant.stations.length + variant.stores.length + 1);
    furnish(boxes, marks, variant);
    boxes.end();
    marks.end();
    marks.object.renderOrder = -1;
    return [marks.object, boxes.object];
  }

  /** shirts: {shirt, ring} of each worker; chosen: {kind, index} or null; sizes: of sizesIn(). */
  draw(shirts, chosen, sizes) {
    const { world } = this;
    this.people.begin();
    this.parts.begin();
    this.marks.begin();
    for (let worker = 0; worker < world.nWorkers; worker++) this.person(worker, shirts[worker], sizes);
    placeParts(this.parts, this.marks, world, this.productColours, this.stationColours);
    if (chosen) this.point(chosen);
    this.people.end();
    this.parts.end();
    this.marks.end();
  }

  person(worker, { shirt, ring }, sizes) {
    const skeleton = this.world.present[worker],
      joints = this.world.joints[worker];
    if (!skeleton) return;
    const root = 3 * skeleton.root,
      metre = sizes(joints[root], joints[root + 1], joints[root + 2]);
    if (metre) this.people.add(this.bodies.get(skeleton), joints, shirt, 0, ring, metre > NEAR_PX);
  }

  point({ kind, index }) {
    const { world } = this,
      station = world.variant.stations[index];
    if (kind === "station")
      this.marks.ring(
        station.x,
        station.y,
        0.006,
        0.5 * Math.hypot(station.width_m, station.depth_m) + 0.35,
        ACCENT,
        0.7,
      );
    else if (world.present[index]) {
      const root = 3 * world.present[index].root,
        joints = world.joints[index];
      this.marks.ring(joints[root], joints[root + 1], 0.006, 0.5, ACCENT, 0.6);
    }
  }
}

export const colourOf = (text) => parseInt(text.slice(1), 16);

/** [west, south, east, north] of everything that is drawn. */
function boundsOf({ stations, stores, belts, places, paths, reach }) {
  const points = [...stations, ...stations.map((s) => s.buffer).filter(Boolean), ...stores, ...places].map(
    ({ x, y }) => [x, y],
  );
  for (const belt of belts) points.push(...belt.points);
  for (const path of paths) for (let i = 0; i < path.length; i += 2) points.push([path[i], path[i + 1]]);
  if (reach) points.push(reach.slice(0, 2), reach.slice(2));
  if (!points.length) points.push([0, 0]);
  const xs = points.map((p) => p[0]),
    ys = points.map((p) => p[1]);
  return grown([Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)], 0.8);
}

const grown = ([west, south, east, north], by) => [west - by, south - by, east + by, north + by];
