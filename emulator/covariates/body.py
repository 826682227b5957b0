"""A person's body, as far as it is known: what new workers are asked for by."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from typing import Any

RANGES: dict[str, tuple[float, float, str]] = {
    "height_m": (0.9, 2.4, "metres"),
    "mass_kg": (25.0, 300.0, "kilograms"),
    "age_years": (5.0, 110.0, "years"),
    "pace": (0.3, 3.0, "a ratio: 1.1 is a tenth faster than usual"),
}
"""What people can be; a number outside is a slip of the pen or of the unit."""
ALIASES = {
    "height": "height_m", "stature": "height_m", "stature_m": "height_m", "mass": "mass_kg", "weight": "mass_kg",
    "weight_kg": "mass_kg", "age": "age_years", "gender": "sex",
}  # fmt: skip
_SEXES = {"female": "f", "woman": "f", "w": "f", "male": "m", "man": "m"}


class BodyError(ValueError):
    """A body that cannot be: ``mistakes`` has a line for each."""

    def __init__(self, mistakes: Iterable[str]):
        self.mistakes = tuple(mistakes)
        super().__init__("\n".join(self.mistakes))


@dataclass(frozen=True)
class Body:
    """height_m, mass_kg, age_years; sex "f", "m" or another word; pace a ratio, 1.1 a tenth faster than usual.

    Every part is optional; None is unknown. other : further numeric covariates by name.
    Raises BodyError for numbers out of range or of the wrong kind, all mistakes at once.
    """

    height_m: float | None = None
    mass_kg: float | None = None
    age_years: float | None = None
    sex: str | None = None
    pace: float | None = None
    other: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        mistakes = [
            wrong
            for name in RANGES
            if (wrong := number_mistake(f"body: {name}", name, getattr(self, name))) is not None
        ]
        if self.sex is not None:
            if isinstance(self.sex, str) and self.sex.strip():
                object.__setattr__(self, "sex", sex_word(self.sex))
            else:
                mistakes.append(f"body: sex: found {self.sex!r}, expected a word: 'f', 'm' or another")
        others = {ALIASES.get(name, name): value for name, value in self.other.items()}
        mistakes += [
            f"body: other: {name} has a place of its own" for name in others if name in RANGES or name == "sex"
        ]
        mistakes += [w for n, v in others.items() if (w := number_mistake(f"body: {n}", n, v, known=False)) is not None]
        if mistakes:
            raise BodyError(dict.fromkeys(mistakes))
        object.__setattr__(self, "other", others)

    @classmethod
    def of(cls, body: Any, covariates: Iterable[str] = ()) -> Body:
        """A Body from a Body, a mapping, anything with such attributes, or None.

        covariates : names beyond the usual ones that a mapping may have
        Raises BodyError for a word that is neither, with the nearest.
        """
        if body is None or isinstance(body, Body):
            return cls() if body is None else body
        if not isinstance(body, Mapping):
            parts = [part.name for part in fields(cls) if part.name != "other"]
            if not any(hasattr(body, name) for name in (*parts, "person")):
                raise BodyError(
                    [f"body: found {body!r}, expected a mapping or something with any of {', '.join(parts)}"]
                )
            return cls(**{name: getattr(body, name, None) for name in parts}, other=getattr(body, "other", None) or {})
        said = {ALIASES.get(str(name), str(name)): value for name, value in body.items()}
        own = {part.name for part in fields(cls)}
        allowed = own | set(covariates)
        unknown = [_unknown(name, allowed | set(ALIASES)) for name in said if name not in allowed]
        if unknown:
            raise BodyError(unknown)
        other = dict(said.get("other") or {}) | {name: said[name] for name in said if name not in own}
        known = {name: value for name, value in other.items() if value is not None}
        usual: dict[str, Any] = {name: said[name] for name in said if name in own and name != "other"}
        return cls(**usual, other=known)

    @property
    def known(self) -> dict[str, float]:
        """The numeric covariates that are known, by name."""
        usual = {name: float(getattr(self, name)) for name in RANGES if getattr(self, name) is not None}
        return usual | {name: float(value) for name, value in self.other.items()}

    @property
    def log_duration_shift(self) -> float:
        """What the pace means for log duration where the recordings know no pace: -log(pace), 0 if it is unknown."""
        return -math.log(self.pace) if self.pace is not None else 0.0


def number_mistake(place: str, name: str, value: Any, known: bool = True) -> str | None:
    """What is wrong with the number of a covariate, or None; with the number that was perhaps meant."""
    if value is None and known:
        return None
    if isinstance(value, bool) or not hasattr(value, "__float__") or not math.isfinite(float(value)):
        return f"{place}: found {value!r}, expected a number"
    if name not in RANGES:
        return None
    low, high, unit = RANGES[name]
    if low <= float(value) <= high:
        return None
    meant = [f"{float(value) * f:.4g}" for f in (0.01, 0.001, 100.0) if low <= float(value) * f <= high]
    hint = f"; did you mean {meant[0]}?" if meant and name != "age_years" else ""
    return f"{place}: found {float(value):.6g}, expected {low:g} to {high:g} ({unit}){hint}"


def sex_word(word: str) -> str:
    """ "f" and "m" for the words that mean them, else the word itself in small letters."""
    plain = word.strip().lower()
    return _SEXES.get(plain, plain)


def _unknown(name: str, allowed: set[str]) -> str:
    near = get_close_matches(name, sorted(allowed), n=1)
    hint = f"did you mean {ALIASES.get(near[0], near[0])!r}?" if near else f"known: {', '.join(sorted(allowed))}"
    return f"body: no {name!r}; {hint}"
