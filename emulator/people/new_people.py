"""Workers who were never recorded: a person of the population, as far as his body and his pace are known."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.covariates.body import Body, BodyError
from emulator.model.gaussian import LowRankNormal, regression
from emulator.people.workers import WorkerEffect

if TYPE_CHECKING:
    from emulator.model.emulator import MotionEmulator

People = Callable[[str], float]
"""A standard normal number of one worker for each recorded person's name: the same in all tasks that he does."""
BODY_KEYS = ("height_m", "mass_kg", "age_years", "sex", "pace", "person")
ALWAYS = ("height_m", "pace", "person")
"""What is read whatever the recordings tell: bones are scaled, times moved, and the person looked for."""
_CROWN_AND_SOLE_M = 0.20
"""Ankle above the floor and crown above the head joint, in a body whose height is asked for."""
_CHAIN = ("left_ankle", "left_knee", "spine", "chest", "neck", "head")


def drawn_worker(
    model: MotionEmulator, rng: np.random.Generator, body: Any, people: People | None, slowness: float | None
) -> WorkerEffect | None:
    """See ``MotionEmulator.draw_worker``."""
    person = body.get("person") if isinstance(body, Mapping) else getattr(body, "person", None)
    known = _body(model, body)
    if person in model.workers:
        return _recorded(model, rng, person, known)
    if not model.workforce.has_worker_effect and known == Body():
        return None
    return _drawn(model, rng, known, people, slowness, "clamp")


def new_worker(
    model: MotionEmulator, rng: np.random.Generator | None, body: Mapping[str, Any], people: People | None, outside: str
) -> WorkerEffect:
    """See ``MotionEmulator.new_worker``."""
    known, person = _body(model, body), body.get("person")
    if rng is not None and not isinstance(rng, np.random.Generator):
        raise BodyError(
            [f"new_worker: found {rng!r} first, expected a numpy Generator; a body goes by names: height_m=1.7"]
        )
    if person is not None:
        return _recorded(model, rng, model.known_worker(person).name, known)
    if rng is not None:
        return _drawn(model, rng, known, people, None, outside)
    law = model.workforce.about(known, outside)
    return _as_asked(model, law.mean + model.workforce.kinds.most_frequent_shift, law, known, outside)


def body_keys(model: MotionEmulator) -> tuple[str, ...]:
    """See ``MotionEmulator.body_keys``."""
    return tuple(name for name in BODY_KEYS if name in ALWAYS or name in model.workforce.telling)


def _body(model: MotionEmulator, body: Any) -> Body:
    if isinstance(body, Mapping):
        body = {name: value for name, value in body.items() if name != "person"}
    told = model.workforce.told
    return Body.of(body, () if told is None else told.model.names)


def _recorded(model: MotionEmulator, rng: np.random.Generator | None, person: str, body: Body) -> WorkerEffect:
    """A recorded person: his shrunk mean, by luck what his repetitions leave open; at ``pace`` times his own."""
    crew, effect = model.workforce, model.known_worker(person)
    z = effect.z
    if rng is not None:
        spread = np.where(crew.between.spread > 0, crew.between.spread, 1.0)
        unit = (crew.between.sample(1, rng)[0] - crew.between.mean) / spread
        z = z + crew.doubt[crew.names.index(person)] * unit
    if body.pace is not None:
        z = at_pace(model, z, crew.between, z, body.pace)
    scale = 1.0 if body.height_m is None else _scale(model, z, body.height_m)
    return replace(effect, z=z, scale=scale)


def _drawn(
    model: MotionEmulator,
    rng: np.random.Generator,
    body: Body,
    people: People | None,
    slowness: float | None,
    outside: str,
) -> WorkerEffect:
    """Somebody with this body; ``people`` lean on the first rows of the law, what else there is goes by luck."""
    crew = model.workforce
    law = crew.about(body, outside)
    numbers = None
    if people is not None:
        numbers = np.array([people(f"{crew.group}/{name}") for name in crew.names], float)
        if not np.isfinite(numbers).all():
            raise BodyError([f"people: found {numbers.tolist()}, expected a finite number for each of {crew.names}"])
    z, like = crew.somebody(law, body, rng, numbers)
    if slowness is not None and not np.isfinite(slowness):
        raise BodyError([f"slowness: found {slowness}, expected a finite number of standard deviations"])
    if slowness is not None and body.pace is None:
        at = model.scale.block("duration").start
        z = _moved(z, law.covariance_with(at), at, law.mean[at] + slowness * law.spread[at])
    turns = crew.turns(1, model.skeleton, rng, numbers)
    return replace(_as_asked(model, z, law, body, outside), like=like, turns=None if turns is None else turns.made[0])


def _as_asked(model: MotionEmulator, z: np.ndarray, law: LowRankNormal, body: Body, outside: str) -> WorkerEffect:
    """At the pace and as tall as was asked for; what was done with the rest of the body in words."""
    if body.pace is not None:
        z = at_pace(model, z, law, model.workforce.between.mean, body.pace)
    told = model.workforce.told
    said = [] if told is None or body == Body() else told.model.explain(body, outside, elsewhere=ALWAYS).uses
    lines = [str(use) for use in said if use.how != "clamped" or use.name in model.workforce.telling]
    scale = 1.0 if body.height_m is None else _scale(model, z, body.height_m)
    return WorkerEffect(z, scale=scale, said=tuple(lines))


def at_pace(model: MotionEmulator, z: np.ndarray, law: LowRankNormal, usual: np.ndarray, pace: float) -> np.ndarray:
    """A worker's mean z (K,), moved so that he is ``pace`` times as fast as ``usual`` (K,) in median moving time.

    The rest of z follows log duration by its regression in ``law`` (where workers do not differ: within workers).
    """
    at = model.scale.block("duration").start
    between, within = (normal.covariance_with(at) for normal in (law, model.workforce.within))
    log_s = model.margin.inverse(model.scale.raw(usual[None], "duration")[:, 0])
    return _moved(z, between if between[at] > 1e-12 else within, at, model.duration_z(log_s - np.log(pace))[0])


def _moved(z: np.ndarray, column: np.ndarray, at: int, wanted: float) -> np.ndarray:
    """z (K,) with its coordinate ``at`` as wanted, the rest by its regression: covariances ``column`` (K,) with it."""
    return np.asarray(z + (wanted - z[at]) * regression(column, at))


def _scale(model: MotionEmulator, z: np.ndarray, height_m: float) -> float:
    """What makes the bones of z (K,) those of somebody ``height_m`` tall.

    Where the recordings tell bones by height, only what lies beyond them is left to scale; else the chain from ankle to
    head is to be the height less 0.20 m for sole and crown, which is right to 1-5 %. 1 for a skeleton without it.
    """
    told = model.workforce.told
    if told is not None and "height_m" in told.model.telling and _bones_told(model):
        i = told.model.names.index("height_m")
        return float(height_m / np.clip(height_m, told.model.low[i], told.model.high[i]))
    length = dict(zip(model.skeleton.bone_names, model.bone_length_m(z[None])[0]))
    if not set(_CHAIN) <= set(length):
        return 1.0
    return (height_m - _CROWN_AND_SOLE_M) / float(sum(length[name] for name in _CHAIN))


def _bones_told(model: MotionEmulator) -> bool:
    """Whether height tells the bones' first score."""
    told, bones = model.workforce.told, model.scale.block("bones")
    assert told is not None
    return bool(told.model.explained[bones][:1].any())
