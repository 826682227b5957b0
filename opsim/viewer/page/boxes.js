// Any number of boxes in one draw call: benches, machines, belts, parts, vehicles. Lit from the sky, face by face.
import {
  BoxGeometry,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
} from "three";

const VERTEX = `
attribute vec4 at; // middle and turn about the vertical
attribute vec3 size; attribute vec3 tint;
varying vec3 shade;
void main() {
  float c = cos(at.w), s = sin(at.w);
  mat2 turned = mat2(c, s, -s, c);
  vec3 place = position * size;
  vec3 n = vec3(turned * normal.xy, normal.z);
  float sun = max(dot(n, vec3(0.39, -0.52, 0.76)), 0.0);
  shade = tint * (0.60 + 0.11 * n.z + 0.38 * sun + 0.03 * n.x);
  gl_Position = projectionMatrix * viewMatrix * vec4(at.xy + turned * place.xy, at.z + place.z, 1.0);
}`;
const FRAGMENT = "varying vec3 shade; void main() { gl_FragColor = vec4(shade, 1.0); }";

export class Boxes {
  constructor(most) {
    const box = new BoxGeometry(1, 1, 1),
      geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", box.getAttribute("position"));
    geometry.setAttribute("normal", box.getAttribute("normal"));
    geometry.setIndex(box.getIndex());
    this.most = most;
    this.columns = [
      ["at", 4],
      ["size", 3],
      ["tint", 3],
    ].map(([name, width]) => {
      const column = new InstancedBufferAttribute(new Float32Array(width * most), width).setUsage(DynamicDrawUsage);
      geometry.setAttribute(name, column);
      return column;
    });
    this.object = new Mesh(geometry, new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT }));
    this.object.frustumCulled = false;
    this.count = 0;
  }

  begin() {
    this.count = 0;
  }

  /** A box with this middle, these sides (along its own x, y, z), turned by yaw; those beyond `most` are left out. */
  add(x, y, z, long, wide, high, yaw, colour) {
    if (this.count === this.most) return;
    const i = this.count++,
      [at, size, tint] = this.columns;
    at.array.set([x, y, z, yaw], 4 * i);
    size.array.set([long, wide, high], 3 * i);
    tint.array.set([(colour >> 16) / 255, ((colour >> 8) & 255) / 255, (colour & 255) / 255], 3 * i);
  }

  end() {
    this.object.geometry.instanceCount = this.count;
    for (const column of this.columns) {
      column.clearUpdateRanges();
      column.addUpdateRange(0, this.count * column.itemSize);
      column.needsUpdate = true;
    }
  }
}
