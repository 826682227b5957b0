"""Segmenting: walking and sneaking against foot contact, dimension, the seed's figures, long takes cut back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from emulator.composite.joining import joined
from emulator.recordings.npz import read_recording
from emulator.recordings.take import Take
from emulator.segmenting.repetitions import postures, repetitions
from emulator.segmenting.segment import Segments, segment
from emulator.segmenting.synthesis import motion_of, take_of
from emulator.synthetic.long_take import long_take
from tests.long_take import plain, usual_ends
from tests.take_evidence import segmenting_figures
from tests.take_evidence.cycles_judged import Judged, judged

SHARE = 0.9
CLASSES = ("sit_to_stand", "deep_squat", "side_lunge", "shoulder_abduction")
MADE = ("reach", "fasten", "inspect", "lift")
Line = tuple[str, str, bool]


def evidence(motion: Path, out: Path) -> Iterator[Line]:
    """(claim, what was found, whether the bound holds), and figures of the seed's kind in ``out``."""
    yield from _walking(motion, out)
    yield from _sneaking(motion, out)
    yield from _long_takes(motion, out)
    yield from _made_takes()


def _walking(motion: Path, out: Path) -> Iterator[Line]:
    takes = read_recording(motion / "bandai2_walk.npz").takes
    found = [segment(take, "cycles") for take in takes]
    figures = [_judged(one) for one in found]
    dimensions = Counter(one.curve.dimension for one in found if one.curve)
    said = ", ".join(f"{d} in {n}" for d, n in sorted(dimensions.items(), reverse=True))
    yield (
        f"bandai2_walk, all {len(takes)} takes: the intrinsic dimension is 3 in most",
        f"{said} takes",
        dimensions.most_common(1)[0][0] == 3,
    )
    yield _cycles_line(f"bandai2_walk, all {len(takes)} takes of seven styles", figures, SHARE)
    strides_found, strides = (sum(getattr(one, key) for one in figures) for key in ("strides_found", "strides"))
    yield (
        "bandai2_walk: 90 % of the strides recorded that lie within a take are found",
        f"{strides_found} of {strides} = {strides_found / strides:.1%}",
        strides_found >= SHARE * strides,
    )
    even = [judged(_even_grid(one), np.asarray(one.take.contact)) for one in found]
    right, n = sum(one.right for one in even), sum(one.judged for one in even)
    yield (
        "for comparison, not a bound: boundaries laid out evenly, one mean cycle apart",
        f"{right} of {n} = {right / n:.1%} within 3 frames",
        True,
    )
    yield _of_three_styles(takes)
    tiled = all(one.units[0].start == 0 and one.units[-1].stop == one.take.n_frames for one in found)
    standing = max(found, key=lambda one: one.units[0].n_frames)
    lengths = "|".join(str(unit.n_frames) for unit in standing.units)
    yield (
        "units: preparing, initial, cyclic, final, wind-up tile every take; some begin standing",
        f"longest: {standing.take.name}, {lengths} frames of {standing.take.n_frames}",
        tiled,
    )
    segmenting_figures.draw_manifold(standing, out / "figure_1_manifold.svg")
    noisy = next(one for one in found if one.take.name.endswith("elderly_001"))
    segmenting_figures.draw_denoising(noisy, out / "figure_2_denoising.svg")
    segmenting_figures.draw_units([standing, noisy], out / "figure_3_units_walking.svg")
    segmenting_figures.draw_offsets(figures, out / "boundaries_against_contact.svg")


def _of_three_styles(takes: Sequence[Take]) -> Line:
    """Walks of other paces in one take, where laying out boundaries evenly does not help."""
    by_style: dict[str, list[Take]] = {}
    for take in takes:
        by_style.setdefault(str(take.covariates["cov_style"]), []).append(take)
    ours, even = [], []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        styles = rng.permutation(sorted(by_style))[:3]
        found = segment(_joined([by_style[style][rng.integers(len(by_style[style]))] for style in styles]), "cycles")
        ours.append(_judged(found))
        even.append(judged(_even_grid(found), np.asarray(found.take.contact)))
    right, n, lucky = sum(o.right for o in ours), sum(o.judged for o in ours), sum(o.right for o in even)
    return (
        "bandai2_walk, eight takes of three styles each, joined, one offset for three paces: within 3 frames for 80 %",
        f"{right} of {n} = {right / n:.1%}; laid out evenly {lucky} of {sum(o.judged for o in even)}",
        right >= 0.8 * n,
    )


def _judged(found: Segments, *, lifts: bool = False) -> Judged:
    boundary = np.array([cut.start for cut in found.cuts] + [found.cuts[-1].stop], float)
    return judged(boundary, np.asarray(found.take.contact), lifts=lifts)


def _even_grid(found: Segments) -> np.ndarray:
    return np.linspace(found.cuts[0].start, found.cuts[-1].stop, len(found.cuts) + 1)


def _cycles_line(of: str, figures: Sequence[Judged], share: float) -> Line:
    right, n = sum(one.right for one in figures), sum(one.judged for one in figures)
    off = np.concatenate([one.off_frames for one in figures])
    return (
        f"{of}: both boundaries of a cycle within 3 frames of foot contact (after one constant offset a take) for "
        f"{share:.0%} of cycles",
        f"{right} of {n} = {right / n:.1%}; boundaries off by {np.median(off):.1f} frames in the median, "
        f"{np.quantile(off, 0.95):.1f} at 95 %",
        right >= share * n,
    )


