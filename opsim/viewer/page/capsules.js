// Any number of tapered capsules in one draw call: ends, radii, width and colour of each are read by the vertex shader.
import {
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  BufferAttribute,
  Mesh,
  ShaderMaterial,
} from "three";

/** Corners round a capsule, and of one end's rings the sines of their latitudes, from its tip to its edge. */
export const FINE = { around: 12, sines: [1, 0.87, 0.5, 0] };
export const COARSE = { around: 6, sines: [0.85, 0] };

const VERTEX = `
attribute float end;
attribute vec4 a; attribute vec4 b; // an end each: place and radius
attribute vec3 wa; attribute vec3 wb; // half its width there, sideways; 0: round
attribute vec3 tint;
varying vec3 shade;
void main() {
  vec3 axis = b.xyz - a.xyz;
  float far = length(axis);
  axis = far > 1e-6 ? axis / far : vec3(0.0, 0.0, 1.0);
  float r = mix(a.w, b.w, end);
  vec3 w = mix(wa, wb, end);
  float wide = length(w);
  vec3 u = wide > 1e-6 ? w : (abs(axis.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
  u = normalize(u - axis * dot(u, axis));
  wide = wide > 1e-6 ? wide : r;
  vec3 v = cross(axis, u);
  vec3 place = mix(a.xyz, b.xyz, end) + u * (wide * position.x) + v * (r * position.y) + axis * (r * position.z);
  // Wide ones meet end to end: without a slope no seam is seen.
  float slope = length(w) > 1e-6 ? 0.0 : (a.w - b.w) / max(far, 0.05) * (1.0 - abs(position.z));
  vec3 n = u * (position.x / wide) + v * (position.y / r) + axis * ((position.z + slope) / r);
  n = normalize(n);
  vec3 towards = vec3(viewMatrix[0][2], viewMatrix[1][2], viewMatrix[2][2]);
  vec3 seen = isOrthographic ? towards : normalize(cameraPosition - place);
  float sky = 0.5 + 0.5 * n.z;
  float sun = max(dot(n, vec3(0.39, -0.52, 0.76)), 0.0);
  float rim = smoothstep(0.0, 0.75, dot(n, seen));
  shade = tint * (0.50 + 0.21 * sky + 0.40 * sun) * (0.80 + 0.20 * rim);
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}`;
const FRAGMENT = "varying vec3 shade; void main() { gl_FragColor = vec4(shade, 1.0); }";
const NUMBERS = { a: 4, b: 4, wa: 3, wb: 3, tint: 3 };

export class Capsules {
  constructor(most, grain = FINE) {
    this.geometry = unit(grain);
    this.columns = {};
    for (const [name, size] of Object.entries(NUMBERS)) {
      const column = new InstancedBufferAttribute(new Float32Array(size * most), size).setUsage(DynamicDrawUsage);
      this.geometry.setAttribute(name, column);
      this.columns[name] = column;
    }
    this.object = new Mesh(this.geometry, new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT }));
    this.object.frustumCulled = false;
    this.begin();
  }

  begin() {
    this.count = 0;
  }

  /** From (ax, ay, az) to (bx, by, bz); wa, wb: half widths as vectors [x, y, z], or null for a round one. */
  add(ax, ay, az, ra, bx, by, bz, rb, colour, wa = null, wb = null) {
    const i = this.count++,
      { a, b, tint } = this.columns;
    set4(a.array, 4 * i, ax, ay, az, ra);
    set4(b.array, 4 * i, bx, by, bz, rb);
    set3(this.columns.wa.array, 3 * i, wa);
    set3(this.columns.wb.array, 3 * i, wb);
    tint.array[3 * i] = (colour >> 16) / 255;
    tint.array[3 * i + 1] = ((colour >> 8) & 255) / 255;
    tint.array[3 * i + 2] = (colour & 255) / 255;
  }

  end() {
    this.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
    for (const [name, column] of Object.entries(this.columns)) {
      column.clearUpdateRanges();
      column.addUpdateRange(0, this.count * NUMBERS[name]);
      column.needsUpdate = true;
    }
  }
}

function set4(array, at, x, y, z, w) {
  array[at] = x;
  array[at + 1] = y;
  array[at + 2] = z;
  array[at + 3] = w;
}
function set3(array, at, vector) {
  array[at] = vector ? vector[0] : 0;
  array[at + 1] = vector ? vector[1] : 0;
  array[at + 2] = vector ? vector[2] : 0;
}

/** A capsule of radius 1 with flat tips where its first sine is below 1. */
function unit({ around, sines }) {
  const rings = [...sines.map((sine) => [0, -sine]), ...sines.map((sine) => [1, sine]).reverse()],
    last = rings.length - 1;
  const places = [],
    ends = [],
    corners = [];
  for (const [end, sine] of rings)
    for (let k = 0; k < around; k++) {
      const angle = (2 * Math.PI * k) / around,
        cosine = Math.sqrt(Math.max(0, 1 - sine * sine));
      places.push(Math.cos(angle) * cosine, Math.sin(angle) * cosine, sine);
      ends.push(end);
    }
  const isPole = (ring) => Math.abs(rings[ring][1]) === 1;
  for (let ring = 0; ring < last; ring++)
    for (let k = 0; k < around; k++) {
      const p = ring * around + k,
        q = ring * around + ((k + 1) % around);
      if (!isPole(ring)) corners.push(p, q, q + around);
      if (!isPole(ring + 1)) corners.push(p, q + around, p + around);
    }
  for (let k = 1; k + 1 < around && !isPole(0); k++) {
    const top = last * around;
    corners.push(0, k + 1, k, top, top + k, top + k + 1);
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
  geometry.setAttribute("end", new BufferAttribute(new Float32Array(ends), 1));
  geometry.setIndex(corners);
  return geometry;
}
