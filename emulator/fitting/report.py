"""What a fit found, in numbers that a user reads before he trusts it."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class TimeFit:
    """A time of many draws of the same people beside that of the recordings (not held out).

    distance : of Kolmogorov and Smirnov, 0 to 1; median_error, p90_error : emulated over recorded, less 1
    """

    name: str
    distance: float
    median_error: float
    p90_error: float

    @classmethod
    def of(cls, name: str, emulated: np.ndarray, recorded: np.ndarray) -> TimeFit:
        """From emulated (n,) and recorded (N,) times in seconds."""
        both = np.sort(np.concatenate([emulated, recorded]))
        below = [np.searchsorted(np.sort(times), both, side="right") / len(times) for times in (emulated, recorded)]
        errors = (np.quantile(emulated, q) / max(np.quantile(recorded, q), 1e-9) - 1 for q in (0.5, 0.9))
        return cls(name, float(np.abs(below[0] - below[1]).max()), *(float(e) for e in errors))


@dataclass(frozen=True)
class FitReport:
    """Figures of one fitted task; durations of the recordings, ICC of log duration with its 95 % interval.

    explained_variance : share of the posture variance that the posture components carry
    reconstruction_deg : mean angle of a bone when repetitions not used for the components are projected on them
                         (five folds; registration and reference are those of all)
    roughness_ratio    : mean second difference of posture in own time, emulated (the same people) over recorded;
                         roughness_new_ratio the same for new people
    novelty_ratio      : median distance of an emulated performance to the nearest recorded one, over that of a
                         recording left out; near 0 is a copy
    disco_p            : permutation test of emulated against recorded postures; small says that they differ
    times              : duration and marks, emulated beside recorded
    fastest_m_per_s    : greatest speed of any joint in a recorded performance
    too_fast, too_fast_new : share of draws of the same and of new people in which a joint is faster than 1.1 x the
                         fastest recorded, in real time at 30 frames a second
    jerk_ratio, jerk_new_ratio : peak jerk of a joint over that recorded, medians over draws and joints
    wander_cm, wander_recorded_cm : how far a planted foot strays from its place, drawn (same people) and recorded
    """

    task: str
    scheme: str
    n_sequences: int
    n_workers: int
    n_components: int
    n_coordinates: int
    explained_variance: float
    duration_mean_s: float
    duration_cv: float
    duration_margin: str
    icc: float
    icc_low: float
    icc_high: float
    reconstruction_deg: float
    roughness_ratio: float
    novelty_ratio: float
    mark_names: tuple[str, ...]
    source: str
    licence: str
    where: str
    command: str
    methods: dict[str, str]
    notes: tuple[str, ...] = ()
    roughness_new_ratio: float = math.nan
    disco_p: float = math.nan
    times: tuple[TimeFit, ...] = ()
    fastest_m_per_s: float = math.nan
    too_fast: float = math.nan
    too_fast_new: float = math.nan
    jerk_ratio: float = math.nan
    jerk_new_ratio: float = math.nan
    wander_cm: float = math.nan
    wander_recorded_cm: float = math.nan

    def rows(self) -> list[tuple[str, str]]:
        """Label and text of each figure, in the order to print them."""
        icc = "not estimable" if math.isnan(self.icc) else f"{self.icc:.2f} ({self.icc_low:.2f} to {self.icc_high:.2f})"
        chosen = [("scheme, chosen", self.methods["scheme"])] if "scheme" in self.methods else []
        return [
            *chosen,
            ("sequences", f"{self.n_sequences} of {self.n_workers} workers, {self.where}"),
            ("components", f"{self.n_components} of posture, {self.n_coordinates} jointly"),
            ("explained variance", f"{100 * self.explained_variance:.1f} %"),
            ("reconstruction, held out", _figure(self.reconstruction_deg, " deg a bone")),
            ("duration", f"{self.duration_mean_s:.3f} s, CV {self.duration_cv:.3f}, {self.duration_margin}"),
            ("ICC of log duration", icc),
            *([("covariates", self.methods["covariates"])] if "covariates" in self.methods else []),
            ("roughness, emulated / recorded", f"{_figure(self.roughness_ratio)} {_new(self.roughness_new_ratio)}"),
            ("fastest joint, recorded", _figure(self.fastest_m_per_s, " m/s")),
            *self._in_real_time(),
            ("novelty, emulated / recorded", _figure(self.novelty_ratio)),
            ("DISCO, emulated against recorded", f"p = {_figure(self.disco_p)}"),
            *((f"{fit.name}, emulated / recorded", _time(fit)) for fit in self.times),
        ]

    def _in_real_time(self) -> list[tuple[str, str]]:
        """Nothing of a library from before these were measured."""
        if math.isnan(self.too_fast):
            return []
        new = "" if math.isnan(self.too_fast_new) else f" (new people {100 * self.too_fast_new:.0f} %)"
        wander = f"{_figure(self.wander_cm)} / {_figure(self.wander_recorded_cm)} cm"
        feet = [] if math.isnan(self.wander_recorded_cm) else [("foot wander, emulated / recorded", wander)]
        return [
            ("draws over 1.1 x the fastest", f"{100 * self.too_fast:.0f} %{new}"),
            ("peak jerk, emulated / recorded", f"{_figure(self.jerk_ratio)} {_new(self.jerk_new_ratio)}".rstrip()),
            *feet,
        ]

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values; a number that could not be estimated is None."""
        plain = asdict(self)
        return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in plain.items()}

    @classmethod
    def of_dict(cls, plain: dict[str, Any]) -> FitReport:
        """The way back from ``as_dict``. Raises KeyError, TypeError or ValueError for what is no report."""
        values: dict[str, Any] = dict(plain)
        values["times"] = tuple(TimeFit(**time) for time in plain.get("times", ()))
        for name, kind in cls.__annotations__.items():
            if kind == "float" and name in values:
                values[name] = math.nan if values[name] is None else float(values[name])
            elif kind == "tuple[str, ...]":
                values[name] = tuple(str(item) for item in values[name])
        return cls(**values)


def _new(ratio: float) -> str:
    return "" if math.isnan(ratio) else f"(new people {ratio:.2f})"


def _time(fit: TimeFit) -> str:
    return f"median {100 * fit.median_error:+.1f} %, P90 {100 * fit.p90_error:+.1f} %, KS distance {fit.distance:.2f}"


def _figure(value: float, unit: str = "") -> str:
    return "not estimable" if math.isnan(value) else f"{value:.2f}{unit}"
