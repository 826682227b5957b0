"""Workers who were never recorded: a person of the population, as far as his body and his pace are known."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.covariates.body import Body
from emulator.workforce import WorkerEffect

if TYPE_CHECKING:
    from emulator.model import MotionEmulator

People = Callable[[str], float]
"""A standard normal number of one worker for each recorded person's name: the same in all tasks that he does."""
BODY_KEYS = ("height_m", "mass_kg", "age_years", "sex", "pace", "person")
_CROWN_AND_SOLE_M = 0.20
"""Ankle above the floor and crown above the head joint, in a body whose height is asked for."""


def drawn_worker(
    model: MotionEmulator, rng: np.random.Generator, body: Any, people: People | None, slowness: float | None
) -> WorkerEffect | None:
    """See ``MotionEmulator.draw_worker``."""
    person = body.get("person") if isinstance(body, Mapping) else getattr(body, "person", None)
    known = _body(model, body)
    if person in model.workers:
        return _as_asked(model, model.known_worker(person), known)
    if not model.workforce.has_worker_effect and known == Body():
        return None
    drawn = _drawn(model, rng, known, people, "clamp")
    return drawn if slowness is None or known.pace is not None else _this_slow(model, drawn, known, slowness)


def new_worker(
    model: MotionEmulator, rng: np.random.Generator | None, body: Mapping[str, Any], people: People | None, outside: str
) -> WorkerEffect:
    """See ``MotionEmulator.new_worker``."""
    known = _body(model, body)
    if rng is not None:
        return _drawn(model, rng, known, people, outside)
    return _as_asked(
        model, WorkerEffect(model.workforce.about(known, outside).mean, said=_said(model, known, outside)), known
    )


def body_keys(model: MotionEmulator) -> tuple[str, ...]:
    """See ``MotionEmulator.body_keys``."""
    always = ("height_m", "pace", "person")
    return tuple(name for name in BODY_KEYS if name in always or name in model.workforce.reads)


def _drawn(
    model: MotionEmulator, rng: np.random.Generator, body: Body, people: People | None, outside: str
) -> WorkerEffect:
    crew = model.workforce
    own = crew.about(body, outside)
    if people is None:
        z = own.sample(1, rng)[0]
    else:
        z = own.of(np.array([people(f"{crew.group}/{name}") for name in crew.names]) @ crew.by_person, rng)
    return _as_asked(model, WorkerEffect(z, said=_said(model, body, outside)), body)


def _said(model: MotionEmulator, body: Body, outside: str) -> tuple[str, ...]:
    return () if body == Body() else model.workforce.said_of(body, outside)


def _body(model: MotionEmulator, body: Any) -> Body:
    if isinstance(body, Mapping):
        body = {name: value for name, value in body.items() if name != "person"}
    return Body.of(body, model.workforce.covariate_names)


def _as_asked(model: MotionEmulator, effect: WorkerEffect, body: Body) -> WorkerEffect:
    """With the pace and the height asked for, where no covariates have given them yet."""
    if body.pace is not None and "pace" not in model.workforce.covariate_names:
        centre = effect.z if effect.name else model.workforce.between.mean
        effect = replace(effect, z=at_pace(model, effect.z, centre, body.pace))
    return effect if body.height_m is None else replace(effect, scale=_scale(model, effect.z, body.height_m))


def _this_slow(model: MotionEmulator, effect: WorkerEffect, body: Body, slowness: float) -> WorkerEffect:
    """The worker at so many standard deviations of log moving time from the mean of those with his body."""
    own = model.workforce.about(body)
    at = model.scale.block("duration").start
    z = _moved(effect.z, own.covariance_with(at), at, own.mean[at] + slowness * own.spread[at])
    return replace(effect, z=z)


def at_pace(model: MotionEmulator, z: np.ndarray, centre: np.ndarray, pace: float) -> np.ndarray:
    """A worker's mean z (K,), moved so that he is ``pace`` times as fast as ``centre`` (K,) in median moving time.

    The rest of z follows log duration by its regression between workers (where they do not differ: within workers).
    """
    at = model.scale.block("duration").start
    between, within = (normal.covariance_with(at) for normal in (model.workforce.between, model.workforce.within))
    column = between if between[at] > 1e-12 else within
    usual = model.margin.inverse((model.scale.raw(centre[None], "duration"))[:, 0])
    wanted = model.duration_z(usual - np.log(pace))[0]
    return _moved(z, column, at, wanted)


def _moved(z: np.ndarray, column: np.ndarray, at: int, wanted: float) -> np.ndarray:
    """z (K,) with its coordinate ``at`` as wanted, the rest by its regression: covariances ``column`` (K,) with it."""
    slope = column / column[at] if column[at] > 1e-12 else np.zeros_like(column)
    slope[at] = 1.0
    return np.asarray(z + (wanted - z[at]) * slope)


def _scale(model: MotionEmulator, z: np.ndarray, height_m: float) -> float:
    """What makes the bones of z (K,) those of somebody ``height_m`` tall: the chain ankle to head plus 0.20 m."""
    length = dict(zip(model.skeleton.bone_names, model.bone_length_m(z[None])[0]))
    chain = ("left_ankle", "left_knee", "spine", "chest", "neck", "head")
    return (height_m - _CROWN_AND_SOLE_M) / float(sum(length.get(name, 0.0) for name in chain))
