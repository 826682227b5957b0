// Soft shadows and coloured rings on the floor: one draw call, under everything that stands.
import {
  BufferAttribute,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
} from "three";

const VERTEX = `
attribute vec4 at; // x, y, z, radius
attribute vec4 tint; // colour and strength; a strength above 1 is a ring
varying vec2 way; varying vec4 ink;
void main() {
  way = position.xy;
  ink = tint;
  gl_Position = projectionMatrix * viewMatrix * vec4(at.xy + position.xy * at.w, at.z, 1.0);
}`;
const FRAGMENT = `
varying vec2 way; varying vec4 ink;
void main() {
  float far = length(way);
  float soft = 1.0 - smoothstep(0.0, 1.0, far);
  float inner = smoothstep(0.70, 0.76, far);
  float ring = (inner - smoothstep(0.94, 1.0, far)) * 0.9 + 0.22 * (1.0 - inner);
  float strength = ink.a > 1.0 ? ring * (ink.a - 1.0) : soft * ink.a;
  if (strength < 0.004) discard;
  gl_FragColor = vec4(ink.rgb, strength);
}`;

export class Marks {
  constructor(most) {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute(
      "position",
      new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3),
    );
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.at = new InstancedBufferAttribute(new Float32Array(4 * most), 4).setUsage(DynamicDrawUsage);
    this.tint = new InstancedBufferAttribute(new Float32Array(4 * most), 4).setUsage(DynamicDrawUsage);
    geometry.setAttribute("at", this.at);
    geometry.setAttribute("tint", this.tint);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
    });
    this.object = new Mesh(geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
    this.count = 0;
  }

  begin() {
    this.count = 0;
  }

  add(x, y, z, radius, colour, strength) {
    const i = 4 * this.count++;
    this.at.array.set([x, y, z, radius], i);
    this.tint.array.set([(colour >> 16) / 255, ((colour >> 8) & 255) / 255, (colour & 255) / 255, strength], i);
  }

  shadow(x, y, z, radius, strength) {
    this.add(x, y, z, radius, 0x1c222a, strength);
  }

  ring(x, y, z, radius, colour, strength = 1) {
    this.add(x, y, z, radius, colour, 1 + strength);
  }

  end() {
    this.object.geometry.instanceCount = this.count;
    for (const column of [this.at, this.tint]) {
      column.clearUpdateRanges();
      column.addUpdateRange(0, 4 * this.count);
      column.needsUpdate = true;
    }
  }
}
