"""An emulator from predetermined times: reach for a thing, grasp it, move it, let go.

A few rows of the MTM-1 tables, in TMU (1 TMU = 0.036 s, at normal performance); between rows linear.
Source: Maynard, Stegemerten & Schwab (1948), Methods-Time Measurement, McGraw-Hill; values as on the MTM-1 data card
of the MTM Associations, inches. MTM-1 takes training to apply: these rows show how a plug-in is made, no more.
"""

from dataclasses import dataclass

import numpy as np

TMU_S = 0.036
M_PER_INCH = 0.0254
INCHES = (2.0, 6.0, 12.0, 18.0, 24.0, 30.0)
REACH_B = (4.0, 8.6, 12.9, 17.2, 21.5, 25.8)  # to a single object whose place varies slightly
MOVE_B = (4.6, 8.9, 13.4, 17.0, 20.6, 24.3)  # to an approximate place
GRASP = {"1A": 2.0, "1B": 3.5, "4B": 9.1}  # easily grasped; small, lying flat; jumbled, 1/4 to 1 inch
RELEASE_1 = 2.0  # opening the fingers


@dataclass(frozen=True)
class Times:
    """n performances: ``duration_s`` (n,), and in ``mark_s`` (n, 3) the ends of reach, grasp and move."""

    duration_s: np.ndarray
    mark_s: np.ndarray
    skeleton: None = None

    @property
    def scores(self) -> np.ndarray:
        return np.empty((len(self.duration_s), 0))


@dataclass(frozen=True)
class GetAndPlace:
    """Reach ``reach_m``, grasp, move ``move_m``, release. ``cv``: lognormal spread from one performance to the next."""

    reach_m: float
    move_m: float
    grasp: str = "1A"
    cv: float = 0.0

    def __post_init__(self) -> None:
        if self.grasp not in GRASP:
            raise ValueError(f"grasp must be one of {', '.join(GRASP)}, found {self.grasp!r}")
        for name, distance_m in (("reach", self.reach_m), ("move", self.move_m)):
            if not INCHES[0] <= distance_m / M_PER_INCH <= INCHES[-1]:
                least_m, most_m = INCHES[0] * M_PER_INCH, INCHES[-1] * M_PER_INCH
                raise ValueError(f"{name} must be {least_m:.2f} to {most_m:.2f} m, found {distance_m:g} m")
        if not 0 <= self.cv <= 1:
            raise ValueError(f"cv must be 0 to 1, found {self.cv:g}")

    def elements_s(self) -> np.ndarray:
        """(4,) seconds of reach, grasp, move and release."""
        reach = np.interp(self.reach_m / M_PER_INCH, INCHES, REACH_B)
        move = np.interp(self.move_m / M_PER_INCH, INCHES, MOVE_B)
        return TMU_S * np.array([reach, GRASP[self.grasp], move, RELEASE_1])

    def mean_duration_s(self, worker=None) -> float:
        return float(self.elements_s().sum())

    def draw_worker(self, rng, body=None) -> None:
        """People do not differ: MTM times are those of normal performance; a skill rating makes the difference."""
        return None

    def sample(self, n, rng, *, worker=None, condition=None) -> Times:
        log_variance = np.log1p(self.cv**2)
        pace = np.exp(np.sqrt(log_variance) * rng.standard_normal(n) - log_variance / 2)
        ends_s = pace[:, None] * self.elements_s().cumsum()
        return Times(ends_s[:, -1], ends_s[:, :-1])
