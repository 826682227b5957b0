// The keyboard, wherever a key is not needed by what has the focus.

const SPEEDS = { 1: 1, 2: 5, 3: 20, 4: 100 };
const TURN = Math.PI / 24;

export function keys(replay) {
  document.addEventListener("keydown", (event) => {
    const on = event.target.tagName,
      typed = on === "SELECT" || (on === "INPUT" && event.target.type !== "range");
    if (event.ctrlKey || event.metaKey || event.altKey || typed) return;
    if (event.key === " " && (on === "BUTTON" || on === "SUMMARY")) return;
    const action = actionOf(replay, event);
    if (!action) return;
    event.preventDefault();
    action();
  });
}

function actionOf(replay, { key, shiftKey }) {
  const { player, rig } = replay,
    by = (seconds) => () => player.seek(player.timeS + seconds);
  const turned = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, TURN], ArrowDown: [0, -TURN] };
  if (shiftKey && turned[key]) return () => rig.turn(...turned[key]);
  if (SPEEDS[key]) return () => player.atSpeed(SPEEDS[key]);
  const actions = {
    " ": () => player.toggle(),
    ArrowLeft: by(-1),
    ArrowRight: by(1),
    PageDown: by(60),
    PageUp: by(-60),
    Home: () => player.seek(player.lowS),
    End: () => player.seek(player.highS),
    f: () => replay.follow(),
    t: () => replay.top(),
    w: () => replay.whole(),
    "+": () => rig.zoom(0.8),
    "=": () => rig.zoom(0.8),
    "-": () => rig.zoom(1.25),
    Escape: () => replay.choose(null),
    "?": () => replay.notes(),
  };
  return actions[key] || actions[key.toLowerCase()];
}
