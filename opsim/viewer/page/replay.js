// The replay: keeps clock, camera, choice and colours together, and draws when something changes.
import { shirtsOf } from "./colours.js";
import { wire } from "./controls.js";
import { Counter } from "./counter.js";
import { sizesIn } from "./detail.js";
import { Floor } from "./floor.js";
import { fillLegends, fillLists, valueOf } from "./lists.js";
import { Panel, write } from "./panel.js";
import { clockText, Player } from "./player.js";
import { Rig } from "./rig.js";
import { summaryOf } from "./summary.js";
import { layViews, reservedIn, viewOf } from "./views.js";

const PANEL_MS = 120,
  SHARPEN_MS = 220,
  NARROW_PX = 600;
const COVERED_PX = { title: 44, names: 18, buttons: 30, legend: 42 };
const $ = (id) => document.getElementById(id);

export class Replay {
  constructor(worlds, sight) {
    const lowS = Math.min(...worlds.map(({ variant }) => variant.low_s));
    const highS = Math.max(...worlds.map(({ variant }) => variant.high_s));
    Object.assign(this, { worlds, sight, views: [], counter: new Counter() });
    Object.assign(this, { chosen: null, by: "state" }); // chosen: {variant, kind, index}
    Object.assign(this, { changedAt: 0, sharpAt: 0, toldAt: 0, waiting: 0, fromAbove: false, moved: false });
    this.shown = worlds.length > 1 ? [0, 1] : [0];
    this.floors = worlds.map((world) => new Floor(world));
    this.player = new Player(lowS, highS, () => this.changed());
    this.panel = new Panel((timeS) => this.player.seek(timeS));
    this.rig = new Rig($("floor"), () => this.changed());
    this.rig.bounds = boundsOfAll(this.floors);
    wire(this);
    this.show(this.shown);
    this.rig.whole(false, true);
  }

  // What a visitor, a test or a key may ask for.

  /** One variant, or two side by side. */
  show(variants) {
    this.shown = variants;
    if (this.chosen && !variants.includes(this.chosen.variant)) this.choose(null);
    fillLists(this);
    fillLegends(this);
    this.lay();
  }

  choose(chosen) {
    this.chosen = chosen;
    const follows = this.rig.following && chosen && chosen.kind === "worker";
    this.rig.following = follows ? () => this.whereIs(chosen) : null;
    for (const { variant, labels, named } of this.views)
      labels.choose(chosen && variant === chosen.variant ? named[chosen.kind][chosen.index] : null);
    for (const kind of ["worker", "station"]) $(`${kind}s`).value = valueOf(chosen, kind);
    write($("said"), chosen ? `${chosen.kind} ${this.nameOf(chosen)} chosen` : "nothing chosen");
    this.toldAt = 0;
    this.changed();
  }

  colour(by) {
    this.by = by;
    $("colour").value = by;
    fillLegends(this);
    this.changed();
  }

  whole() {
    this.fromAbove = this.moved = false;
    this.rig.whole();
  }

  top() {
    this.fromAbove = !this.fromAbove;
    this.moved = false;
    this.rig.whole(this.fromAbove);
  }

  follow() {
    const { chosen } = this;
    if (this.rig.following) this.rig.following = null;
    else if (chosen && chosen.kind === "worker") {
      this.fromAbove = false;
      this.rig.follow(() => this.whereIs(chosen));
    }
    this.changed();
  }

  /** The panel, on narrow pages. */
  sheet(open) {
    $("panel").classList.toggle("open", open);
    $("details").setAttribute("aria-expanded", open);
    this.toldAt = 0;
    this.changed();
  }

  /** Open the notes: what is shown, what is not known, which keys there are. */
  notes() {
    this.sheet(true);
    const notes = document.querySelector(".notes");
    notes.open = true;
    notes.querySelector("summary").focus();
  }

  // What it knows.

  nameOf({ variant, kind, index }) {
    return this.worlds[variant].variant[`${kind}s`][index].name;
  }

  whereIs({ variant, index }) {
    const world = this.worlds[variant],
      skeleton = world.present[index],
      joints = world.joints[index];
    return skeleton && [joints[3 * skeleton.root], joints[3 * skeleton.root + 1], 0.9];
  }

  get clock() {
    return clockText(this.worlds[this.shown[0]].variant.start_s + this.player.timeS);
  }

