// The lists that choose by keyboard, and the legends. Names only ever become text.
import { legendOf } from "./colours.js";

const $ = (id) => document.getElementById(id);

/** Fill the lists of workers, stations and variants for what is shown. */
export function fillLists(replay) {
  const { worlds, shown } = replay;
  for (const kind of ["worker", "station"]) {
    $(`${kind}s`).replaceChildren(new Option("none", ""), ...shown.flatMap((v) => optionsOf(replay, v, `${kind}s`)));
    $(`${kind}s`).value = valueOf(replay.chosen, kind);
  }
  const name = (v) => worlds[v].variant.name,
    others = worlds.map((_, v) => v).slice(1);
  const both = others.map((v) => new Option(`both: ${name(0)} and ${name(v)}`, `0,${v}`));
  $("show-label").hidden = worlds.length < 2;
  $("show").replaceChildren(...both, ...worlds.map((_, v) => new Option(name(v), String(v))));
  $("show").value = shown.join(",");
  $("colour").querySelector("[value=exposure]").disabled = !worlds.some((world) => world.c.rula);
}

/** Who or what is chosen, as the value of a list. */
export const valueOf = (chosen, kind) => (chosen && chosen.kind === kind ? `${chosen.variant},${chosen.index}` : "");

function optionsOf(replay, v, of) {
  const { variant } = replay.worlds[v],
    options = variant[of].map(({ name }, i) => new Option(name, `${v},${i}`));
  if (replay.shown.length < 2) return options;
  const group = document.createElement("optgroup");
  group.label = variant.name;
  group.append(...options);
  return [group];
}

/** The colours of people, and in the notes those of parts. */
export function fillLegends(replay) {
  const worlds = replay.shown.map((v) => replay.worlds[v]),
    products = worlds.flatMap((world) => world.variant.products);
  $("legend").replaceChildren(...legendOf(worlds, replay.by).map(entryOf));
  const parts = new Map(products.map(({ name, colour }) => [name + colour, entryOf({ colour, words: name })]));
  $("products").replaceChildren(...parts.values());
}

function entryOf({ colour, words }) {
  const entry = document.createElement("li");
  if (colour) entry.append(document.createElement("i"));
  if (colour) entry.firstChild.style.background = colour;
  entry.append(words);
  return entry;
}
