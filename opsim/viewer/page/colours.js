// What colours say: the state somebody is in, or his RULA score. Never by colour alone: the panel has the words.
import { colourOf } from "./floor.js";

/** Classes of RULA (McAtamney & Corlett 1993), light to dark, so that they are told apart without any colour vision. */
export const RULA = [
  { most: 2, colour: "#9CC7E0", words: "RULA 1–2" },
  { most: 4, colour: "#F1D778", words: "3–4" },
  { most: 6, colour: "#EBA02A", words: "5–6" },
  { most: 7, colour: "#B0410B", words: "7" },
];
const LEAST_AND_MOST = "shirt: at least, ring on the floor: at most";
export const UNKNOWN = { colour: "#A9B0B7", words: "not known" };

export const rulaClass = (score) => RULA.find(({ most }) => score <= most) || RULA[RULA.length - 1];

/** {shirt, ring} of each worker, 0xrrggbb: of RULA the shirt says the least that it can be, the ring the most. */
export function shirtsOf(world, by) {
  const states = world.variant.states.map((state) => colourOf(state.colour));
  return world.variant.workers.map((_, worker) => {
    if (by !== "exposure") {
      const colour = states[world.doing(worker).state];
      return { shirt: colour, ring: colour };
    }
    const score = world.rula(worker),
      [shirt, ring] = score ? score.map((value) => rulaClass(value).colour) : [UNKNOWN.colour, UNKNOWN.colour];
    return { shirt: colourOf(shirt), ring: colourOf(ring) };
  });
}

/** [{colour, words}]: only states that somebody is ever in; an entry without a colour says how to read the others. */
export function legendOf(worlds, by) {
  if (by === "exposure") return [...RULA, UNKNOWN, { words: LEAST_AND_MOST }];
  const found = new Map();
  for (const { variant, c } of worlds) {
    const seen = new Set(c.seg_state);
    variant.states.forEach((state, i) => {
      if (seen.has(i) && !["off", "absent"].includes(state.name))
        found.set(state.name, { colour: state.colour, words: state.words || state.name });
    });
  }
  return [...found.values()];
}
