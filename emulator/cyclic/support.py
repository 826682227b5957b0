"""The training manifold as draws see it: the training latents, and how far from them a pose may lie.

Beyond the paper: a first-order process with noise is lost sooner or later, since far from its data nothing calls it
back. The bound is what the recordings say themselves: how far one take lies from the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

GAP_FRAMES = 10
"""With one take only, frames at least so far apart in time are what is held out."""
QUANTILE = 0.9
MOST_STEPS = 5000
TAIL = 0.125
NARROWEST = 0.25
"""Share of the bound that the radius keeps where single steps are longer than the bound."""


@dataclass(frozen=True, eq=False)
class Support:
    """A tube about the recorded steps: ``points`` (n, d), ``ways`` (n, d) to the frame after, and its ``radius``.

    Whole steps and not only frames, since where a contact begins a frame may be far from the next.
    ``leading`` : the first so many steps lie before the last TAIL of their stretch, so that who follows them gets on.
    ``bound``   : the greatest distance of a held-out frame from the nearest of the others.
    """

    points: np.ndarray
    ways: np.ndarray
    leading: int
    radius: float
    bound: float

    @classmethod
    def of(cls, sequences: Sequence[np.ndarray]) -> Support:
        """Radius: the QUANTILE of held-out distances, or less, so that nothing inside is beyond ``bound`` from a frame.

        Frames further away than the QUANTILE from all others belong to no cycle (a start from standing, a stumble):
        they are no support, or a draw would be caught there.
        """
        away, sequences = held_out_distances(sequences), list(sequences)
        radius = float(np.quantile(np.concatenate(away), QUANTILE))
        few = _few([len(z) for z in sequences])
        sequences, away, every = [sequences[i] for i in few], [away[i] for i in few], np.concatenate(away)
        usual = [(one[:-1] <= radius) & (one[1:] <= radius) for one in away]
        points = np.concatenate([z[:-1][own] for z, own in zip(sequences, usual)])
        ways = np.concatenate([np.diff(z, axis=0)[own] for z, own in zip(sequences, usual)])
        leads = np.concatenate([_leads(own)[own] for own in usual])
        kept = np.argsort(~leads, kind="stable")
        bound = float(every.max())
        half_step = 0.5 * np.linalg.norm(ways[kept], axis=1).max()
        safe = np.sqrt(max(bound**2 - half_step**2, (NARROWEST * bound) ** 2))
        return cls(points[kept], ways[kept], int(leads[kept].sum()), float(min(radius, safe)), bound)


def distance(z: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """(...) from each z (..., d) to the nearest of the frames (n, d)."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(frames).query(z)[0])


def _few(lengths: Sequence[int]) -> list[int]:
    """Numbers of sequences, evenly, that have MOST_STEPS frames together; whole ones, since steps lead on."""
    share = min(1.0, MOST_STEPS / sum(lengths))
    return np.unique((np.arange(max(1, int(share * len(lengths)))) / share).astype(int)).tolist()


def _leads(usual: np.ndarray) -> np.ndarray:
    """(T,) True for steps before the last TAIL of their run of usual ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], usual.astype(int), [0]])))
    out = np.zeros(len(usual), dtype=bool)
    for start, stop in zip(edges[::2], edges[1::2]):
        out[start : stop - int(np.ceil(TAIL * (stop - start)))] = True
    return out


def held_out_distances(sequences: Sequence[np.ndarray]) -> list[np.ndarray]:
    """(T,) of each: from a frame to the nearest frame of another sequence; of one sequence, to one far in time."""
    if len(sequences) == 1:
        return [_far_in_time(sequences[0])]
    return [distance(own, np.concatenate([*sequences[:i], *sequences[i + 1 :]])) for i, own in enumerate(sequences)]


def _far_in_time(z: np.ndarray) -> np.ndarray:
    away = np.empty(len(z))
    for t in range(len(z)):
        others = np.concatenate([z[: max(t - GAP_FRAMES, 0)], z[t + GAP_FRAMES :]])
        away[t] = np.sqrt(((others - z[t]) ** 2).sum(axis=1).min()) if len(others) else 0.0
    return away
