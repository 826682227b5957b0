"""Which layout to take, and whether one is clearly better or worse than the present one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from opsim.kpi.better import LESS, Asked
from opsim.study.compare import holm, paired
from opsim.study.interval import CONFIDENCE
from opsim.study.layout.judge import BEST, WALKED, Against


def gains(of: Mapping[str, Against], best: Asked) -> list[str]:
    """Which of WALKED and BEST are clearly better than now."""
    better = of[BEST].less if best.better == LESS else of[BEST].more
    return [measure for measure, one in ((WALKED, of[WALKED].less), (BEST, better)) if one]


def losses(of: Mapping[str, Against], best: Asked) -> list[str]:
    """Which of WALKED and BEST are clearly worse than now."""
    worse = of[BEST].more if best.better == LESS else of[BEST].less
    return [measure for measure, one in ((WALKED, of[WALKED].more), (BEST, worse)) if one]


def chosen(layouts: Mapping[str, Mapping[str, np.ndarray]], best: Asked, now: str) -> tuple[str, list[str]]:
    """(the layout to take, those that no test tells from the best one): of these, the one with the least walking.

    Those that are clearly worse than the present one are not among them, even where no test tells them from the best.
    layouts : with the present one, ``now``, among them; a figure that is missing everywhere is worse than any
    """
    sign = -1.0 if best.better == LESS else 1.0
    names = list(layouts)
    goodness = {name: known_mean(sign * layouts[name][BEST], -np.inf) for name in names}
    top = max(names, key=goodness.__getitem__)
    alike = [top, *_not_worse(layouts, names, top, sign)]
    if top != now:
        kept = [now, *_not_worse(layouts, names, now, sign)]
        alike = [name for name in alike if name == top or name in kept]
    if best.kpi == "walked_m":
        return top, alike
    return min(alike, key=lambda name: (known_mean(layouts[name][WALKED], np.inf), names.index(name))), alike


def _not_worse(
    layouts: Mapping[str, Mapping[str, np.ndarray]], names: Sequence[str], base: str, sign: float
) -> list[str]:
    """The others that have the figure and are not clearly worse than ``base`` by it; tests held together (Holm)."""
    others = [name for name in names if name != base and np.isfinite(layouts[name][BEST]).any()]
    found = [paired(layouts[name][BEST].tolist(), layouts[base][BEST].tolist())[:2] for name in others]
    p = holm([one for _, one in found])
    return [
        name
        for name, (difference, _), one in zip(others, found, p)
        if not (one <= 1 - CONFIDENCE and sign * difference.mean < 0)
    ]


def known_mean(values: np.ndarray, otherwise: float = np.nan) -> float:
    """The mean of what is known; ``otherwise`` where nothing is."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else otherwise
