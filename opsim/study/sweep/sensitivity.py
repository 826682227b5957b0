"""Which factor matters, alone and together with others: Sobol indices and Morris' elementary effects, by SALib."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.streams import stream
from opsim.study.interval import CONFIDENCE
from opsim.study.sweep.designs import MORRIS_LEVELS, MORRIS_STEP, _room, _salib

RESAMPLES = 500
"""Of the bootstrap behind the intervals."""


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """One factor. Of Sobol indices ``alone`` and ``total`` are shares of the variance of the figure: what the factor
    makes alone, and with all that it does together with others. Of Morris' effects ``total`` is the mean size of a
    step's effect (mu*), ``alone`` the mean effect with its sign (mu), and ``spread`` their standard deviation: large
    where the effect is bent or depends on other factors. The halves are those of 95 % bootstrap intervals.
    """

    alone: float
    alone_half: float
    total: float
    total_half: float
    spread: float = float("nan")


def sobol_indices(values: Sequence[float] | np.ndarray, factors: int, seed: int = 0) -> list[Sensitivity]:
    """Sobol indices from the values at the points of ``saltelli``, in their order; zeros where nothing varies.

    Source: Saltelli et al. 2010 (first order), Jansen 1999 (total), both in Comput. Phys. Commun.; computed by SALib.
    """
    y = np.asarray(values, dtype=float)
    if np.ptp(y) == 0:
        return [Sensitivity(0.0, 0.0, 0.0, 0.0)] * factors
    analyze = _salib("SALib.analyze.sobol")
    found = analyze.analyze(
        _room(factors),
        y,
        calc_second_order=False,
        num_resamples=RESAMPLES,
        conf_level=CONFIDENCE,
        seed=_seed(seed),
    )
    columns = (found[key] for key in ("S1", "S1_conf", "ST", "ST_conf"))
    return [Sensitivity(*map(float, row)) for row in zip(*columns)]


def morris_effects(
    design: np.ndarray,
    values: Sequence[float] | np.ndarray,
    factors: int,
    seed: int = 0,
    moved: Sequence[float] | None = None,
) -> list[Sensitivity]:
    """Elementary effects from the values at the points of ``morris``, in their order: per whole range of a factor.

    moved : (F,) by which share of its range a factor really moves at a step; by default by that of the design

    Source: Morris 1991; Campolongo, Cariboni & Saltelli 2007 (mu*); computed by SALib.
    """
    analyze = _salib("SALib.analyze.morris")
    y = np.asarray(values, dtype=float)
    found = analyze.analyze(
        _room(factors),
        np.asarray(design, dtype=float),
        y,
        num_resamples=RESAMPLES,
        conf_level=CONFIDENCE,
        num_levels=MORRIS_LEVELS,
        seed=_seed(seed),
    )
    n = y.size // (factors + 1)
    whole = np.ones(factors) if moved is None else MORRIS_STEP / np.asarray(moved, dtype=float)
    columns = (np.asarray(found[key], dtype=float) * whole for key in ("mu", "mu_star", "mu_star_conf", "sigma"))
    return [
        Sensitivity(
            float(mu), float("nan") if n < 2 else float(1.96 * sd / np.sqrt(n)), float(star), float(half), float(sd)
        )
        for mu, star, half, sd in zip(*columns)
    ]


def _seed(seed: int) -> int:
    """SALib takes 0 for no seed, and then asks numpy's global generator."""
    return int(stream(seed, 0, "sweep", "bootstrap").integers(1, 2**31))
