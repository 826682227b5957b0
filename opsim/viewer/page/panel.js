// The panel about whoever or whatever is chosen: its words, its numbers, its plots.
import { anglesOf } from "./angles.js";
import { rulaClass } from "./colours.js";
import { longestQueue, paintQueue, paintRula, Plot } from "./plots.js";

const NEAR_S = 60;
const ANGLES = [
  ["Trunk forward", "flexion"],
  ["Trunk to the left", "side_bend"],
  ["Trunk turned left", "twist"],
  ["Upper arms lifted", "left_arm", "right_arm"],
  ["Elbows bent", "left_elbow", "right_elbow"],
  ["Knees bent", "left_knee", "right_knee"],
];

const $ = (id) => document.getElementById(id);

/** Set a text only where it changed: writing the same again costs a layout. */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export class Panel {
  constructor(seek) {
    this.near = new Plot($("near"), seek);
    this.far = new Plot($("far"), seek);
    this.cells = ANGLES.map(([words, ...names]) => ({ names, cells: row(words, names.length) }));
  }

  /** world, chosen {kind, index} or null, the run's time. */
  draw(world, chosen, many) {
    $("nothing").hidden = chosen !== null;
    $("chosen").hidden = chosen === null;
    if (chosen === null) return;
    const { variant } = world,
      list = chosen.kind === "worker" ? variant.workers : variant.stations;
    write($("who"), list[chosen.index].name);
    write($("which"), many ? variant.name : "");
    $("body").hidden = $("rula").hidden = chosen.kind !== "worker";
    if (chosen.kind === "worker") this.worker(world, chosen.index);
    else this.station(world, chosen.index);
  }

  worker(world, index) {
    const { variant } = world,
      now = world.doing(index),
      state = variant.states[now.state];
    chip(state);
    facts([
      ["Task", now.task >= 0 ? variant.tasks[now.task].name : "none"],
      ["Station", now.station >= 0 ? world.stood[now.station].name : "none"],
      [
        "Product",
        now.product >= 0 ? variant.products[now.product].name + (now.job >= 0 ? `, job ${now.job}` : "") : "none",
      ],
      ["Body", bodyWords(world, index, now)],
    ]);
    this.angles(world, index);
    const score = world.rula(index);
    write($("score"), score ? (score[0] === score[1] ? String(score[0]) : `${score[0]} to ${score[1]}`) : "not known");
    $("score").style.borderColor = score ? rulaClass(score[1]).colour : "transparent";
    $("score").style.background = score ? rulaClass(score[0]).colour : "none";
    $("score").style.color = score && score[0] === 7 ? "#fff" : "";
    const paint = (low, high) => paintRula(world, index, low, high);
    this.plots(world, `worker ${variant.name} ${index}`, 7.5, [1, 3, 5, 7], paint, "RULA", world.c.rula !== undefined);
  }

  angles(world, index) {
    const skeleton = world.present[index],
      found = skeleton ? anglesOf(skeleton.names, world.joints[index]) : {};
    for (const { names, cells } of this.cells)
      names.forEach((name, i) =>
        write(cells[i], found[name] === undefined || found[name] === null ? "–" : `${whole(found[name])}°`),
      );
  }

  station(world, index) {
    const { variant } = world,
      now = world.station(index),
      { buffer } = variant.stations[index];
    chip(now.state >= 0 ? variant.station_states[now.state] : { colour: "#ffffff", words: "not known" });
    const room = buffer && buffer.capacity !== null && buffer.capacity !== undefined ? ` of ${buffer.capacity}` : "";
    facts([
      ["Waiting in front", `${now.queue}${room} ${now.queue === 1 && !room ? "job" : "jobs"}`],
      ["In work", String(now.busy)],
      ["People", people(world, index)],
    ]);
    const most = longestQueue(world, index),
      ticks = most <= 4 ? [...Array(most + 1).keys()] : [0, Math.round(most / 2), most];
    this.plots(
      world,
      `station ${variant.name} ${index}`,
      most,
      ticks,
      (low, high) => paintQueue(world, index, low, high),
      "Jobs waiting",
      true,
    );
  }

  plots(world, key, most, ticks, paint, words, known) {
    const { low_s: low, high_s: high } = world.variant,
      at = world.timeS;
    $("plots").hidden = !known;
    if (!known) return;
    const whole = high - low <= 4 * NEAR_S;
    write($("near-words"), `${words}, two minutes around now`);
    write($("far-words"), `${words}, all that is shown`);
    $("near").hidden = $("near-words").hidden = whole;
    if (!whole) {
      const from = Math.min(Math.max(Math.floor(at / 10) * 10 - NEAR_S, low), high - 2 * NEAR_S),
        to = from + 2 * NEAR_S;
      this.near.draw(key, from, to, at, most, ticks, paint(from, to));
    }
    this.far.draw(key, low, high, at, most, ticks, paint(low, high));
  }
}

const whole = (angle) => String(Math.round(angle)).replace("-0", "0").replace("-", "−");

function bodyWords(world, index, now) {
  if (!world.present[index]) return "not on the floor";
  if (now.moving) return "moves as emulated";
  return now.task >= 0 ? "stands: nothing is known of this task's movement" : "stands";
}

function people(world, station) {
  const names = world.variant.workers
    .filter((_, worker) => world.doing(worker).station === station && world.present[worker])
    .map(({ name }) => name);
  return names.length ? names.join(", ") : "none";
}

function chip({ colour, words, name }) {
  $("state-colour").style.background = colour;
  write($("state"), words || name);
}

/** [[term, text]] into the list of facts, whose rows are kept. */
function facts(pairs) {
  const list = $("facts");
  while (list.children.length > 2 * pairs.length) list.lastChild.remove();
  while (list.children.length < 2 * pairs.length)
    list.append(document.createElement("dt"), document.createElement("dd"));
  pairs.forEach(([term, text], i) => {
    write(list.children[2 * i], term);
    write(list.children[2 * i + 1], text);
  });
}

function row(words, count) {
  const line = $("angles").insertRow(),
    head = document.createElement("th");
  head.scope = "row";
  head.textContent = words;
  line.append(head);
  const cells = [line.insertCell(), line.insertCell()];
  if (count === 1) {
    cells[0].colSpan = 2;
    cells.pop().remove();
  }
  return cells;
}
