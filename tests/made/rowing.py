"""Made rowing: push, pause, pull, pause; in a pause only the blades are turned, slowly. What is a pause is known."""

import numpy as np

from emulator.skeleton import standard_skeleton

RATE_HZ = 60.0
CYCLE_S = 2.4
FEATHER_RAD = 0.35
"""How far hands and elbows turn in a pause."""


def made_rowing(n_takes=3, n_cycles=6, *, seed=0, pause_share=0.4, noise_rad=0.001):
    """Positions (T, J, 3) of each take, and states (T,) of each: 0 pause, 1 push, 2 pull."""
    rng = np.random.default_rng(seed)
    takes, states = [], []
    for _ in range(n_takes):
        ways, state = [], []
        for phase in np.tile([0, 1, 2, 3], n_cycles):
            share = pause_share if phase % 2 else 1 - pause_share
            x = np.arange(n := round(rng.normal(1.0, 0.04) * CYCLE_S * RATE_HZ * share / 2)) / n
            ways.append(_ways(phase, x))
            state.append(np.full(n, (1, 0, 2, 0)[phase]))
        takes.append(_bodies(*np.concatenate(ways).T, rng, noise_rad))
        states.append(np.concatenate(state))
    return takes, states


def _ways(phase, x):
    """(n, 3): how far legs, arms and blades have gone. Legs lead in the push, arms in the pull."""
    ease = x * x * (3 - 2 * x)
    rest = np.full_like(x, phase in (1, 2))
    legs = {0: ease**0.8, 2: 1 - ease**1.3}.get(phase, rest if phase == 1 else np.zeros_like(x))
    arms = {0: ease**1.3, 2: 1 - ease**0.8}.get(phase, rest if phase == 1 else np.zeros_like(x))
    blades = {0: 0 * x, 1: x, 2: 1 + 0 * x, 3: 1 - x}[phase]
    return np.column_stack([legs, arms, blades])


def _bodies(legs, arms, blades, rng, noise_rad):
    angle = {
        "spine": -0.5 + 0.9 * legs, "chest": -0.5 + 0.9 * legs, "neck": -0.4 + 0.8 * legs, "head": -0.2 + 0.3 * legs,
        "knee": 2.6 - 1.1 * legs, "ankle": 0.9 + 0.7 * legs, "toe": 2.8 - 0.3 * legs,
        "elbow": 1.2 - 2.4 * arms + 0.5 * FEATHER_RAD * blades, "wrist": 1.5 + 0.4 * arms + FEATHER_RAD * blades,
        "hand": 1.5 + 0.1 * arms + FEATHER_RAD * blades,
    }  # fmt: skip
    skeleton = standard_skeleton()
    tremble = _tremble(len(legs), len(angle), rng, noise_rad)
    vectors = np.zeros((len(legs), skeleton.n_bones, 3))
    for number, name in enumerate(skeleton.bone_names):
        side, joint = {"left": 1.0, "right": -1.0}.get(name.split("_")[0], 0.0), name.split("_")[-1]
        if joint in ("hip", "shoulder"):
            vectors[:, number] = (0.0, side, 0.0)
            continue
        turned = angle[joint] + tremble[:, list(angle).index(joint)]
        backward = -1.0 if joint in ("spine", "chest", "neck", "head") else 1.0
        vectors[:, number] = np.stack([backward * np.sin(turned), 0 * turned, np.cos(turned)], axis=1)
    root = np.stack([-0.5 * legs, 0 * legs, np.full(len(legs), 0.4)], axis=1)
    return skeleton.positions(vectors, np.full(skeleton.n_bones, 0.25), root)


def _tremble(n, n_angles, rng, noise_rad):
    """(n, angles) slow wander about 0 that forgets itself in about a second."""
    out = np.zeros((n, n_angles))
    for t in range(1, n):
        out[t] = 0.98 * out[t - 1] + noise_rad * rng.standard_normal(n_angles)
    return out
