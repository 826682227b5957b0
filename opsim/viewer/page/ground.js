// The floor: a light plane with a grid of metres, and roads. Drawn first and without depth, so that nothing flickers.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
} from "three";

const FLOOR = 0xfbfcfd,
  ROAD = 0xe9edf1,
  METRE = 0xedf0f3,
  FIVE_METRES = 0xdde2e8;
const ROAD_M = 1.1,
  ROUND = 12;

export function groundOf([west, south, east, north], paths) {
  const group = new Group(),
    x0 = Math.floor(west),
    x1 = Math.ceil(east),
    y0 = Math.floor(south),
    y1 = Math.ceil(north);
  group.add(flat([x0, y0, x1, y0, x1, y1, x0, y0, x1, y1, x0, y1], FLOOR, -4));
  group.add(
    lines(
      gridOf(x0, x1, y0, y1, (k) => k % 5 !== 0),
      METRE,
      -3,
    ),
  );
  group.add(
    lines(
      gridOf(x0, x1, y0, y1, (k) => k % 5 === 0),
      FIVE_METRES,
      -3,
    ),
  );
  if (paths.length) group.add(flat(paths.flatMap(roadOf), ROAD, -2));
  return group;
}

function gridOf(x0, x1, y0, y1, wanted) {
  const points = [];
  for (let x = x0; x <= x1; x++) if (wanted(x)) points.push(x, y0, x, y1);
  for (let y = y0; y <= y1; y++) if (wanted(y)) points.push(x0, y, x1, y);
  return points;
}

/** Triangles of a road along a line of points [x, y, x, y, ...], round at every point. */
function roadOf(path) {
  const corners = [],
    half = ROAD_M / 2;
  for (let i = 0; i < path.length; i += 2) {
    const x = path[i],
      y = path[i + 1];
    for (let k = 0; k < ROUND; k++) {
      const a = (2 * Math.PI * k) / ROUND,
        b = (2 * Math.PI * (k + 1)) / ROUND;
      corners.push(
        x,
        y,
        x + half * Math.cos(a),
        y + half * Math.sin(a),
        x + half * Math.cos(b),
        y + half * Math.sin(b),
      );
    }
    if (i === 0) continue;
    const px = path[i - 2],
      py = path[i - 1],
      far = Math.hypot(x - px, y - py) || 1;
    const ox = (-(y - py) / far) * half,
      oy = ((x - px) / far) * half;
    corners.push(px - ox, py - oy, x - ox, y - oy, x + ox, y + oy, px - ox, py - oy, x + ox, y + oy, px + ox, py + oy);
  }
  return corners;
}

function placed(points) {
  const geometry = new BufferGeometry(),
    places = new Float32Array((points.length / 2) * 3);
  for (let i = 0; i < points.length / 2; i++) places.set([points[2 * i], points[2 * i + 1], 0], 3 * i);
  return geometry.setAttribute("position", new BufferAttribute(places, 3));
}

function flat(points, colour, order) {
  const mesh = new Mesh(placed(points), new MeshBasicMaterial({ color: colour, depthWrite: false, side: 2 }));
  mesh.renderOrder = order;
  return mesh;
}

function lines(points, colour, order) {
  const drawn = new LineSegments(placed(points), new LineBasicMaterial({ color: colour, depthWrite: false }));
  drawn.renderOrder = order;
  return drawn;
}
