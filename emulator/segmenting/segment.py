"""A take cut: into repetitions where it rests between them, else into cycles.

Cut times as a small text file: written by the cutting, corrected by a person, read again.

A line a piece, ``start_s end_s name``, seconds from the take's first frame; ``[worker/trial]`` above the lines of a
take; ``#`` begins a comment. Read with all its mistakes at once, each with file and line.

The pieces of a cut take as takes of their own.
"""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches

import numpy as np

from emulator.recordings.take import Recording, Take
from emulator.segmenting.cycles import Curve, Cycles, Unit, at_the_most_alike, curve_of, cycles, period_frames, units
from emulator.segmenting.repetitions import Repetitions, postures, repetitions

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


LONGEST = 10_000_000
"""Characters of a file that is read."""
_HEAD = "# cut times, seconds from the first frame: start_s end_s name; edit, then read them with --cuts"
_SEAL = "# as found: "


def cut_times_text(takes: Sequence[Take], cuts: Mapping[str, Sequence[Cut]]) -> str:
    """The file: the cuts of each take by its name. A seal at its end tells whether somebody has changed it."""
    lines = [_HEAD]
    for take in takes:
        if take.name in cuts:
            lines += [f"[{take.name}]", *(_line(cut, take.rate_hz) for cut in cuts[take.name])]
    body = "\n".join(lines) + "\n"
    return f"{body}{_SEAL}{_digest(body)}\n"


def was_edited(text: str) -> bool:
    """Whether somebody changed the file since it was written."""
    body, seal, digest = text.rpartition(_SEAL)
    return not seal or digest.strip() != _digest(body)


def parse_cut_times(text: str, takes: Sequence[Take], file: str) -> dict[str, tuple[Cut, ...]]:
    """The cuts of each take that the file names; a file for one take needs no ``[worker/trial]``.

    Times are rounded to the nearest frame. Raises ValueError with every mistake as ``file:line: ...``.
    """
    if len(text) > LONGEST:
        raise ValueError(f"{file}: found {len(text)} characters, expected {LONGEST} at most")
    known = {take.name: take for take in takes}
    here = takes[0] if len(takes) == 1 else None
    found: dict[str, list[tuple[int, Cut]]] = {}
    names: dict[str, dict[str, int]] = {take.name: {} for take in takes}
    wrong: list[str] = []
    unknown = False
    for number, raw in enumerate(text.split("\n"), start=1):
        line = raw.partition("#")[0].strip()
        place = f"{file}:{number}"
        if line.startswith("["):
            name = raw.strip()[1:].rpartition("]")[0] or line[1:]  # a take's own name may hold a '#'
            here, unknown = known.get(name), name not in known
            wrong += [f"{place}: {_no_take(name, known)}"] if unknown else []
            if here is not None and here.name in found:
                wrong.append(f"{place}: found a second [{here.name}], expected each take once")
            if here is not None:
                found.setdefault(here.name, [])
        elif line and here is not None:
            cut, mistakes = _cut(line, here)
            wrong += [f"{place}: {mistake}" for mistake in [*mistakes, *_again(line, names[here.name], number)]]
            found.setdefault(here.name, []).extend([(number, cut)] if cut else [])
        elif line and not unknown:
            wrong.append(f"{place}: found a time before any [worker/trial], expected the take that it belongs to")
    for name in found:
        wrong += [f"{file}:{number}: {mistake}" for number, mistake in _together(found[name], known[name].rate_hz)]
    wrong.sort(key=lambda mistake: int(mistake.removeprefix(f"{file}:").partition(":")[0]))
    if not wrong and not any(found.values()):
        wrong.append(f"{file}: found no cut times, expected lines such as '1.20 3.45 1'")
    if wrong:
        raise ValueError("\n".join(wrong))
    return {name: tuple(cut for _, cut in cuts) for name, cuts in found.items()}


