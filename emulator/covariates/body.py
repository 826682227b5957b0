"""A person's body, as far as it is known: what new workers are asked for by.

Bone lengths from stature by a published table, where a body's height is all that is known of its bones.

Source: Drillis & Contini (1964), Body Segment Parameters, as in Winter, Biomechanics and Motor Control of Human
Movement, fig. 4.1: segment lengths as fractions of stature, an average of both sexes. Single people differ from it by
some per cent. The table gives eight of the canonical skeleton's twenty bones: thighs, shanks, upper arms and forearms.
It does not divide the trunk at our joints, gives breadths over shoulders and hips where bones run slantwise from chest
and pelvis, and measures hand and foot to their tips where our joints end before: all those bones keep the proportion to
stature that the reference skeleton (the recorded people) has.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from typing import Any

import numpy as np

from emulator.skeleton import Skeleton

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


HEIGHT_SHARES: Mapping[str, float] = {
    "ankle": 0.039, "knee": 0.285, "fingertip": 0.377, "wrist": 0.485, "hip": 0.530, "elbow": 0.630, "chest": 0.720,
    "shoulder": 0.818, "chin": 0.870, "eyes": 0.936, "crown": 1.0,
}  # fmt: skip
"""Heights above the floor of somebody who stands upright, over his stature."""
LENGTH_SHARES: Mapping[str, float] = {
    "thigh": 0.245, "shank": 0.246, "upper_arm": 0.186, "forearm": 0.146, "hand": 0.108, "foot": 0.152,
    "foot_breadth": 0.055, "shoulder_half_breadth": 0.129, "hip_breadth": 0.191, "chest_breadth": 0.174,
}  # fmt: skip
"""Lengths over stature."""
SEGMENT_OF_BONE: Mapping[str, str] = {
    f"{side}_{joint}": segment
    for side in ("left", "right")
    for joint, segment in (("knee", "thigh"), ("ankle", "shank"), ("elbow", "upper_arm"), ("wrist", "forearm"))
}
"""The bones of the table: a bone is named after the joint where it ends."""


def bone_lengths_m(
    skeleton: Skeleton, height_m: float, reference_m: np.ndarray, reference_height_m: float | None = None
) -> np.ndarray:
    """Bone lengths (B,) in metres of somebody ``height_m`` tall.

    reference_m        : (B,) lengths of somebody (the mean of the recorded people): the bones that the table does not
                         give are his, in proportion to stature
    reference_height_m : his stature; None: what the table makes of his limbs
    Raises BodyError for a height that nobody has, ValueError for a reference of another skeleton.
    """
    wrong = number_mistake("body: height_m", "height_m", height_m, known=False)
    if wrong is not None:
        raise BodyError([wrong])
    tall = stature_m(skeleton, reference_m) if reference_height_m is None else reference_height_m
    length_m = np.asarray(reference_m, float) * (height_m / tall)
    for bone, name in enumerate(skeleton.bone_names):
        if name in SEGMENT_OF_BONE:
            length_m[bone] = height_m * LENGTH_SHARES[SEGMENT_OF_BONE[name]]
    return length_m


def stature_m(skeleton: Skeleton, bone_length_m: np.ndarray) -> float:
    """The stature at which the table's limbs are nearest to these bones (B,), by least squares.

    Raises ValueError for lengths of another skeleton, or one without any limb of the table.
    """
    bone_length_m = np.asarray(bone_length_m, float)
    if bone_length_m.shape != (skeleton.n_bones,):
        raise ValueError(f"bones: found {bone_length_m.shape}, expected ({skeleton.n_bones},) lengths")
    limbs = [i for i, name in enumerate(skeleton.bone_names) if name in SEGMENT_OF_BONE]
    if not limbs:
        raise ValueError(f"bones: none of {', '.join(SEGMENT_OF_BONE)} in this skeleton")
    share = np.array([LENGTH_SHARES[SEGMENT_OF_BONE[skeleton.bone_names[i]]] for i in limbs])
    return float(share @ bone_length_m[limbs] / (share @ share))


def not_in_the_table(skeleton: Skeleton) -> tuple[str, ...]:
    """The bones that keep the reference's proportion."""
    return tuple(name for name in skeleton.bone_names if name not in SEGMENT_OF_BONE)
