"""Which way is forward, by feet, knees, elbows and the way walked, held against the line of the hips."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from emulator.recordings.take import Take

LEAST_BEND_RAD = np.radians(20.0)
"""Knees and elbows that are straighter do not show where they bend to."""
LEAST_WALK_M_PER_S, LEAST_WAY_M = 0.4, 2.0
"""Slower, and over a shorter way, people also go backwards: they sit down, or swing back for a throw."""


def witnesses_of(take: Take) -> dict[str, float]:
    """Forward by each witness against forward by the hips: from -1 to 1, those that have something to say."""
    names, places = take.names, take.positions_m
    hips = vector(take, "right_hip", "left_hip")
    forward = unit(np.stack([hips[:, 1], -hips[:, 0]], axis=-1))
    said = {
        "toes": _both(lambda side: _toes(take, side, forward)),
        "knees": _both(lambda side: _bend(take, [f"{side}_{j}" for j in ("hip", "knee", "ankle")], forward)),
        "walking": _walking(places[:, names.index("pelvis")], take.rate_hz, forward),
        "elbows": _elbows(take, forward),
    }
    return {name: float(value) for name, value in said.items() if np.isfinite(value)}


def _both(witness: Callable[[str], float]) -> float:
    values = [witness(side) for side in ("left", "right")]
    told = [value for value in values if np.isfinite(value)]
    return float(np.mean(told)) if told else np.nan


def _toes(take: Take, side: str, forward: np.ndarray) -> float:
    """Toes are in front of the ankle, or of the heel."""
    back = next((f"{side}_{j}" for j in ("heel", "ankle") if f"{side}_{j}" in take.names), None)
    if back is None or f"{side}_toe" not in take.names:
        return np.nan
    foot = vector(take, back, f"{side}_toe")
    level = np.linalg.norm(foot[:, :2], axis=-1) > 0.5 * np.linalg.norm(foot, axis=-1)
    return _agreement(unit(foot[level, :2]), forward[level])


def _bend(take: Take, chain: Sequence[str], forward: np.ndarray) -> float:
    """A knee lies in front of the line from hip to ankle."""
    if not set(chain) <= set(take.names):
        return np.nan
    upper, lower = vector(take, chain[0], chain[1]), vector(take, chain[1], chain[2])
    bent = np.arccos(np.clip(np.sum(unit(upper) * unit(lower), axis=-1), -1, 1)) > LEAST_BEND_RAD
    out = unit(upper) - unit(lower)
    level = np.linalg.norm(out[:, :2], axis=-1) > 0.5 * np.linalg.norm(out, axis=-1)
    use = bent & level
    return _agreement(unit(out[use, :2]), forward[use]) if use.sum() >= 3 else np.nan


def _elbows(take: Take, forward: np.ndarray) -> float:
    """A forearm points forward of the upper arm while that hangs."""
    return _both(lambda side: _elbow(take, side, forward))


def _elbow(take: Take, side: str, forward: np.ndarray) -> float:
    chain = [f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist")]
    if not set(chain) <= set(take.names):
        return np.nan
    upper, lower = unit(vector(take, chain[0], chain[1])), unit(vector(take, chain[1], chain[2]))
    bent = np.arccos(np.clip(np.sum(upper * lower, axis=-1), -1, 1)) > LEAST_BEND_RAD
    use = bent & (upper[:, 2] < -0.7)
    across = lower[use] - np.sum(lower[use] * upper[use], axis=-1, keepdims=True) * upper[use]
    return _agreement(unit(across[:, :2]), forward[use]) if use.sum() >= 3 else np.nan


def _walking(pelvis: np.ndarray, rate_hz: float, forward: np.ndarray) -> float:
    """People walk forward, where they walk at all."""
    lag = max(1, round(0.3 * rate_hz))
    if len(pelvis) <= lag:
        return np.nan
    step = (pelvis[lag:] - pelvis[:-lag])[:, :2] * rate_hz / lag
    walks = np.linalg.norm(step, axis=-1) > LEAST_WALK_M_PER_S
    far = np.sum(np.linalg.norm(step[walks], axis=-1)) / rate_hz > LEAST_WAY_M
    return _agreement(unit(step[walks]), forward[:-lag][walks]) if far else np.nan


def _agreement(one: np.ndarray, other: np.ndarray) -> float:
    cosine = np.sum(one * other, axis=-1)
    cosine = cosine[np.isfinite(cosine)]
    return float(np.median(cosine)) if len(cosine) else np.nan


def vector(take: Take, start: str, end: str) -> np.ndarray:
    return np.asarray(take.positions_m[:, take.names.index(end)] - take.positions_m[:, take.names.index(start)])


def unit(vectors: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
