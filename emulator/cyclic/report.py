"""What the fit of a cyclic emulator says of itself: how much was learned, and how draws compare with the recordings."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True)
class CyclicReport:
    """skate_recorded_cm, skate_drawn_cm : mean slide of a bearing foot in one stance

    beat_s, step_m : mean time and length of a beat, recorded and drawn, with their coefficients of variation
    hyper : a line for each state of the dynamics; jump_ratio : roughness drawn over recorded, which is
    the root mean square of the joints' change of velocity from frame to frame
    """

    task: str
    n_sequences: int
    n_workers: int
    n_components: int
    energy: float
    states: tuple[str, ...]
    hyper: tuple[str, ...]
    n_points: int
    source: str
    licence: str
    where: str
    command: str
    methods: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    beat_s: tuple[float, ...] = (math.nan,) * 4
    """mean and CV recorded, mean and CV drawn."""
    step_m: tuple[float, ...] = (math.nan,) * 4
    speed_m_per_s: tuple[float, float] = (math.nan, math.nan)
    """slowest and fastest recorded."""
    skate_recorded_cm: float = math.nan
    skate_drawn_cm: float = math.nan
    jump_ratio: float = math.nan
    given_up: float = math.nan
    """Share of drawn beats at which the dynamics came to none, so that a recorded one was taken."""

    def rows(self) -> list[tuple[str, str]]:
        """Label and text of each figure, in the order to print them."""
        walked = math.isfinite(self.step_m[0])
        beat, both = ("step", "stride") if walked else ("cycle", "cycle")
        speeds = f", {self.speed_m_per_s[0]:.2f} to {self.speed_m_per_s[1]:.2f} m/s" if walked else ""
        rows = [
            ("sequences", f"{self.n_sequences} of {self.n_workers} workers, {self.where}{speeds}"),
            ("components", f"{self.n_components}, {100 * self.energy:.1f} % of the variation of poses"),
            ("contact states", ", ".join(self.states)),
            *((f"dynamics, {state}", said) for state, said in zip(self.states, self.hyper)),
            (f"{both} time, recorded / drawn", _pair(self.beat_s, "s", 2 if walked else 1)),
        ]
        if walked:
            rows.append((f"{beat} length, recorded / drawn", _pair(self.step_m, "m", 1)))
        if math.isfinite(self.skate_drawn_cm):
            said = f"{self.skate_recorded_cm:.3f} cm / {self.skate_drawn_cm:.3f} cm a stance"
            rows.append(("foot skate, recorded / drawn", said))
        if math.isfinite(self.jump_ratio):
            rows.append(("roughness, drawn / recorded", f"{self.jump_ratio:.2f}"))
        if math.isfinite(self.given_up):
            rows.append(("beats taken from the recordings", f"{100 * self.given_up:.1f} %"))
        return rows

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values; a number that could not be estimated is None."""
        return {key: _plain(value) for key, value in asdict(self).items()}

    @classmethod
    def of_dict(cls, plain: dict[str, Any]) -> CyclicReport:
        """The way back. Raises KeyError, TypeError or ValueError for what is no report."""
        values = dict(plain)
        for name in ("states", "hyper", "notes"):
            values[name] = tuple(str(item) for item in values[name])
        for name in ("beat_s", "step_m", "speed_m_per_s"):
            values[name] = tuple(_number(item) for item in values[name])
        for name in ("energy", "skate_recorded_cm", "skate_drawn_cm", "jump_ratio", "given_up"):
            values[name] = _number(values[name])
        values["methods"] = {str(key): str(value) for key, value in values["methods"].items()}
        return cls(**values)


def _pair(four: tuple[float, ...], unit: str, times: int) -> str:
    recorded, drawn = (f"{times * four[i]:.3f} {unit} (CV {100 * four[i + 1]:.1f} %)" for i in (0, 2))
    return f"{recorded} / {drawn}"


def _plain(value: Any) -> Any:
    if isinstance(value, float) and math.isnan(value):
        return None
    return [_plain(item) for item in value] if isinstance(value, (tuple, list)) else value


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)
