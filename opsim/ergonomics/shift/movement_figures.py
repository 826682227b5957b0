"""What is told of scored movements: shares of the time at high scores and angles, means and extremes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.shift.movement import ScoredMovement

SHARES = (("rula", 5), ("rula", 7), ("reba", 8), ("owas", 3))
BEYOND_DEG = (("trunk", 20), ("trunk", 60), ("arm", 60), ("arm", 90))
WORDS = {"rula": "RULA", "reba": "REBA", "owas": "OWAS", "trunk": "trunk flexed", "arm": "an upper arm raised"}
QUANTILE = 0.9


class Told(NamedTuple):
    """A figure, at least and at most; of a share, of the time for which it is known. nan where nothing is known."""

    name: str
    said: str
    unit: str
    low: float
    high: float

    @property
    def row(self) -> tuple[str, str, str]:
        """What it is, at least, at most as people read them; the last is empty where both are one."""
        low, high = in_words(self.low, self.unit), in_words(self.high, self.unit)
        return self.said, low, "" if low == high else high


def in_words(value: float, unit: str) -> str:
    """A share in per cent, a score to two decimals."""
    if np.isnan(value):
        return "not known"
    return f"{100 * value:.1f} %" if unit == "share" else f"{value:.2f}".rstrip("0").rstrip(".")


def movement_figures(scored: Sequence[ScoredMovement]) -> Iterator[Told]:
    """Figures over all movements together, each posture by its seconds.

    Shares of the time at RULA 5 and 7, REBA 8, OWAS 3 or more; with the trunk flexed and with the higher upper arm
    raised against gravity by so many degrees or more; mean, 90 % quantile and most of RULA and REBA.
    """
    seconds = np.concatenate([one.movement.seconds for one in scored])
    known = np.concatenate([one.movement.known for one in scored])
    both = {name: np.concatenate([getattr(one.scores, name) for one in scored]) for name in ("rula", "reba", "owas")}
    for name, least in SHARES:
        low, high = (_share(both[name][:, end] >= least, known, seconds) for end in range(2))
        yield Told(f"{name}_from_{least}_share", f"{WORDS[name]} {least} or more", "share", low, high)
    measures = np.concatenate([one.movement.measures for one in scored])
    for name, degrees in BEYOND_DEG:
        angle = measures[:, AT["trunk_flexion"]] if name == "trunk" else higher_arm_deg(measures)
        share = _share(angle >= degrees, ~np.isnan(angle), seconds)
        yield Told(f"{name}_beyond_{degrees}_share", f"{WORDS[name]} {degrees}° or more", "share", share, share)
    for name in ("rula", "reba"):
        for end_of, words in ((_mean, "mean"), (_quantile, "p90"), (_most, "most")):
            low, high = (end_of(both[name][:, end], known, seconds) for end in range(2))
            yield Told(f"{name}_{words}", f"{WORDS[name]}, {words}", "1", low, high)


def higher_arm_deg(measures: np.ndarray) -> np.ndarray:
    """(N,) elevation of the higher upper arm against gravity; of the one that is known, where one is."""
    return np.asarray(np.fmax(measures[:, AT["left_arm_elevation"]], measures[:, AT["right_arm_elevation"]]))


def unknown_share(scored: Sequence[ScoredMovement]) -> float:
    """Of the time, how much has no known posture."""
    total_s = sum(one.movement.duration_s for one in scored)
    unknown_s = sum(float(one.movement.seconds[~one.movement.known].sum()) for one in scored)
    return unknown_s / total_s if total_s > 0 else 0.0


def loaded_share(scored: Sequence[ScoredMovement]) -> float:
    """Of the time, in how much the hands may hold something."""
    total_s = sum(one.movement.duration_s for one in scored)
    loaded_s = sum(one.movement.loaded_s for one in scored)
    return loaded_s / total_s if total_s > 0 else 0.0


def _share(there: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    all_s = float(seconds[known].sum())
    return float(seconds[known & there].sum()) / all_s if all_s > 0 else float("nan")


def _mean(values: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    all_s = float(seconds[known].sum())
    return float(values[known] @ seconds[known]) / all_s if all_s > 0 else float("nan")


def _quantile(values: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    """The score at or below which nine tenths of the time are."""
    if not known.any():
        return float("nan")
    order = np.argsort(values[known], kind="stable")
    passed_s = np.cumsum(seconds[known][order])
    place = int(np.searchsorted(passed_s, QUANTILE * passed_s[-1] * (1 - 1e-12)))
    return float(values[known][order][min(place, order.size - 1)])


def _most(values: np.ndarray, known: np.ndarray, _seconds: np.ndarray) -> float:
    return float(values[known].max()) if known.any() else float("nan")
