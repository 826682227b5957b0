// The page of `opsim motion show`: a player for bodies that stand side by side, each in its card.
import { Film } from "./cards_film.js";
import { Stage } from "./cards_stage.js";

const $ = (id) => document.getElementById(id);

export function cards() {
  const said = JSON.parse($("film").textContent);
  try {
    const player = new Player(said);
    player.begin();
    window.opsimCards = { draw: () => player.draw() }; // for tests: what is drawn can be read only at once
  } catch (error) {
    $("wrong").textContent = `This browser cannot draw in three dimensions (WebGL): ${error.message}`;
    $("wrong").hidden = false;
    throw error;
  }
}

class Player {
  constructor(said) {
    this.film = new Film(said);
    this.stage = new Stage($("drawn"), said.camera, said.skeleton);
    this.cards = [...document.querySelectorAll(".card")].map((figure, number) => ({
      number,
      view: figure.querySelector(".view"),
      bar: figure.querySelector(".ends i"),
    }));
    for (const { view } of this.cards) view.style.aspectRatio = this.stage.aspect;
    Object.assign(this, { at: 0, speed: 1, turn: said.camera.turn_deg, playing: false, before: null });
  }

  begin() {
    this.listen();
    this.draw();
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play(true);
    document.documentElement.setAttribute("data-drawn", this.cards.length);
  }

  draw() {
    this.stage.begin();
    for (const { number, view, bar } of this.cards) {
      bar.style.width = `${100 * this.film.share(number, this.at)}%`;
      this.stage.paint(view, this.film.joints(number, this.at), this.turn);
    }
    $("time").value = this.at;
    $("clock").textContent = `${Math.min(this.at, this.film.longest).toFixed(1)} s`;
    $("turn").value = this.turn;
  }

  tick(now) {
    if (!this.playing) return;
    if (this.before !== null) this.at += (this.speed * (now - this.before)) / 1000;
    if (this.at > this.film.end) this.at = 0;
    this.before = now;
    this.draw();
    requestAnimationFrame((then) => this.tick(then));
  }

  play(on) {
    this.playing = on;
    this.before = null;
    $("play").textContent = on ? "Pause" : "Play";
    $("play").setAttribute("aria-pressed", on);
    if (on) requestAnimationFrame((then) => this.tick(then));
  }

  /** Hold still at a time. */
  seek(time) {
    this.play(false);
    this.at = Math.min(Math.max(time, 0), this.film.end);
    this.draw();
  }

  look(degrees) {
    this.turn = ((((degrees + 180) % 360) + 360) % 360) - 180;
    this.draw();
  }

  listen() {
    $("play").addEventListener("click", () => this.play(!this.playing));
    $("time").max = this.film.end;
    $("time").addEventListener("input", (event) => this.seek(Number(event.target.value)));
    $("turn").addEventListener("input", (event) => this.look(Number(event.target.value)));
    $("speed").addEventListener("change", (event) => (this.speed = Number(event.target.value)));
    addEventListener("keydown", (event) => this.key(event));
    for (const change of ["resize", "scroll"]) addEventListener(change, () => this.draw(), { passive: true });
    new ResizeObserver(() => this.draw()).observe(document.querySelector(".cards")); // answers move the cards below
    for (const { view } of this.cards) this.drag(view);
  }

  drag(view) {
    let grip = null;
    view.addEventListener("pointerdown", (event) => {
      grip = [event.clientX, this.turn];
      view.setPointerCapture(event.pointerId);
    });
    view.addEventListener("pointermove", (event) => grip && this.look(grip[1] - (event.clientX - grip[0]) / 2));
    for (const end of ["pointerup", "pointercancel"]) view.addEventListener(end, () => (grip = null));
  }

  key(event) {
    const on = event.target.tagName, step = { ArrowRight: 1, ArrowLeft: -1 }[event.key], speed = "1234".indexOf(event.key);
    if (event.ctrlKey || event.metaKey || event.altKey || on === "SELECT" || (on === "BUTTON" && event.key === " ")) return;
    if (event.key === " ") this.play(!this.playing);
    else if (on !== "INPUT" && step) this.seek(this.at + step / this.film.rate);
    else if (speed >= 0) {
      $("speed").selectedIndex = speed;
      this.speed = Number($("speed").value);
    } else return;
    event.preventDefault();
  }
}
