// The canvas: one WebGL renderer, one viewport a variant. In software it draws without smoothing while things move, and
// once more in twice the size when they rest.
import { ColorManagement, LinearSRGBColorSpace, WebGLRenderer } from "three";

ColorManagement.enabled = false; // colours are meant as they are written
const BEHIND = 0xeef1f4;

export class Sight {
  /** Throws where the browser has no WebGL. */
  constructor(canvas) {
    this.soft = isSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.soft, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setClearColor(BEHIND);
    this.renderer.setScissorTest(true);
    this.canvas = canvas;
    this.fine = !this.soft;
  }

  get words() {
    return this.soft ? "software" : "graphics card";
  }

  resize(width, height) {
    Object.assign(this, { width, height });
    this.sharpen(!this.soft);
  }

  /** Twice as many points where that can be afforded: always on a graphics card, else only for a picture at rest. */
  sharpen(fine) {
    const ratio = this.soft ? (fine ? 2 : 1) : Math.min(window.devicePixelRatio || 1, 2);
    this.fine = fine || !this.soft;
    if (
      this.ratio === ratio &&
      this.canvas.width === Math.floor(this.width * ratio) &&
      this.canvas.height === Math.floor(this.height * ratio)
    )
      return;
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.width, this.height, false);
  }

  /** views: [{scene, x, y, width, height}] in pixels of the page from the upper left. */
  draw(views, camera) {
    for (const { scene, x, y, width, height } of views) {
      this.renderer.setViewport(x, this.height - y - height, width, height);
      this.renderer.setScissor(x, this.height - y - height, width, height);
      this.renderer.render(scene, camera);
    }
  }
}

function isSoftware() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Error("no WebGL");
  const known = probe.getExtension("WEBGL_debug_renderer_info");
  const name = String(probe.getParameter(known ? known.UNMASKED_RENDERER_WEBGL : probe.RENDERER));
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
