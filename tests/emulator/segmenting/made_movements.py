"""Movements of known truth for the tests of segmenting."""

from dataclasses import replace

import numpy as np

from emulator.recordings.take import Take
from emulator.skeleton import standard_skeleton


def helix(n=400, turns=2.0, pitch=0.3):
    """(n, 3) points of a helix at equal steps of its length, and that length (n,)."""
    at = np.linspace(0, 2 * np.pi * turns, n)
    return np.stack([np.cos(at), np.sin(at), pitch * at], axis=1), at


def phases(still_before=24, starting=7, cycles=3, period=19, stopping=10, still_after=10):
    """Amplitude (T,) and phase (T,) of the LTSA paper's walk: 24 frames still, 7 starting, three cycles, 10 to stop."""
    amplitude = np.concatenate(
        [
            np.zeros(still_before),
            np.linspace(0, 1, starting, endpoint=False),
            np.ones(cycles * period),
            np.linspace(1, 0, stopping, endpoint=False),
            np.zeros(still_after),
        ]
    )
    return amplitude, 2 * np.pi * (np.arange(len(amplitude)) - still_before - starting) / period


def swinging(amplitude, phase, rate_hz=30.0, trial="1", worker="w1"):
    """A take of a body whose legs and arms swing: (T,) amplitude and phase."""
    skeleton = standard_skeleton()
    n = len(phase)
    directions = np.zeros((n, skeleton.n_bones, 3))
    directions[..., 2] = -1.0
    for bone, name in enumerate(skeleton.bone_names):
        side = -1.0 if name.startswith("right") else 1.0
        if name.split("_")[-1] in ("spine", "chest", "neck", "head"):
            directions[:, bone] = (0.0, 0.0, 1.0)
        elif name.endswith(("_hip", "_shoulder")):
            directions[:, bone] = (0.0, side, 0.0)
        else:
            far = {"knee": 0.5, "ankle": 0.35, "elbow": -0.4, "wrist": -0.3}.get(name.split("_")[-1], 0.1)
            lag = {"ankle": 0.9, "wrist": 0.5}.get(name.split("_")[-1], 0.0)
            swing = side * far * amplitude * np.sin(phase - lag) + 0.1 * far * amplitude * np.cos(2 * phase)
            directions[:, bone] = np.stack([np.sin(swing), np.zeros(n), -np.cos(swing)], axis=1)
    positions = skeleton.positions(directions, np.full(skeleton.n_bones, 0.3), np.tile([0.0, 0.0, 0.9], (n, 1)))
    return Take(skeleton.names, skeleton.parents, positions, rate_hz, worker, trial)


def walking(n_cycles=6.5, period=31.3, **options):
    """A take of even swinging without a start or an end."""
    at = np.arange(round(n_cycles * period))
    return swinging(np.ones(len(at)), 2 * np.pi * at / period, **options)


def moved(take, *, yaw_rad=0.0, by_m=(0.0, 0.0, 0.0), scale=1.0):
    """The take turned about the vertical, shifted and made larger."""
    turn = np.array([[np.cos(yaw_rad), -np.sin(yaw_rad), 0], [np.sin(yaw_rad), np.cos(yaw_rad), 0], [0, 0, 1]])
    return replace(take, positions_m=scale * take.positions_m @ turn.T + np.array(by_m))


def backwards(take):
    return replace(take, positions_m=take.positions_m[::-1].copy())
