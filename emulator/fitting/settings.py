"""What a user may ask of a fit, in one frozen bundle that is checked once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches

from emulator.model.emulator import SCHEMES

AUTO = "auto"
"""Choose the scheme by cross-validation: see ``scheme_choice``."""

CLOCK = (101, 301)
"""Fewest and most points of a common clock whose number is not asked for."""

Progress = Callable[[int, int, str], None] | None


@dataclass(frozen=True)
class FitSettings:
    """See ``MotionEmulator.fit``. Raises ValueError for an unknown scheme or numbers out of range."""

    scheme: str
    n_components: int | float | None
    n_times: int | None
    n_knots: int
    landmarks: float
    seed: int
    command: str
    penalty: float | None = None
    covariates: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for wrong in unknown_scheme(self.scheme):
            raise ValueError(wrong)
        if self.penalty is not None and not 0 <= self.penalty < float("inf"):
            raise ValueError(f"penalty: found {self.penalty}, expected a weight from 0")
        if not 0 <= self.landmarks < float("inf"):
            raise ValueError(f"landmarks: found {self.landmarks}, expected a strength from 0")
        if self.n_components is not None and not self.n_components > 0:
            raise ValueError(
                f"n_components: found {self.n_components}, expected a number from 1 or a share of variance"
            )
        n_times = self.n_times or CLOCK[0]
        if n_times < 10 or not 2 <= self.n_knots < n_times:
            raise ValueError(f"n_times {n_times} must be 10 or more and n_knots {self.n_knots} from 2 to below it")


def unknown_scheme(scheme: str) -> list[str]:
    """What is wrong with the name of a scheme, with the nearest known one; empty for a known one."""
    known = (AUTO, *SCHEMES)
    if not isinstance(scheme, str):
        return [f"scheme: found {scheme!r}, expected one of {', '.join(known)}"]
    if scheme in known:
        return []
    near = get_close_matches(scheme, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
    return [f"scheme: no {scheme!r}; {hint}"]
