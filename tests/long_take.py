"""Repetitions of recordings, made fit for long takes."""

from dataclasses import replace

import numpy as np

from emulator.segmenting.synthesis import motion_of


def plain(take):
    """A take of a recording as a motion without marks and covariates."""
    return replace(motion_of(take), covariates={}, mark_s=np.zeros(0), stretch=None)


def usual_ends(motions):
    """Those that begin and end as most do: the first repetition of a person often comes out of another posture."""
    kept = np.ones(len(motions), bool)
    for at in (0, -1):
        ends = np.stack([motion.directions[at] for motion in motions]).reshape(len(motions), -1)
        away = np.linalg.norm(ends - np.median(ends, axis=0), axis=1)
        kept &= away < 2.5 * np.median(away)
    return [motion for motion, keep in zip(motions, kept) if keep]
