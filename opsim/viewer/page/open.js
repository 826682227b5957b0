// From the page's data to a first picture, and what a test may ask of the page.
import { anglesOf } from "./angles.js";
import { inflated } from "./inflate.js";
import { Replay } from "./replay.js";
import { Sight } from "./sight.js";
import { World } from "./world.js";

const $ = (id) => document.getElementById(id);
const NO_WEBGL =
  "This replay needs WebGL, which this browser does not offer or has switched off. " +
  "The report of the same run shows its figures without it.";

export function open() {
  const page = {};
  page.ready = begin().then((replay) => Object.assign(page, asked(replay)));
  window.opsimReplay = page;
  page.ready.catch((error) => {
    $("word").textContent = error.message === "no WebGL" ? NO_WEBGL : `This page cannot be shown: ${error.message}`;
    $("word").hidden = false;
    document.documentElement.dataset.drawn = "no";
  });
}

async function begin() {
  const meta = JSON.parse($("replay").textContent);
  if (meta.format !== 1) throw new Error(`it is of format ${meta.format}, and this script reads format 1`);
  const sight = sightOf($("floor"));
  const buffers = await Promise.all(meta.variants.map((_, v) => inflated($(`columns-${v}`))));
  const replay = new Replay(
    meta.variants.map((variant, v) => new World(variant, buffers[v])),
    sight,
  );
  await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
  replay.firstPictureMs = performance.now();
  $("word").hidden = true;
  document.documentElement.dataset.drawn = meta.variants.length;
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) replay.player.play();
  return replay;
}

function sightOf(canvas) {
  try {
    return new Sight(canvas);
  } catch {
    throw new Error("no WebGL");
  }
}

/** What a test may ask for: see tests/browser/test_replay.py. */
function asked(replay) {
  const { player } = replay,
    now = () => replay.tick(performance.now());
  const world = () => replay.worlds[replay.chosen ? replay.chosen.variant : replay.shown[0]];
  const indexOf = (list, name) => (typeof name === "number" ? name : list.findIndex((one) => one.name === name));
  return {
    firstPicture_ms: replay.firstPictureMs,
    variants: replay.worlds.length,
    seek: (timeS) => (player.seek(timeS), now()),
    play: () => player.play(),
    pause: () => player.pause(),
    speed: (times) => player.atSpeed(times),
    state: () => ({
      t: player.timeS,
      playing: player.playing,
      speed: player.speed,
      fps: replay.counter.fps,
      variant: replay.shown,
      by: replay.by,
      selected: replay.chosen && {
        kind: replay.chosen.kind,
        name: replay.nameOf(replay.chosen),
        variant: replay.chosen.variant,
      },
    }),
    /** [[x, y, z], ...] of a worker (name or number) as he is shown now; null where he is not on the floor. */
    joints: (worker) => {
      const w = world(),
        i = indexOf(w.variant.workers, worker),
        skeleton = w.present[i];
      return skeleton && skeleton.names.map((_, j) => [...w.joints[i].subarray(3 * j, 3 * j + 3)]);
    },
    /** {name: degrees} of a worker's body as he is shown now. */
    angles: (worker) => {
      const w = world(),
        i = indexOf(w.variant.workers, worker),
        skeleton = w.present[i];
      return skeleton && anglesOf(skeleton.names, w.joints[i]);
    },
    select: (kind, name) => {
      const variant =
        name === null ? undefined : replay.shown.find((v) => indexOf(replay.worlds[v].variant[`${kind}s`], name) >= 0);
      replay.choose(
        variant === undefined
          ? null
          : { variant, kind, index: indexOf(replay.worlds[variant].variant[`${kind}s`], name) },
      );
      now();
    },
    variant: (which) => replay.show(Array.isArray(which) ? which : [which]),
    /** Where on the page, in pixels, a worker or station is seen now. */
    where: (kind, name) => replay.where(kind, name),
    draw: now,
  };
}
