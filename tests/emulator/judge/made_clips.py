"""Made movements that the tests of real time share: one body, moved in ways whose figures are known."""

import numpy as np

from emulator.judge.clips import Clips
from emulator.skeleton import Skeleton
from tests.emulator.judge.test_joint_limits import SKELETON, standing

FEET = {side: [SKELETON.index(f"{side}_{joint}") for joint in ("ankle", "toe")] for side in ("left", "right")}
NO_FEET = Skeleton(("pelvis", "chest", "left_wrist"), (-1, 0, 1))
ONE_FOOT = Skeleton(("pelvis", "left_hip", "left_knee", "left_ankle"), (-1, 0, 1, 2))


def still(n_times=121):
    """(T, J, 3) of somebody who stands."""
    return np.repeat(standing()[None], n_times, axis=0)


def clips(*positions, seconds=2.0, skeleton=SKELETON):
    """Each (T, J, 3) takes ``seconds``."""
    return Clips(skeleton, positions, np.full(len(positions), seconds))


def waved(n, rng, *, shake_m=0.0, size=0.1, n_times=121):
    """n clips of 2 s in which both hands swing, each at its own width; every joint shaken by ``shake_m``."""
    share, made = np.linspace(0, 1, n_times), []
    for width in rng.normal(0.4, size * 0.4, n):
        body = still(n_times)
        swing = width * np.sin(np.pi * share) ** 2
        for joint in ("left_hand", "left_wrist", "right_hand", "right_wrist"):
            body[:, SKELETON.index(joint), 0] += swing
        wobble = 0.01 * rng.normal(size=(3, len(SKELETON.names), 3))
        waves = np.stack([np.sin(2 * np.pi * k * share + rng.uniform(0, 6)) for k in (1, 2, 3)])
        made.append(body + np.einsum("kt,kjc->tjc", waves, wobble) + shake_m * rng.normal(size=body.shape))
    return clips(*made)
