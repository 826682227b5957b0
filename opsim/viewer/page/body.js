// What a body is made of: tapered capsules between its joints, as opsim/report/body.py has their radii (m).

const LIMB_M = {
  neck: [0.06, 0.055],
  head: [0.055, 0.05],
  elbow: [0.054, 0.043],
  wrist: [0.042, 0.03],
  hand: [0.036, 0.031],
  fingers: [0.026, 0.018],
  thumb: [0.02, 0.014],
  knee: [0.086, 0.06],
  ankle: [0.06, 0.042],
  toe: [0.046, 0.036],
  foot: [0.046, 0.036],
  heel: [0.042, 0.038],
};
const OTHER_M = [0.036, 0.032];
export const TORSO = ["left_shoulder", "right_shoulder", "right_hip", "left_hip"];
const LEFT = 0x0072b2,
  RIGHT = 0xd55e00,
  GREY = 0x9aa2ad,
  DARK_GREY = 0x7d8691;
const SKIN = 0xe2bd9c,
  CAP = 0x3d4652,
  TROUSERS = 0x465162,
  SHIRT = null; // null: the colour that a person is given

/** Colours of the parts: "limbs" tells left from right limb by limb, "work" by gloves and shoes below its clothes. */
const DRESSES = {
  limbs: {
    torso: GREY,
    hips: GREY,
    head: GREY,
    cap: DARK_GREY,
    neck: GREY,
    left: () => LEFT,
    right: () => RIGHT,
    other: GREY,
    ring: false,
  },
  work: {
    torso: SHIRT,
    hips: TROUSERS,
    head: SKIN,
    cap: CAP,
    neck: SKIN,
    other: SHIRT,
    ring: true,
    left: (joint) => clothes(joint, LEFT),
    right: (joint) => clothes(joint, RIGHT),
  },
};

function clothes(joint, side) {
  if (joint === "knee" || joint === "ankle") return TROUSERS;
  if (joint === "elbow") return SHIRT;
  if (joint === "wrist") return SKIN;
  return side;
}

/** The parts of a body with this skeleton {names, parents}: joint numbers, radii and colours. */
export function bodyOf({ names, parents }, dress = "work") {
  const colours = DRESSES[dress],
    at = (name) => names.indexOf(name);
  const hasTorso = TORSO.every((name) => at(name) >= 0),
    tied = hasTorso ? TORSO.map(at) : [];
  const trunk = hasTorso ? ["spine", "chest", "upper_chest", "left_clavicle", "right_clavicle", "neck"].map(at) : [];
  const hasHead = at("head") >= 0 && (hasTorso || parents[at("head")] >= 0);
  const limbs = [];
  names.forEach((name, joint) => {
    if (parents[joint] < 0 || tied.includes(joint) || trunk.includes(joint) || joint === at("head")) return;
    if (/^(mid|upper)_neck$/.test(name)) return;
    const plain = name.replace(/^(left|right)_/, ""),
      [from, to] = LIMB_M[plain] || OTHER_M;
    const side = name.startsWith("left_")
      ? colours.left
      : name.startsWith("right_")
        ? colours.right
        : () => colours.other;
    limbs.push({ parent: parents[joint], joint, from, to, colour: side(plain) });
  });
  const feet = names.map((name, joint) => joint).filter((joint) => /_(ankle|toe|foot|heel)$/.test(names[joint]));
  return {
    names,
    limbs,
    feet,
    colours,
    root: parents.indexOf(-1),
    torso: tied,
    head: hasHead ? at("head") : -1,
    neck: hasHead ? (at("neck") >= 0 ? at("neck") : parents[at("head")]) : -1,
    waist: hasTorso ? at("spine") : -1,
    soles: soles(at),
    pieces: limbs.length + 2 + (hasTorso ? 6 : 0) + (hasHead ? 4 : 0),
  };
}

/** A sole under ankle and toe, where a skeleton has no heel of its own. */
function soles(at) {
  return ["left", "right"]
    .filter((side) => at(`${side}_heel`) < 0)
    .map((side) => ["knee", "ankle", "toe"].map((name) => at(`${side}_${name}`)))
    .filter((joints) => joints.every((joint) => joint >= 0));
}
