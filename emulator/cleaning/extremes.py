"""Angles that no joint can do: told, or, where asked, turned back to what is believed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from emulator.cleaning.angles import angle_deg, neutral_deg, turned
from emulator.cleaning.found import Repair
from emulator.cleaning.limits import Limit, limits_for
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

LEAST_DEG = 0.01


def within_limits(
    take: Take, settings: CleaningSettings, neutral: Mapping[tuple[str, str], float]
) -> tuple[Take, tuple[Repair, ...]]:
    """The take and, for each angle beyond its limit by more than ``tolerance_deg``, how far at most, in degrees.

    neutral : what an angle is when the person stands, by (joint, movement); 0 where it is not in it
    Where asked (``angles="mend"``), what hangs on the joint is turned until the angle is believed, frame by frame:
    a clamp, so that nothing jumps; a hand or foot then leaves what it holds or stands on.
    """
    if settings.angles == "off" or take.parents is None:
        return take, ()
    repairs = []
    for limit in limits_for(take.names):
        beyond, axis = _beyond(take, limit, neutral, settings.tolerance_deg)
        frames = np.flatnonzero(np.abs(beyond) > LEAST_DEG)
        if not len(frames):
            continue
        mend = settings.angles == "mend"
        worst = float(np.abs(beyond).max()) + settings.tolerance_deg
        repairs.append(_repair(take, limit, frames, worst, mend))
        if mend:
            take = replace(take, positions_m=turned(take, limit.joint, limit.far, axis, -beyond))
    return take, tuple(repairs)


def neutral_angles(takes: list[Take]) -> dict[tuple[str, str], float]:
    """The angles of one person's standing posture, of those limits that are reckoned from it."""
    if not takes or takes[0].parents is None:
        return {}
    limits = [limit for limit in limits_for(takes[0].names) if limit.kind == "lift"]
    return {(limit.joint, limit.what): neutral_deg(takes, limit) for limit in limits}


def _beyond(
    take: Take, limit: Limit, neutral: Mapping[tuple[str, str], float], tolerance_deg: float
) -> tuple[np.ndarray, np.ndarray]:
    """How far (T,) the angle is beyond what is believed, negative below, 0 within; and its axis (T, 3)."""
    angle, axis = angle_deg(take, limit)
    angle = angle - neutral.get((limit.joint, limit.what), 0.0)
    over = np.maximum(angle - (limit.high_deg + tolerance_deg), 0.0)
    under = np.minimum(angle - (limit.low_deg - tolerance_deg), 0.0)
    return np.nan_to_num(over + under, nan=0.0), axis


def _repair(take: Take, limit: Limit, frames: np.ndarray, worst: float, mend: bool) -> Repair:
    done = "turned back to what is believed" if mend else "left as it is"
    long = f"{len(frames)} frame{'s' * (len(frames) > 1)}"
    words = f"{limit.what} {worst:.0f} deg beyond its limit in {long} ({limit.source}); {done}"
    first, last = int(frames[0]), int(frames[-1])
    return Repair(take.name, "angle", (limit.joint,), first, last, worst, "deg", words, mend)
