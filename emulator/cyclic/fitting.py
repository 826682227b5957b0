"""The fit of a CyclicEmulator, told in order: takes, latents, workers, dynamics, units, pace, report.

Draws of a cyclic emulator beside its recordings: slide of the feet, times, steps, roughness.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from emulator.cyclic.contacts import foot_skate_m
from emulator.cyclic.latent import Finer, PoseLatent, nothing_finer
from emulator.cyclic.law import rates
from emulator.cyclic.model import CyclicEmulator
from emulator.cyclic.preparation import (
    ENERGY,
    MOST_UNITS,
    RATE_HZ,
    Measured,
    Prepared,
    Progress,
    crew_of,
    cut,
    latent_of,
    measured,
    paced,
    prepared,
    walks,
    with_turns,
)
from emulator.cyclic.report import CyclicReport
from emulator.cyclic.serialise import unbounded
from emulator.cyclic.switching_dynamics import SwitchingDynamics
from emulator.cyclic.units import Crew, Guide, Unit, spread_out
from emulator.recordings.take import Recording
from emulator.skeleton import Skeleton

if TYPE_CHECKING:
    from emulator.cyclic.performances import CyclicPerformances

Cut = tuple[Unit | None, Unit | None, slice, list[int]]
STATES = {0: "no foot bears", 1: "left foot bears", 2: "right foot bears", 3: "both feet bear"}


def fit(
    recording: Recording,
    *,
    task: str = "walk",
    steps: bool | None = None,
    components: int | float = ENERGY,
    n_states: int = 1,
    points: int = 200,
    seed: int = 0,
    where: str = "all",
    command: str = "",
    progress: Progress = None,
) -> CyclicEmulator:
    """Learn cyclic motion from takes that each hold several cycles.

    steps      : whether it is walking; None: whether the takes go somewhere
    components : of the latent, a number or a share of the variation
    n_states   : of the dynamics where no feet step, found without labels; 1: one process
    points     : of each state that the dynamics keep; seed decides nothing but the figures of the report
    Contact of the takes is used where they have it, else found.
    Raises ValueError for takes of markers, with gaps, or with too few cycles.
    """
    from threadpoolctl import threadpool_limits

    asked = Wanted(task, steps, components, n_states, points, seed, where, command)
    with threadpool_limits(1, user_api="blas"):  # one thread: the same recordings give the same bytes everywhere
        return _fitted(recording, asked, progress or (lambda done, total, label: None))


@dataclass(frozen=True)
class Wanted:
    """The settings of a fit, see ``fit``."""

    task: str
    steps: bool | None
    components: int | float
    n_states: int
    points: int
    seed: int
    where: str
    command: str


def _fitted(recording: Recording, wanted: Wanted, said: Callable[[int, int, str], None]) -> CyclicEmulator:
    task = wanted.task
    if recording.parents is None:
        raise ValueError(f"{task}: found markers, expected joints; map them first")
    skeleton = Skeleton(recording.names, recording.parents)
    steps = walks(recording) if wanted.steps is None else wanted.steps
    parts = [prepared(take, skeleton, steps) for take in recording.takes]
    latent, moved = latent_of(parts, wanted.components)
    zs = [latent.forward(part.poses) for part in parts]
    if not steps:
        parts = [with_turns(part, z) for part, z in zip(parts, zs)]
    said(1, 4, "latents")
    cuts = [cut(part, z, 0.0, steps) for part, z in zip(parts, zs)]
    takes = [
        measured(part, skeleton, frames, _n(start), _n(stop), steps)
        for part, (start, stop, _, frames) in zip(parts, cuts)
    ]
    names = tuple(dict.fromkeys(part.take.worker for part in parts))
    pace, log_step = paced(takes, steps, names, 1 / (recording.rate_hz if steps else RATE_HZ))
    at, by = _scale([take.log_step for take in takes]) if steps else (0.0, 1.0)
    control = [(take.log_step - at) / by if steps else 0.0 for take in takes]
    offsets = _offsets([z[rows] for z, (_, _, rows, _) in zip(zs, cuts)], control, [p.take.worker for p in parts])
    zs = [z - offsets[part.take.worker] for z, part in zip(zs, parts)]
    cuts = [cut(part, z, c, steps) for part, z, c in zip(parts, zs, control)]
    crew = crew_of(parts, offsets, log_step)
    said(2, 4, "dynamics")
    cyclic = [z[rows] for z, (_, _, rows, _) in zip(zs, cuts)]
    states = _states(parts, cuts, cyclic, steps, wanted.n_states)
    known = [np.full((len(z), 1), c) for z, c in zip(cyclic, control)] if steps and np.ptp(control) > 0 else None
    order, usual = (1, 0) if steps else (2, _beat_frames(takes)[1])
    dynamics = SwitchingDynamics.fit(
        [_seen(z[:, :moved], usual) for z in cyclic], states, controls=known, at_most=wanted.points, on_support=False
    )
    dynamics = unbounded(dynamics)
    inputs = [np.hstack([z[:, :moved], k]) for z, k in zip(cyclic, known or [z[:, :0] for z in cyclic])]
    finer = Finer.fit(inputs, [z[:, moved:] for z in cyclic]) if latent.n_components > moved else nothing_finer(moved)
    said(3, 4, "report")
    starts = spread_out([unit for unit, _, _, _ in cuts if unit is not None], MOST_UNITS)
    stops = spread_out([unit for _, unit, _, _ in cuts if unit is not None], MOST_UNITS)
    every_beat = _entries(parts, zs, cuts, control)
    model = CyclicEmulator(
        task=task,
        skeleton=skeleton,
        rate_hz=RATE_HZ,
        latent=latent,
        dynamics=dynamics,
        finer=finer,
        temper=1.0,
        order=order,
        starts=starts,
        stops=stops,
        entries=spread_out(every_beat, 2 * MOST_UNITS),
        guide=Guide.of(every_beat, moved),
        pace=pace,
        crew=crew,
        control_at=at,
        control_by=by,
        ankle_legs=_above_floor(parts, skeleton, "ankle", 0.3),
        toe_legs=_above_floor(parts, skeleton, "toe", 0.1),
        contact_states=steps,
        beat_frames=_beat_frames(takes),
        report=_report(task, recording, parts, latent, dynamics, states, crew, steps, wanted.where, wanted.command),
    )
    pass
    from emulator.cyclic.serialise import rounded

    model = tempered(rounded(model), parts, takes)
    model = replace(model, report=judged(model, parts, takes, wanted.seed))
    said(4, 4, "done")
    return model


def _seen(z: np.ndarray, beat_frames: int) -> np.ndarray:
    """(T, d) what the dynamics see: latents, and, of work that is no walking, how they change."""
    if not beat_frames:
        return z
    before = np.concatenate([2 * z[:1] - z[1:2], z[:-1]])
    return np.hstack([z, rates(z, before, beat_frames)])


def _n(unit: Unit | None) -> int:
    return 0 if unit is None else unit.n_steps


def _scale(values: list[float]) -> tuple[float, float]:
    spread = float(np.std(values))
    return float(np.mean(values)), spread if spread > 1e-6 else 1.0


def _offsets(cyclic: list[np.ndarray], control: list[float], owners: list[str]) -> dict[str, np.ndarray]:
    """Where each worker's cyclic latents lie beside everybody's at the same speed: (d,) by name, mean zero."""
    mean = np.array([z.mean(axis=0) for z in cyclic])
    of_speed = np.column_stack([np.ones(len(control)), control])
    rest = mean - of_speed @ np.linalg.lstsq(of_speed, mean, rcond=None)[0]
    own = {name: rest[[o == name for o in owners]].mean(axis=0) for name in dict.fromkeys(owners)}
    middle = np.mean(list(own.values()), axis=0)
    return {name: value - middle for name, value in own.items()}


def _states(
    parts: list[Prepared],
    cuts: list[Cut],
    cyclic: list[np.ndarray],
    steps: bool,
    n_states: int,
) -> list[np.ndarray]:
    """The state of each cyclic frame: left + 2 right of contact, rare ones as the frame before; or found ones."""
    from emulator.cyclic.contacts import found_states, state_of_contact

    if not steps:
        return found_states(cyclic, n_states, RATE_HZ) if n_states > 1 else [np.zeros(len(z), int) for z in cyclic]
    states = [np.array(state_of_contact(part.contact[rows])) for part, (_, _, rows, _) in zip(parts, cuts)]
    every = np.concatenate(states)
    rare = [s for s in np.unique(every) if np.mean(every == s) < 0.02 or np.sum(every == s) < 20]
    for state in states:
        for t in np.flatnonzero(np.isin(state, rare)):
            state[t] = state[t - 1] if t else 3
    return states


def _entries(parts: list[Prepared], zs: list[np.ndarray], cuts: list[Cut], control: list[float]) -> list[Unit]:
    """Every recorded beat, up to the next one."""
    return [
        Unit(z[start : stop + 1], part.contact[start : stop + 1], c, dict(part.beats)[start])
        for part, z, (_, _, _, frames), c in zip(parts, zs, cuts, control)
        for start, stop in pairwise(frames)
    ]


def _above_floor(parts: list[Prepared], skeleton: Skeleton, joint: str, quantile: float) -> float:
    """Height of a joint of a foot that stands flat, in legs: this quantile over all frames in which it bears."""
    if not {f"left_{joint}", f"right_{joint}"} <= set(skeleton.names):
        return 0.0
    feet = [skeleton.names.index(f"{side}_{joint}") for side in ("left", "right")]
    heights = []
    for part in parts:
        floor = part.positions_m[:, skeleton.root, 2] - part.poses.height * part.leg_m
        above = (part.positions_m[:, feet, 2] - floor[:, None]) / part.leg_m
        heights.append(above[part.contact])
    return float(np.quantile(np.concatenate(heights), quantile))


def _beat_frames(takes: list[Measured]) -> tuple[int, int]:
    """The fewest frames between two beats, and their usual number."""
    usual = float(np.median(np.concatenate([take.beat_s for take in takes]))) * RATE_HZ
    return max(int(0.4 * usual), 1), max(round(usual), 2)


def _report(
    task: str,
    recording: Recording,
    parts: list[Prepared],
    latent: PoseLatent,
    dynamics: SwitchingDynamics,
    states: list[np.ndarray],
    crew: Crew,
    steps: bool,
    where: str,
    command: str,
) -> CyclicReport:
    """Before draws are judged."""
    every = np.concatenate(states)
    share = {int(state): float(np.mean(every == state)) for state in dynamics.states}
    named = tuple(f"{STATES[s] if steps else f'state {s + 1}'} ({100 * p:.0f} %)" for s, p in share.items())
    fitted = dynamics.fitted
    hyper = () if fitted is None else tuple(
        f"{len(one.x)} points, lengths {', '.join(f'{v:.2g}' for v in one.hyper.length)}, "
        f"signal {one.hyper.signal:.2g}, noise {one.hyper.noise:.2g}"
        for one in fitted.processes
    )  # fmt: skip
    return CyclicReport(
        task=task,
        n_sequences=len(parts),
        n_workers=len(crew.names),
        n_components=latent.n_components,
        energy=float(latent.energy[latent.n_components - 1]),
        states=named,
        hyper=hyper,
        n_points=int(sum(len(z) for z in states)),
        source=recording.source,
        licence=recording.licence,
        where=where,
        command=command,
        methods=METHODS | ({"contact": "given"} if recording.takes[0].contact is not None else {"contact": "found"}),
        notes=recording.notes,
    )


METHODS = {
    "latent": "principal components of unit directions, travel and height",
    "dynamics": "switching Gaussian process dynamics, the state by Gaussian process classification, the speed an input",
    "workers": "a new worker blends the recorded ones: own latents, step length and bones, one Gaussian",
    "feet": "beats and footprints first, postures laid on them, two-bone inverse kinematics while a foot bears",
}


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
