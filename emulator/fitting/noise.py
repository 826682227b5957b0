"""How far draws go from what was recorded: as far as their movements stay ones that a body makes.

The farther a draw lies from every recording, the rougher and slower it moves; how far it may go differs from task to
task. So the laws of a worker's repetitions are tried from the one that goes farthest on, those of new people from the
least stiff on, and the first is taken whose draws are about as smooth and as quick as the recordings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.joint_speeds import median_speed_ratio, peak_ratio, share_too_fast
from emulator.model.emulator import MotionEmulator
from emulator.model.performances import MotionPerformances
from emulator.model.smoothed import MOST_NOISE, Bands, Curves, distance_to_recordings, drawn_about_recordings
from emulator.motion import MotionSet
from emulator.people.bone_turns import BoneTurns
from emulator.people.population import Population

STIFFNESSES = (4.0, 16.0, 64.0)
"""How much smoother than the recordings the noise about them may be, to choose from."""
NOISES = tuple((stiffness, most) for stiffness in STIFFNESSES for most in MOST_NOISE)
"""With how much of a curve's variance it may be: much of stiff noise is often farther off than little that is not."""
PEOPLE_STIFFNESSES = (1.0, 4.0, 16.0, 64.0)
"""How much smoother than people's own deviations that is by which new people deviate further, to choose from."""
MOST_JERK, MOST_JERK_NEW = 1.2, 1.3
"""Draws of known and of new people may have so many times the recorded peak jerk."""
MOST_FAST, MOST_FAST_NEW = 0.02, 0.05
"""And this share of them a joint that is too fast."""
ABOUT = 0.03
"""What goes less far by so little goes about as far: then less stiff noise, which is more like that of recordings."""
LEAST_SPEED = 0.93
"""And the median of their peak speed is at least so much of the recorded: peaks blurred together are slow."""
N_DRAWN = 200
"""Draws by which a law of new people is told smooth and quick."""


Noise = tuple[float, float]
"""How much smoother than what was recorded noise is, and what share of a posture's variance it may be."""
Tried = TypeVar("Tried", float, Noise)


def naturally(models: Sequence[tuple[Noise, MotionEmulator]], motions: MotionSet) -> tuple[Noise, MotionEmulator]:
    """Of models whose draws about the recordings are smooth enough what goes farthest; where none are, what goes least.

    models : from the least stiff on; of those that go about as far the first is tried first
    """

    def alike(model: MotionEmulator) -> MotionPerformances:
        assert model.workforce.smoothed is not None
        return model.performances(drawn_about_recordings(model.workforce.smoothed))

    return _first(_farthest_first(models), alike, motions, MOST_JERK, MOST_FAST)


def _farthest_first(models: Sequence[tuple[Noise, MotionEmulator]]) -> Iterator[tuple[Noise, MotionEmulator]]:
    left = [(_far(tried[1]), tried) for tried in models]
    while left:
        least = (1.0 - ABOUT) * max(far for far, _ in left)
        yield from (tried for far, tried in left if far >= least)
        left = [one for one in left if one[0] < least]


def _far(model: MotionEmulator) -> float:
    """Median distance of postures drawn about the recordings to the nearest of them; 0 where nothing is blurred."""
    smoothed, at = model.workforce.smoothed, model.scale.block("posture")
    return 0.0 if smoothed is None else distance_to_recordings(smoothed, at, model.scale.spread[at])


def with_population(
    model: MotionEmulator, curves: tuple[Curves, ...], motions: MotionSet, turns: BoneTurns
) -> tuple[float, MotionEmulator]:
    """The model with the least stiff law of new people whose draws are as smooth and quick as asked; else the stiffest.

    Unstiff, all of a person's deviation takes the size that the t gives it, fine detail and all: the law is widest, and
    roughest. The same model, and 0, where there is one person, or plain Gaussians.
    """
    crew = model.workforce
    if crew.smoothed is None or not crew.has_worker_effect:
        return 0.0, model
    populations = ((stiffness, population(model, curves, stiffness, turns)) for stiffness in PEOPLE_STIFFNESSES)
    models = ((stiffness, replace(model, workforce=replace(crew, population=law))) for stiffness, law in populations)
    return _first(models, lambda m: m.sample(N_DRAWN, np.random.default_rng(0)), motions, MOST_JERK_NEW, MOST_FAST_NEW)


def population(model: MotionEmulator, curves: tuple[Curves, ...], stiffness: float, turns: BoneTurns) -> Population:
    """The law of new people whose curves deviate further by what is this stiff of the people's own deviations."""
    crew, scale = model.workforce, model.scale
    between = crew.apart() / np.sqrt(crew.kinds.n_not_alone)
    bands = [(curve.at, Bands.of(between[:, curve.at], curve, stiffness)) for curve in curves]
    return Population.fit(between, bands, scale.block("bones"), crew.kinds, turns)


def _first(
    models: Iterable[tuple[Tried, MotionEmulator]],
    draw: Callable[[MotionEmulator], MotionPerformances],
    motions: MotionSet,
    most_jerk: float,
    most_fast: float,
) -> tuple[Tried, MotionEmulator]:
    recorded, rate_hz, last = None, frame_rate_hz(motions), None
    for last in models:
        model = last[1]
        recorded = recorded or Clips.recorded(motions, model.skeleton)
        drawn = Clips.drawn(draw(model), rate_hz)
        rough, slow = peak_ratio(drawn, recorded, 3) > most_jerk, median_speed_ratio(drawn, recorded) < LEAST_SPEED
        if not rough and not slow and share_too_fast(drawn, recorded) <= most_fast:  # NaN: nothing moves
            break
    assert last is not None
    return last
