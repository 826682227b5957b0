"""A take cut: into repetitions where it rests between them, else into cycles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from emulator.recordings.take import Take
from emulator.segmenting.curve import Curve, curve_of
from emulator.segmenting.cycles import Cycles, at_the_most_alike, cycles
from emulator.segmenting.period import period_frames
from emulator.segmenting.postures import postures
from emulator.segmenting.repetitions import Repetitions, repetitions
from emulator.segmenting.units import Unit, units

KINDS = ("auto", "repetitions", "cycles")


class NothingFound(ValueError):
    """A sound take in which there is nothing to cut."""


@dataclass(frozen=True)
class Cut:
    """Frames ``start`` to ``stop``, both within; ``name`` goes into the trial's name."""

    start: int
    stop: int
    name: str


@dataclass(frozen=True, eq=False)
class Segments:
    """What was found in a take.

    kind  : "repetitions", "cycles", or "given" where cut times were
    cuts  : in order; one may begin in the frame in which the one before ends
    units : of a take of cycles, else none
    curve : of the frames ``frames`` (those within the cuts, of a take of repetitions); ``cycles`` read from it
    """

    take: Take
    kind: str
    cuts: tuple[Cut, ...]
    units: tuple[Unit, ...] = ()
    curve: Curve | None = None
    frames: np.ndarray = field(default_factory=lambda: np.zeros(0, int))
    cycles: Cycles | None = None
    repetitions: Repetitions | None = None
    notes: tuple[str, ...] = ()


def segment(take: Take, kind: str = "auto", *, k: int | None = None) -> Segments:
    """Cut a take. How many cuts there are is found.

    kind : "repetitions", "cycles", or "auto": repetitions where the body rests between two or more, else cycles, and
           where there are none either the repetition that begins or ends with a rest
    k    : neighbours of a frame for the manifold; None: as ``curve_of`` chooses
    Raises ValueError that names the take for what cannot be cut (``postures``), NothingFound where nothing is found.
    """
    if kind not in KINDS:
        raise ValueError(f"kind: found {kind!r}, expected {', '.join(KINDS)}")
    points = postures(take)
    found = None if kind == "cycles" else repetitions(points, take.rate_hz)
    if found is not None and (kind == "repetitions" or rests_between(found)):
        return _of_repetitions(take, points, found, k)
    try:
        return _of_cycles(take, points, kind, k)
    except NothingFound:
        if found is None or not found.rests.any():
            raise
        return _of_repetitions(take, points, found, k)


def _of_cycles(take: Take, points: np.ndarray, kind: str, k: int | None) -> Segments:
    period = period_frames(points)
    if period is None:
        raise NothingFound(f"take {take.name}: no {_words(kind)} found: the movement does not come back to itself")
    curve = _curve(take, points, period, k)
    cycle = at_the_most_alike(cycles(curve.y, period), points)
    if len(cycle.start) == 0:
        raise NothingFound(f"take {take.name}: no {_words(kind)} found: about {len(points) / period:.1f} cycles long")
    pairs = zip(np.rint(cycle.start).astype(int).tolist(), np.rint(cycle.stop).astype(int).tolist())
    cuts = tuple(Cut(start, stop, str(number)) for number, (start, stop) in enumerate(pairs, start=1))
    return Segments(take, "cycles", cuts, units(cycle), curve, np.arange(len(points)), cycle)


def rests_between(found: Repetitions) -> bool:
    """Whether there are two repetitions or more, and a rest between most of them."""
    return len(found.start) >= 2 and float(np.mean(found.rests[1:-1])) >= 0.5


def _of_repetitions(take: Take, points: np.ndarray, found: Repetitions, k: int | None) -> Segments:
    if len(found.start) == 0:
        why = "; ".join(found.left_out) or "the body does not leave a posture and come back to it"
        raise NothingFound(f"take {take.name}: no repetitions found: {why}")
    pairs = zip(found.start.tolist(), found.stop.tolist())
    cuts = tuple(Cut(start, stop, str(number)) for number, (start, stop) in enumerate(pairs, start=1))
    frames = np.unique(np.concatenate([np.arange(cut.start, cut.stop + 1) for cut in cuts]))
    period = float(np.median(found.stop - found.start + 1))
    curve = _curve(take, points[frames], period if len(cuts) > 1 else None, k)
    return Segments(take, "repetitions", cuts, (), curve, frames, None, found, found.left_out)


def _curve(take: Take, points: np.ndarray, period: float | None, k: int | None) -> Curve:
    try:
        return curve_of(points, period, k=k)
    except ValueError as error:
        raise ValueError(f"take {take.name}: {error}") from None


def _words(kind: str) -> str:
    return {"auto": "repetitions or cycles"}.get(kind, kind)


def given(take: Take, cuts: Sequence[Cut]) -> Segments:
    """A take with cuts that somebody says."""
    return Segments(take, "given", tuple(cuts))