def _sneaking(motion: Path, out: Path) -> Iterator[Line]:
    """A take of two steps is one stride, so there is no cycle in it to find again: those of a person are joined."""
    takes = read_recording(motion / "hdm05_sneak_2steps.npz").takes
    long = [_joined([take for take in takes if take.worker == worker]) for worker in ("bd", "bk", "dg")]
    found = [segment(take, "cycles") for take in long]
    figures = [_judged(one, lifts=True) for one in found]
    said = ", ".join(f"{one.take.worker} {one.curve.dimension}" for one in found if one.curve)
    yield "hdm05_sneak_2steps, the takes of a person joined: intrinsic dimension", said, True
    lengths = "; ".join(
        f"{one.take.worker} " + "|".join(str(unit.n_frames) for unit in one.units) + f", {len(one.cuts)} cycles"
        for one in found
    )
    yield "hdm05_sneak_2steps: units and cycles are found in each joined take", lengths, all(one.cuts for one in found)
    yield _cycles_line("hdm05_sneak_2steps, joined, strike or lift of a foot, one kind a take", figures, SHARE)
    strike = [_judged(one) for one in found]
    right, n = sum(one.right for one in strike), sum(one.judged for one in strike)
    yield "the same against strikes only, as the walks are judged (not a bound)", f"{right} of {n}", True
    segmenting_figures.draw_units(found, out / "figure_3_units_sneaking.svg")


def _joined(takes: Sequence[Take]) -> Take:
    whole = take_of(joined([motion_of(take) for take in takes]), takes[0].rate_hz)
    contact = [np.asarray(take.contact)[:-1] for take in takes[:-1]] + [np.asarray(takes[-1].contact)]
    return replace(whole, contact=np.concatenate(contact), trial="joined")


def _long_takes(motion: Path, out: Path) -> Iterator[Line]:
    views: list[Any] = []
    for name in CLASSES:
        takes = read_recording(motion / f"uiprmd_{name}.npz").takes
        good = [take for take in takes if take.covariates["cov_correct"] == 1 and take.covariates["cov_vmax"] < 13]
        people = sorted({take.worker for take in good})
        within = [
            _of_person(name, [t for t in good if t.worker == worker], i, views) for i, worker in enumerate(people)
        ]
        counted = sum(n is not None for n in within)
        said = ", ".join(f"{worker} {n}" for worker, n in zip(people, within, strict=True))
        total = sum(n or 0 for n in within)
        yield (
            f"{name}: 12 repetitions with holds of 1 to 4 s joined to a take of each of {len(people)} people: "
            "12 found, start and end within 10 frames for 90 %",
            f"12 found in {counted} of {len(people)}; {total} of {12 * len(people)} within 10 frames ({said})",
            counted == len(people) and total >= SHARE * 12 * len(people),
        )
        if name == "sit_to_stand":
            whole = [worker for worker, n in zip(people, within, strict=True) if n == 12]
            yield (
                "uiprmd_sit_to_stand: a long take cut back into its 12 within 10 frames each",
                f"in full for {', '.join(whole)}",
                "s01" in whole,
            )
        yield _of_several(name, good)
    segmenting_figures.draw_long(views, out / "long_takes.svg")


def _of_person(name: str, takes: Sequence[Take], number: int, views: list[Any]) -> int | None:
    rng = np.random.default_rng([7, number])
    own = usual_ends([plain(take) for take in takes])
    order = rng.permutation(len(own))
    take, truth = long_take([own[order[i % len(own)]] for i in range(12)], rng)
    if number == 0:
        views.append((name, segment(take), truth))
    return within_ten(take, truth)


def _of_several(name: str, good: Sequence[Take]) -> Line:
    rng = np.random.default_rng(11)
    motions = usual_ends([plain(take) for take in good])
    take, truth = long_take([motions[i] for i in rng.permutation(len(motions))[:12]], rng)
    n, found = within_ten(take, truth), len(repetitions(postures(take), take.rate_hz).start)
    said = f"found {found}" + ("" if n is None else f", {n} within 10 frames")
    return f"{name}: 12 repetitions of several people in one take: 12 found", said, found == 12


def within_ten(take: Take, truth: np.ndarray) -> int | None:
    """Repetitions whose start and end are within 10 frames of the truth; None where their number is wrong."""
    found = repetitions(postures(take), take.rate_hz)
    if len(found.start) != len(truth):
        return None
    off = np.abs(np.stack([found.start, found.stop], axis=1) - truth)
    return int(np.sum(off.max(axis=1) <= 10))


def _made_takes() -> Iterator[Line]:
    from emulator.synthetic.tasks import make

    within: dict[str, int | None] = {}
    for task in MADE:
        motions = [replace(one, mark_s=np.zeros(0)) for one in make(task, 1, 12, seed=1)[0].motions]
        within[task] = within_ten(*long_take(motions, np.random.default_rng(1)))
    yield (
        "made tasks, 12 repetitions each with holds: 12 found, 11 or more within 10 frames",
        ", ".join(f"{task} {n}" for task, n in within.items()),
        all(n is not None and n >= 11 for n in within.values()),
    )
