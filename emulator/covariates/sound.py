"""What keeps rows from being explained: every mistake with what was found and expected."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

import numpy as np

KEEPS = ("fdr", "each")


def mistakes_of(
    means: np.ndarray,
    numeric: np.ndarray,
    names: Sequence[str],
    category: Sequence[str | None] | None,
    groups: np.ndarray | None,
    families: np.ndarray | None,
    level: float,
    keep: str,
) -> list[str]:
    """Lines, empty if all is well."""
    if means.ndim != 2 or numeric.ndim != 2 or len(means) == 0:
        return [
            f"covariates: found means {means.shape} and numeric {numeric.shape}, expected (rows, scores), (rows, P)"
        ]
    wrong = []
    if len(numeric) != len(means) or numeric.shape[1] != len(names):
        wrong.append(f"covariates: numeric: found {numeric.shape}, expected ({len(means)}, {len(names)})")
    if not np.all(np.isfinite(means)):
        wrong.append(f"covariates: means: found {int(np.sum(~np.isfinite(means)))} numbers that are not finite")
    if np.any(np.isinf(numeric)):
        wrong.append(f"covariates: numeric: found {int(np.sum(np.isinf(numeric)))} infinite numbers")
    wrong += [f"covariates: {name!r} is named twice" for name in dict.fromkeys(names) if list(names).count(name) > 1]
    if "pace" in names and numeric.shape[1] == len(names) and np.any(numeric[:, list(names).index("pace")] <= 0):
        wrong.append("covariates: pace: found 0 or less, expected ratios above 0")
    wrong += _of_settings(means.shape[1], families, level, keep)
    return wrong + _of_people(len(means), category, groups)


def _of_settings(n_scores: int, families: np.ndarray | None, level: float, keep: str) -> list[str]:
    wrong = []
    if not 0.5 <= level < 1:
        wrong.append(f"covariates: level: found {level}, expected a share from 0.5 to below 1")
    if keep not in KEEPS:
        near = get_close_matches(str(keep), KEEPS, n=1)
        wrong.append(
            f"covariates: keep: no {keep!r}; " + (f"did you mean {near[0]!r}?" if near else "known: fdr, each")
        )
    if families is not None and np.shape(families) != (n_scores,):
        wrong.append(f"covariates: families: found {np.shape(families)}, expected ({n_scores},)")
    return wrong


def _of_people(n_rows: int, category: Sequence[str | None] | None, groups: np.ndarray | None) -> list[str]:
    wrong = []
    if category is not None and len(category) != n_rows:
        wrong.append(f"covariates: category: found {len(category)}, expected {n_rows}")
    if groups is None:
        return wrong
    groups = np.asarray(groups)
    if groups.shape != (n_rows,) or groups.dtype.kind not in "iu":
        return [*wrong, f"covariates: groups: found {groups.shape} {groups.dtype}, expected ({n_rows},) whole numbers"]
    if groups.min() < 0 or len(np.unique(groups)) != groups.max() + 1:
        return [*wrong, "covariates: groups: expected each number from 0 to the largest"]
    if category is not None and len(category) == n_rows:
        for g in range(int(groups.max()) + 1):
            own = sorted({str(word) for word, of in zip(category, groups) if of == g and word is not None})
            if len(own) > 1:
                wrong.append(f"covariates: person {g} is of {len(own)} categories: {', '.join(own)}")
    return wrong