  // How it is drawn.

  /** Lay the views on the stage as it is now. */
  lay() {
    const width = $("stage").clientWidth,
      height = $("stage").clientHeight;
    if (!width || !height) return;
    this.sight.resize(width, height);
    if (this.views.map((view) => view.variant).join() !== this.shown.join())
      this.views = this.shown.map((v) => viewOf(this, v));
    layViews(this.views, width, height);
    $("views").replaceChildren(...this.views.map((view) => view.element));
    for (const view of this.views) view.reserved = reservedIn(view);
    this.aim(this.views[0], width < NARROW_PX);
    this.changed();
  }

  /** The camera to the shape of a view; the whole floor again, unless somebody has turned to something. */
  aim(view, narrow) {
    const above = this.views.length > 1 ? COVERED_PX.title : COVERED_PX.names + (narrow ? COVERED_PX.buttons : 0);
    const before = this.rig.camera.aspect;
    this.rig.free = { above: above / view.height, below: COVERED_PX.legend / view.height };
    this.rig.aspect(view.width / view.height);
    const reshaped = Math.abs(before - this.rig.camera.aspect) > 0.02;
    if (reshaped && !this.rig.following && !this.moved) this.rig.whole(this.fromAbove, true);
  }

  /** Something changed: one picture is drawn, at the browser's next chance. */
  changed() {
    this.changedAt = performance.now();
    if (this.waiting) return;
    this.waiting = requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    cancelAnimationFrame(this.waiting); // a picture that is asked for at once takes the place of the one to come
    this.waiting = 0;
    this.player.tick(now);
    if (this.changedAt > this.sharpAt) this.sight.sharpen(false);
    for (const v of this.shown) this.worlds[v].seek(this.player.timeS);
    const flies = this.rig.tick(now);
    this.draw();
    this.counter.count(now);
    this.tell(now);
    if (this.player.playing || flies) this.changed();
    else this.rest();
  }

  draw() {
    for (const view of this.views) {
      const floor = this.floors[view.variant],
        { chosen } = this;
      const mine = chosen && chosen.variant === view.variant ? chosen : null;
      floor.draw(shirtsOf(floor.world, this.by), mine, sizesIn(this.rig.camera, view.height));
      view.scene = floor.scene;
    }
    this.sight.draw(this.views, this.rig.camera);
    for (const { labels, width, height, reserved } of this.views) labels.draw(this.rig.camera, width, height, reserved);
  }

  /** When nothing has changed for a moment, once more and finer. */
  rest() {
    clearTimeout(this.later);
    if (!this.sight.soft || this.sight.fine) return;
    this.later = setTimeout(() => {
      if (this.waiting || this.player.playing) return;
      this.sight.sharpen(true);
      this.sharpAt = performance.now();
      this.sight.draw(this.views, this.rig.camera);
    }, SHARPEN_MS);
  }

  /** The bar at every picture; words and plots some eight times a second, and when all is at rest. */
  tell(now) {
    const { player } = this;
    write($("play"), player.playing ? "Pause" : "Play");
    write($("clock"), this.clock);
    $("time").value = player.timeS;
    $("time").setAttribute("aria-valuetext", this.clock);
    $("speed").value = String(player.speed);
    $("top").setAttribute("aria-pressed", this.fromAbove);
    $("follow").setAttribute("aria-pressed", this.rig.following !== null);
    $("follow").disabled = !(this.chosen && this.chosen.kind === "worker");
    if (player.playing && now - this.toldAt < PANEL_MS) return;
    this.toldAt = now;
    this.explain();
  }

  explain() {
    const several = this.shown.length > 1,
      world = this.worlds[this.chosen ? this.chosen.variant : this.shown[0]];
    this.panel.draw(world, this.chosen, several);
    write($("summary"), several ? "" : summaryOf(world));
    for (const view of this.views) write(view.words, several ? summaryOf(this.worlds[view.variant]) : "");
    const pace = `${this.counter.fps.toFixed(0)} pictures a second while it played last`;
    write($("counter"), `Drawn by ${this.sight.words}; ${pace}.`);
  }
}

function boundsOfAll(floors) {
  const all = floors.map((floor) => floor.bounds);
  return [0, 1, 2, 3].map((side) => (side < 2 ? Math.min : Math.max)(...all.map((bounds) => bounds[side])));
}
