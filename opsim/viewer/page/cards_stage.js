// Bodies on squared ground, seen without perspective as opsim.report.camera says: all on one canvas that covers the
// window, each over its card. Reading a picture back into a canvas of each card's own would take half of the time.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments, OrthographicCamera, Scene, WebGLRenderer } from "three";
import { bodyOf } from "./body.js";
import { People } from "./people.js";

const AWAY_M = 50;

/** stage: the camera as Python gives it; skeleton: {names, parents}. */
export class Stage {
  constructor(canvas, stage, skeleton) {
    Object.assign(this, { canvas, stage });
    this.body = bodyOf(skeleton, "limbs");
    this.people = new People(1, this.body.pieces);
    this.ground = ground(stage);
    this.scene = new Scene();
    this.scene.add(this.ground, this.people.object);
    const low = -stage.wide * Math.sin(stage.lift);
    this.camera = new OrthographicCamera(-stage.wide, stage.wide, low + tall(stage), low, 1, 2 * AWAY_M);
    this.camera.up.set(0, 0, 1);
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.setScissorTest(true);
  }

  /** Width of a picture as a share of its height. */
  get aspect() {
    return (2 * this.stage.wide) / tall(this.stage);
  }

  /** A clean window; it lies where the page is scrolled to, and scrolls with it until the next picture. */
  begin() {
    const wide = document.documentElement.clientWidth, high = innerHeight, dense = Math.min(devicePixelRatio || 1, 2);
    if (wide !== this.wide || high !== this.high || dense !== this.dense) {
      Object.assign(this, { wide, high, dense });
      this.renderer.setPixelRatio(dense);
      this.renderer.setSize(wide, high);
    }
    this.canvas.style.transform = `translateY(${scrollY}px)`;
    this.renderer.setScissor(0, 0, wide, high);
    this.renderer.clear();
  }

  /** Paint joints (3J, metres) as seen from `turn` degrees round over an element of the page, if that is in sight. */
  paint(element, joints, turn) {
    const box = element.getBoundingClientRect();
    if (box.bottom < 0 || box.top > this.high) return;
    const { stage } = this, root = 3 * this.body.root;
    const [x, y] = stage.follow ? [joints[root], joints[root + 1]] : stage.middle;
    squares(this.ground.geometry, stage, x, y);
    look(this.camera, x, y, stage.floor, (turn * Math.PI) / 180, stage.lift);
    this.people.begin();
    this.people.add(this.body, joints, null, stage.floor);
    this.people.end();
    const place = [box.left, this.high - box.bottom, box.width, box.height];
    this.renderer.setViewport(...place);
    this.renderer.setScissor(...place);
    this.renderer.render(this.scene, this.camera);
  }
}

/** Height of a picture in metres. */
function tall(stage) {
  return (stage.tall - stage.floor) * Math.cos(stage.lift) + 2 * stage.wide * Math.sin(stage.lift);
}

function look(camera, x, y, z, angle, lift) {
  const flat = AWAY_M * Math.cos(lift);
  camera.position.set(x + flat * Math.cos(angle), y + flat * Math.sin(angle), z + AWAY_M * Math.sin(lift));
  camera.lookAt(x, y, z);
  camera.updateMatrixWorld();
}

const reach = (stage) => stage.wide - 0.04;

function ground(stage) {
  const most = 2 * (Math.floor((2 * reach(stage)) / stage.square) + 2), geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(6 * most), 3).setUsage(DynamicDrawUsage));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color: 0xdde2e8 }));
  lines.frustumCulled = false;
  return lines;
}

/** The lines of the squares that lie within reach of (x, y), as long as the circle is wide there. */
function squares(geometry, stage, x, y) {
  const places = geometry.attributes.position, middle = [x, y];
  let n = 0;
  for (const axis of [0, 1]) {
    const last = Math.floor((middle[axis] + reach(stage)) / stage.square);
    for (let k = Math.ceil((middle[axis] - reach(stage)) / stage.square); k <= last; k++) {
      const off = k * stage.square - middle[axis], half = Math.sqrt(Math.max(0, reach(stage) ** 2 - off ** 2));
      for (const end of [-half, half]) {
        const place = [0, 0, stage.floor];
        place[axis] = k * stage.square;
        place[1 - axis] = middle[1 - axis] + end;
        places.setXYZ(n++, ...place);
      }
    }
  }
  geometry.setDrawRange(0, n);
  places.needsUpdate = true;
}
