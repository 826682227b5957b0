"""Draws of a cyclic emulator beside its recordings: slide of the feet, times, steps, roughness."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from emulator.cyclic.feet import foot_skate_m
from emulator.cyclic.measured import Measured
from emulator.cyclic.prepare import RATE_HZ, Prepared

if TYPE_CHECKING:
    from emulator.cyclic.model import CyclicEmulator
    from emulator.cyclic.performances import CyclicPerformances
    from emulator.cyclic.report import CyclicReport

MOST_DRAWN = 40
TEMPERS = (0.6, 0.45, 0.3, 0.15)
ROUGHEST = 1.1
"""Roughness drawn over recorded that is let pass."""
TEMPERING_SEED = 0
"""Of the draws by which the temper is chosen: a model does not depend on the seed of its report's figures."""
GIVEN_UP = 0.02
"""Share of beats at which the dynamics may come to none."""


def tempered(model: CyclicEmulator, parts: list[Prepared], takes: list[Measured]) -> CyclicEmulator:
    """The model with the first of ``TEMPERS`` at which draws are no rougher than recordings and come to beats.

    If there is none, the one at which the fewest beats are given up.
    """
    recorded, best = _roughness([part.positions_m for part in parts]), (np.inf, model)
    for temper in TEMPERS:
        model = replace(model, temper=temper)
        drawn = _drawn(model, takes, np.random.default_rng(TEMPERING_SEED))
        given_up = _given_up(drawn)
        if given_up <= GIVEN_UP and _roughness([_frames(one) for one in drawn]) <= ROUGHEST * recorded:
            return model
        best = min(best, (given_up, model), key=lambda pair: pair[0])
    return best[1]


def judged(model: CyclicEmulator, parts: list[Prepared], takes: list[Measured], seed: int) -> CyclicReport:
    """The report with figures of draws by the recorded workers at the recorded speeds."""
    drawn = _drawn(model, takes, np.random.default_rng(seed))
    frames = [_frames(one) for one in drawn]
    beats = [np.diff(one.beat_s[0]) for one in drawn]
    report = replace(
        model.report,
        beat_s=(*_mean_cv([take.beat_s for take in takes], model.pace.time_cv), *_mean_cv(beats)),
        given_up=_given_up(drawn),
        jump_ratio=_roughness(frames) / _roughness([part.positions_m for part in parts]),
    )
    if not model.pace.steps:
        return report
    steps = [np.diff(one.place_m[0]) for one in drawn]
    speeds = [take.speed_m_per_s for take in takes]
    report = replace(
        report,
        step_m=(*_mean_cv([take.step_m for take in takes]), *_mean_cv(steps)),
        speed_m_per_s=(min(speeds), max(speeds)),
    )
    if model.legs is None:
        return report
    recorded = [foot_skate_m(part.positions_m, part.contact, model.skeleton) for part in parts]
    slid = [foot_skate_m(p, _contact(one, len(p)), model.skeleton) for one, p in zip(drawn, frames)]
    return replace(
        report,
        skate_recorded_cm=float(100 * np.concatenate(recorded).mean()),
        skate_drawn_cm=float(100 * np.concatenate(slid).mean()),
    )


def _drawn(model: CyclicEmulator, takes: list[Measured], rng: np.random.Generator) -> list[CyclicPerformances]:
    """One for each take (MOST_DRAWN of them): by its worker, as long as it and in its steady part as fast."""
    drawn = []
    for k in np.random.default_rng(0).permutation(len(takes))[:MOST_DRAWN]:
        take = takes[k]
        cycles = max(len(take.beat_s) // (2 if model.pace.steps else 1), 1)
        condition: dict[str, float] = {"cycles": cycles}
        if model.pace.steps:
            mean = take.speed_m_per_s * (2 * cycles + model.pace.halves) / (2 * cycles + model.pace.beyond)
            condition["speed_m_per_s"] = float(np.clip(mean, 0.3, 2.5))
        drawn.append(model.sample(1, rng, worker=take.worker, condition=condition))
    return drawn


def _given_up(drawn: list[CyclicPerformances]) -> float:
    """Share of the beats at which the dynamics came to none."""
    beats = sum(len(one.tracks[0].line.beat_frame) - 1 for one in drawn)
    return float(sum(one.tracks[0].line.given_up for one in drawn) / max(beats, 1))


def _frames(one: CyclicPerformances) -> np.ndarray:
    return np.asarray(one.positions_m(np.arange(0.0, one.duration_s[0], 1 / RATE_HZ))[0])


def _contact(one: CyclicPerformances, n: int) -> np.ndarray:
    return np.asarray(one.contact(np.arange(n) / RATE_HZ)[0])


def _mean_cv(parts: list[np.ndarray], cv: float | None = None) -> tuple[float, float]:
    """Mean, and the scatter about each part's own mean."""
    mean = float(np.concatenate(parts).mean())
    if cv is not None:
        return mean, cv
    rest = np.concatenate([part / part.mean() - 1 for part in parts if len(part) > 1])
    free = sum(len(part) - 1 for part in parts if len(part) > 1)
    return mean, float(np.sqrt((rest**2).sum() / max(free, 1)))


def _roughness(parts: list[np.ndarray]) -> float:
    """Root mean square of the joints' change of velocity between frames, over all joints."""
    return float(np.sqrt(np.mean([np.mean(np.diff(p, n=2, axis=0) ** 2) for p in parts])))
