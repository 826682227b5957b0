"""Designs: where to look in a room of factors. Plain functions on arrays, no scenario needed.

A design is (P, F): a row a point, a column a factor. Grids have numbers of levels, the others shares from 0 to 1 of
each factor's range.

Which factor matters, alone and together with others: Sobol indices and Morris' elementary effects, by SALib.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.streams import stream
from opsim.study.intervals import CONFIDENCE

MORRIS_LEVELS = 4
MORRIS_STEP = 2 / 3
"""Of a factor's range: by how much it moves at a time on four levels."""


class Missing(ValueError):
    """A package that this needs is not installed."""


def grid(levels: Sequence[int]) -> np.ndarray:
    """Every combination of so many levels of each factor (full factorial): (P, F) level numbers, the last one fastest.

    Source: Montgomery, Design and Analysis of Experiments, 8th ed., chapter 5.
    """
    columns = np.meshgrid(*(np.arange(n) for n in levels), indexing="ij")
    return np.stack([column.ravel() for column in columns], axis=1)


def one_at_a_time(levels: Sequence[int]) -> np.ndarray:
    """The base, then each level of each factor with the others at the base: (P, F) level numbers, -1 the base."""
    rows = [[-1] * len(levels)]
    for factor, n in enumerate(levels):
        rows += [[level if other == factor else -1 for other in range(len(levels))] for level in range(n)]
    return np.array(rows, dtype=int)


def latin_hypercube(n: int, factors: int, rng: np.random.Generator) -> np.ndarray:
    """``n`` points, (n, factors) shares: each of n equal parts of each factor's range holds one of them.

    Source: McKay, Beckman & Conover 1979, Technometrics 21:239-245; computed by scipy.stats.qmc.
    """
    from scipy.stats import qmc

    return np.asarray(qmc.LatinHypercube(factors, rng=rng).random(n))


def sobol(n: int, factors: int, rng: np.random.Generator) -> np.ndarray:
    """The first ``n`` points of a scrambled Sobol sequence, (n, factors) shares; evenest where n is a power of two.

    Source: Owen 1998, J. Complexity 14:466-489; computed by scipy.stats.qmc.
    """
    from scipy.stats import qmc

    with _no_word_of_powers():
        return np.asarray(qmc.Sobol(factors, scramble=True, rng=rng).random(n))


def saltelli(n: int, factors: int, rng: np.random.Generator) -> np.ndarray:
    """The points from which Sobol indices are computed, (n * (factors + 2), factors) shares.

    n : base points, best a power of two. Raises Missing where SALib is not installed.
    Source: Saltelli et al. 2010, Comput. Phys. Commun. 181:259-270; computed by SALib.
    """
    sample = _salib("SALib.sample.sobol")
    with _no_word_of_powers():
        found = sample.sample(_room(factors), n, calc_second_order=False, seed=rng)
    return np.asarray(found, dtype=float)


def morris(n: int, factors: int, rng: np.random.Generator) -> np.ndarray:
    """``n`` paths on which one factor moves at a time, (n * (factors + 1), factors) shares on four levels.

    Raises Missing where SALib is not installed.
    Source: Morris 1991, Technometrics 33:161-174; computed by SALib.
    """
    sample = _salib("SALib.sample.morris")
    return np.asarray(sample.sample(_room(factors), n, num_levels=MORRIS_LEVELS, seed=rng), dtype=float)


def power_of_two(n: int) -> int:
    """The least power of two that is not below n."""
    return 1 << max(0, n - 1).bit_length()


def _room(factors: int) -> dict[str, Any]:
    """A unit cube, as SALib calls it."""
    return {"num_vars": factors, "names": [f"x{i}" for i in range(factors)], "bounds": [[0.0, 1.0]] * factors}


def _salib(module: str) -> Any:
    from importlib import import_module

    try:
        return import_module(module)
    except ImportError:
        raise Missing(
            "the designs sobol_indices and morris are computed by SALib, which is not installed; "
            "install it with: pip install 'opsim[sensitivity]'"
        ) from None


class _no_word_of_powers(warnings.catch_warnings):
    """scipy warns of numbers that are no power of two; we say it in our words."""

    def __enter__(self) -> Any:
        caught = super().__enter__()
        warnings.simplefilter("ignore", UserWarning)
        return caught


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
