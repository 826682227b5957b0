"""Steps: by how much each joint's way from one frame to the next is not what its neighbours in time foretell."""

from __future__ import annotations

import numpy as np

from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

USUAL_QUANTILE = 0.9
OWN = 0.6
"""A step surprises on its own by more than this share of what the steps beside it do: theirs makes half of it."""


def surprise_vectors_m(positions_m: np.ndarray) -> np.ndarray:
    """(T - 1, J, 3) of each step what the mean of the steps before and after it does not foretell; 0 beside gaps.

    Half the third difference: a step S gives S (and -S / 2 beside it), a spike of one frame 1.5 S and -1.5 S, an even
    or evenly changing speed nothing. The first and the last step are held against the one beside.
    """
    step = np.diff(positions_m, axis=0)
    if len(step) < 3:
        return np.zeros_like(step)
    around = np.concatenate([step[1:2], step, step[-2:-1]])
    return np.nan_to_num(step - (around[:-2] + around[2:]) / 2, nan=0.0)


def surprise_m(positions_m: np.ndarray) -> np.ndarray:
    """(T - 1, J) length of ``surprise_vectors_m``."""
    return np.asarray(np.linalg.norm(surprise_vectors_m(positions_m), axis=-1))


def usual_m(surprise: np.ndarray) -> np.ndarray:
    """(J,) what each joint does in this take: the 90th percentile of its surprise."""
    return np.asarray(np.quantile(surprise, USUAL_QUANTILE, axis=0))


def surprising(take: Take, settings: CleaningSettings) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Surprise (T - 1, J), the limit (J,) above which it is a jump's, and (J,) above which no body does it, in metres.

    A joint whose marker shakes all the time has a high limit of its own: what it does always is no jump.
    """
    surprise = surprise_m(take.positions_m)
    usual = usual_m(surprise)
    small = np.maximum(settings.least_jump_m, settings.times_usual * usual)
    violent = np.maximum(settings.jump_m_per_s / take.rate_hz, 2.0 * usual)
    return surprise, np.minimum(small, violent), violent


def largest_beside(surprise: np.ndarray) -> np.ndarray:
    """(T - 1,) the larger surprise of the steps before and after each of (T - 1,)."""
    padded = np.concatenate([[0.0], surprise, [0.0]])
    return np.maximum(padded[:-2], padded[2:])
