"""A worker in a task of several motions: his own effect in each of them, and how fast he walks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.composite_part import Part


@dataclass(frozen=True, eq=False)
class CompositeEffect:
    """A worker in a composite: his effect in each of its tasks, by key, and how fast he walks where it is known."""

    effects: Mapping[str, Any]
    walk_m_per_s: float | None = None
    said: tuple[str, ...] = ()


def drawn_worker(
    parts: Sequence[Part],
    rng: np.random.Generator,
    body: Any,
    people: Callable[[str], float] | None,
    slowness: float | None,
    own: Callable[[str, Any], Any] | None,
) -> CompositeEffect | None:
    """See ``CompositeEmulator.draw_worker``."""
    walk, body = _walk_of(body)
    effects = {}
    for key, model in {part.task: part.model for part in parts}.items():
        if own is not None:
            effects[key] = own(key, model)
            continue
        more: dict[str, Any] = {}
        if people is not None and getattr(model, "knows_people", False):
            more["people"] = people
        if slowness is not None and getattr(model, "knows_slowness", False):
            more["slowness"] = slowness
        effects[key] = model.draw_worker(rng, body, **more)
    walk = walk if any(part.condition for part in parts) else None
    if walk is None and all(effect is None for effect in effects.values()):
        return None
    said = [line for effect in effects.values() for line in getattr(effect, "said", ())]
    return CompositeEffect(effects, walk, tuple(dict.fromkeys(said)))


def _walk_of(body: Any) -> tuple[float | None, Any]:
    """How fast the worker walks, and his body without that, where it is a mapping."""
    if not isinstance(body, Mapping):
        return getattr(body, "walk_m_per_s", None), body
    return body.get("walk_m_per_s"), {key: value for key, value in body.items() if key != "walk_m_per_s"}
