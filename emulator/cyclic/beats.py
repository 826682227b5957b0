"""The beats of motion that goes on and on: the strikes of the feet in walking, the turns of the cycle in other work."""

from __future__ import annotations

import numpy as np

STILL_LEGS_PER_S = 0.12
"""A root slower than this stands: what goes before is waiting, and no part of the way."""
FEWEST_FRAMES = 3


def strikes(contact: np.ndarray) -> list[tuple[int, int]]:
    """(frame, foot) of each coming down of a foot in contact (T, 2), in order; feet take turns.

    Flickers shorter than FEWEST_FRAMES do not count, nor does the second of two strikes of one foot in a row.
    """
    found = []
    for foot in (0, 1):
        bears = np.asarray(contact[:, foot], bool)
        for frame in np.flatnonzero(bears[1:] & ~bears[:-1]) + 1:
            before, after = bears[max(frame - FEWEST_FRAMES, 0) : frame], bears[frame : frame + FEWEST_FRAMES]
            if not before.any() and after.all():
                found.append((int(frame), foot))
    found.sort()
    return [beat for i, beat in enumerate(found) if i == 0 or beat[1] != found[i - 1][1]]


def turns(z: np.ndarray, rate_hz: float, level: tuple[float, float] | None = None) -> list[int]:
    """Frames at which a new cycle begins: the first latent comes up through its middle, after having been well below.

    z : (T, d). The first latent, smoothed over a tenth of a second, must fall well below the middle in between, so that
    a tremble makes no cycle. level : the middle and what is well below it; None: the middle of the range of z, and a
    third of the spread below.
    """
    from scipy.ndimage import gaussian_filter1d

    wave = gaussian_filter1d(z[:, 0], 0.1 * rate_hz, mode="nearest")
    if level is None:
        middle = float(0.5 * (np.quantile(wave, 0.05) + np.quantile(wave, 0.95)))
        level = middle, middle - float(wave.std()) / 3
    armed, found = False, []
    for frame in range(1, len(wave)):
        armed = armed or wave[frame] < level[1]
        if armed and wave[frame - 1] < level[0] <= wave[frame]:
            found.append(frame)
            armed = False
    return found


def onset(speed: np.ndarray, limit: float = STILL_LEGS_PER_S) -> int:
    """The last frame of standing before the first movement, 0 where it moves from the first frame on; speed (T,)."""
    moving = np.flatnonzero(speed > limit)
    return max(int(moving[0]) - 1, 0) if len(moving) else 0


def starts_still(speed: np.ndarray, limit: float = STILL_LEGS_PER_S) -> bool:
    """Whether the take begins standing: speed (T,) of the root in legs a second."""
    return bool(np.all(speed[:3] <= limit))


def next_strike(contact: np.ndarray, foot: int, earliest: int) -> int | None:
    """The first frame from ``earliest`` on in which ``foot`` has come down, after FEWEST_FRAMES in the air; or None."""
    bears = np.asarray(contact[:, foot], bool)
    for frame in np.flatnonzero(bears[1:] & ~bears[:-1]) + 1:
        if frame >= earliest and not bears[max(frame - FEWEST_FRAMES, 0) : frame].any():
            return int(frame)
    return None
