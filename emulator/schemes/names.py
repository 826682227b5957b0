"""Names of schemes: Representation/DimensionReduction/StatisticalModel, as in the paper."""

from __future__ import annotations

from difflib import get_close_matches
from typing import NamedTuple

REPRESENTATIONS = ("SIEM", "SIEM-first", "SIEM-moving", "IS-TVF", "S-TVF", "M-TVF")
VECTOR_REDUCTIONS, VECTOR_MODELS = ("SequentialPCA", "MPCA", "JointPCA"), ("MVG", "IG", "Kernel")
SERIES_REDUCTION, SERIES_MODELS = "SpatialPCA", ("VAR", "VAR-pooled")
POINTWISE = ("PWI", "PWI/shared")

SCHEMES: tuple[str, ...] = (
    *(f"{r}/{d}/{m}" for r in REPRESENTATIONS for d in VECTOR_REDUCTIONS for m in VECTOR_MODELS),
    *(f"{r}/{SERIES_REDUCTION}/{m}" for r in REPRESENTATIONS for m in SERIES_MODELS),
    *POINTWISE,
)
"""All schemes there are."""


class SchemeName(NamedTuple):
    representation: str
    reduction: str
    model: str


def parsed(name: str) -> SchemeName:
    """The parts of a scheme's name; PWI is the moving mean without reduction.

    Raises ValueError that names every part that is not known, with the nearest word, or parts that do not go together.
    """
    if name in POINTWISE:
        return SchemeName("SIEM-moving", "", name)
    parts = name.split("/")
    if len(parts) != 3:
        raise ValueError(f"scheme: {_unknown(name, SCHEMES)}; expected Representation/DimensionReduction/Model")
    known = (REPRESENTATIONS, (*VECTOR_REDUCTIONS, SERIES_REDUCTION), (*VECTOR_MODELS, *SERIES_MODELS))
    wrong = [_unknown(part, words) for part, words in zip(parts, known) if part not in words]
    if wrong:
        raise ValueError(f"scheme {name!r}: " + "; ".join(wrong))
    if name not in SCHEMES:
        goes = VECTOR_MODELS if parts[1] in VECTOR_REDUCTIONS else SERIES_MODELS
        raise ValueError(f"scheme {name!r}: {parts[2]} does not go with {parts[1]}, which goes with {', '.join(goes)}")
    return SchemeName(*parts)


def _unknown(word: str, known: tuple[str, ...]) -> str:
    folded = {k.lower(): k for k in known}
    near = get_close_matches(word.lower(), folded, n=1)
    return f"no {word!r}" + (f", did you mean {folded[near[0]]!r}?" if near else f", known: {', '.join(known)}")
