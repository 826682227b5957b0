// What the buttons, lists and bars of the page do.
import { keys } from "./keys.js";
import { pick } from "./pick.js";

const $ = (id) => document.getElementById(id);

export function wire(replay) {
  const { player, rig } = replay,
    on = (id, event, then) => $(id).addEventListener(event, then);
  $("time").min = player.lowS;
  $("time").max = player.highS;
  on("time", "input", () => player.seek(Number($("time").value)));
  on("play", "click", () => player.toggle());
  on("speed", "change", () => player.atSpeed(Number($("speed").value)));
  on("whole", "click", () => replay.whole());
  on("top", "click", () => replay.top());
  on("follow", "click", () => replay.follow());
  on("closer", "click", () => rig.zoom(0.8));
  on("further", "click", () => rig.zoom(1.25));
  on("colour", "change", () => replay.colour($("colour").value));
  on("show", "change", () => replay.show($("show").value.split(",").map(Number)));
  on("details", "click", () => replay.sheet(!$("panel").classList.contains("open")));
  on("shut", "click", () => replay.sheet(false));
  for (const kind of ["worker", "station"]) on(`${kind}s`, "change", () => replay.choose(listed(kind)));
  new ResizeObserver(() => replay.lay()).observe($("stage"));
  document.addEventListener("visibilitychange", () => (player.before = null));
  pick(replay);
  keys(replay);
}

function listed(kind) {
  const { value } = $(`${kind}s`),
    [variant, index] = value.split(",").map(Number);
  return value === "" ? null : { variant, kind, index };
}