def _line(cut: Cut, rate_hz: float) -> str:
    digits = max(3, math.ceil(math.log10(rate_hz)) + 1)
    return f"{cut.start / rate_hz:.{digits}f} {cut.stop / rate_hz:.{digits}f} {cut.name}"


def _digest(body: str) -> str:
    return hashlib.blake2b(body.encode(), digest_size=8).hexdigest()


def _no_take(name: str, known: Mapping[str, Take]) -> str:
    near = get_close_matches(name, known, n=1)
    return f"no take {name!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}")


def _cut(line: str, take: Take) -> tuple[Cut | None, list[str]]:
    """The cut of a line, and what is wrong with it."""
    words = line.split()
    if len(words) != 3:
        return None, [f"found {len(words)} words, expected three: start_s end_s name"]
    times = [_number(word) for word in words[:2]]
    wrong = [f"found {word!r}, expected seconds" for word, time in zip(words, times) if not math.isfinite(time)]
    if "/" in words[2] or not words[2].isprintable():
        wrong.append(f"found the name {words[2]!r}, expected one without '/'")
    if wrong:
        return None, wrong
    end_s = take.duration_s
    wrong += [
        f"found {time:g} s, expected 0 to {end_s:.3f} s, as long as take {take.name} lasts"
        for time in times
        if not -0.5 / take.rate_hz <= time <= end_s + 0.5 / take.rate_hz
    ]
    start, stop = (round(min(max(time, 0.0), end_s) * take.rate_hz) for time in times)
    if not wrong and stop - start < 1:
        wrong.append(f"found the end {words[1]} s, expected it a frame or more after the start {words[0]} s")
    return (None if wrong else Cut(start, stop, words[2])), wrong


def _again(line: str, names: dict[str, int], number: int) -> list[str]:
    """That a name stood in a line of the take before, its times readable or not; it is noted in ``names``."""
    words = line.split()
    if len(words) != 3 or names.setdefault(words[2], number) == number:
        return []
    return [f"found the name {words[2]!r} again, first in line {names[words[2]]}"]


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return math.nan


def _together(cuts: Sequence[tuple[int, Cut]], rate_hz: float) -> list[tuple[int, str]]:
    """Pieces of one take that overlap, with the line."""
    wrong: list[tuple[int, str]] = []
    for (_, before), (number, after) in itertools.pairwise(cuts):
        if after.start < before.stop:
            found, expected = f"{after.start / rate_hz:.3f} s", f"{before.stop / rate_hz:.3f} s"
            wrong.append((number, f"found the start {found}, expected {expected} or later, where {before.name} ends"))
    return wrong


def piece(take: Take, cut: Cut) -> Take:
    """Frames ``cut.start`` to ``cut.stop`` of a take: same worker, trial "<trial>.<name>", the marks within."""
    inside = slice(cut.start, cut.stop + 1)
    marks = {name: at - cut.start for name, at in take.mark_frame.items() if cut.start <= at <= cut.stop}
    return replace(
        take,
        positions_m=take.positions_m[inside],
        trial=f"{take.trial}.{cut.name}",
        mark_frame=marks,
        contact=None if take.contact is None else np.asarray(take.contact)[inside],
    )


def cut_recording(recording: Recording, found: Sequence[Segments], said: str) -> Recording:
    """All pieces of a recording, in order, with notes on what was done. Raises ValueError where there is none.

    A mark is kept where every piece has it.
    """
    pieces = [piece(segments.take, cut) for segments in found for cut in segments.cuts]
    if not pieces:
        raise ValueError("nothing was cut: found no repetition in any take")
    every = set(recording.takes[0].mark_frame)
    shared = set.intersection(*(set(one.mark_frame) for one in pieces))
    pieces = [replace(one, mark_frame={n: at for n, at in one.mark_frame.items() if n in shared}) for one in pieces]
    lost = [f"the mark {name} was left out: not every piece has it" for name in sorted(every - shared)]
    notes = (*recording.notes, f"{said}: {len(pieces)} pieces of {len(found)} takes", *lost)
    return replace(recording, takes=tuple(pieces), notes=notes)
