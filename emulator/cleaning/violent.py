"""Steps that no body can do: beyond one near an end the take is cut off; one that nothing mended makes it bad."""

from __future__ import annotations

import numpy as np

from emulator.cleaning.found import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.cleaning.steps import OWN, largest_beside, surprising
from emulator.recordings.take import Take

FEWEST_FRAMES = 12
AT_END = 2
"""A jump this many frames from the start or the end cannot be bridged; they are cut off."""


def violent_steps(take: Take, settings: CleaningSettings) -> tuple[Repair, ...]:
    """Steps that no body can do and that are still there, each run of them as one, in m/s."""
    if settings.jumps == "off" or take.n_frames < FEWEST_FRAMES:
        return ()
    surprise, _, violent = surprising(take, settings)
    found, longest = [], settings.frames(settings.longest_jump_s, take.rate_hz)
    for joint in np.flatnonzero((surprise > violent).any(axis=0)).tolist():
        runs: list[list[int]] = []
        for step in np.flatnonzero(surprise[:, joint] > violent[joint]).tolist():
            if runs and step - runs[-1][-1] <= longest:
                runs[-1].append(step)
            else:
                runs.append([step])
        for run in runs:
            size = float(surprise[run, joint].max()) * take.rate_hz
            words = f"its speed changes by {size:.1f} m/s between frames, which no body can do; left as it is"
            found.append(
                Repair(take.name, "glitch", (take.names[joint],), run[0], run[-1] + 1, size, "m/s", words, False, True)
            )
    return tuple(found)


def at_the_ends(surprise: np.ndarray, violent: np.ndarray) -> list[tuple[int, int, int, float]]:
    """(joint, first, last, size) of frames at the start or the end that a step no body can do parts from the rest."""
    n_frames, found = len(surprise) + 1, []
    for joint in range(surprise.shape[1]):
        own = np.flatnonzero(
            (surprise[:, joint] > violent[joint]) & (surprise[:, joint] > OWN * largest_beside(surprise[:, joint]))
        )
        for step in own.tolist():
            if step < AT_END:
                found.append((joint, 0, step, float(surprise[step, joint])))
            elif step >= n_frames - 1 - AT_END:
                found.append((joint, step + 1, n_frames - 1, float(surprise[step, joint])))
    return found


def cut_repair(take: Take, joint: int, first: int, last: int, size: float, settings: CleaningSettings) -> Repair:
    mended = settings.jumps == "mend"
    where = "from the first frames" if first == 0 else "in the last frames"
    words = f"jumps {where}, as no body can, {100 * size:.1f} cm; {'cut off' if mended else 'left as it is'}"
    return Repair(take.name, "glitch", (take.names[joint],), first, last, size, "m", words, mended, not mended)
