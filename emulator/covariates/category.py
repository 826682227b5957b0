"""What a category (sex) adds to the numbers of a body: a linear model on what partial least squares leaves.

Source: Baydal-Bertomeu et al., eq. 5 and table 2: the effect of a score counts where its F test passes 95 %. Their
test has a degree of freedom for each recording; here each person is one, since six runs of one woman are one woman.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

FEWEST_PEOPLE = 2
"""A level of one person would be that person."""


def words_of_people(category: Sequence[str | None], groups: np.ndarray) -> list[str | None]:
    """The first known word of each of the G people whose rows (R,) ``groups`` numbers; None where none is known."""
    words: list[str | None] = [None] * (int(groups.max()) + 1 if len(groups) else 0)
    for word, g in zip(category, groups):
        words[g] = word if words[g] is None else words[g]
    return words


def levels_of(category: Sequence[str | None] | None) -> tuple[str, ...]:
    """The levels that ``FEWEST_PEOPLE`` have, in order of the alphabet; none if fewer than two levels do."""
    said = [one for one in category or () if one is not None]
    found = tuple(sorted(level for level in set(said) if said.count(level) >= FEWEST_PEOPLE))
    return found if len(found) > 1 else ()


def members(category: Sequence[str | None] | None, levels: tuple[str, ...]) -> np.ndarray:
    """(G, C) 1 where a person is of a level; a row of zeros for another level or none."""
    return np.array([[float(one == level) for level in levels] for one in category or ()]).reshape(-1, len(levels))


def level_effects(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(C, K) mean residual (G, K) of each level, the mean over the people of all levels taken off."""
    counts = member.sum(axis=0)
    mean = (member.T @ residual) / counts[:, None]
    return np.asarray(mean - counts @ mean / counts.sum())


def f_test(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(K,) p values of the one-way F test that all levels have one mean residual (G, K); NaN if it cannot be made."""
    from scipy.special import fdtrc

    n, n_levels = int(member.sum()), member.shape[1]
    if n_levels < 2 or n <= n_levels:
        return np.full(residual.shape[1], np.nan)
    inside = residual[member.any(axis=1)]
    own = member[member.any(axis=1)]
    means = (own.T @ inside) / own.sum(axis=0)[:, None]
    between = np.sum(own.sum(axis=0)[:, None] * (means - inside.mean(axis=0)) ** 2, axis=0) / (n_levels - 1)
    within = np.sum((inside - own @ means) ** 2, axis=0) / (n - n_levels)
    ratio = between / np.where(within > 0, within, 1.0)
    return np.where(within > 0, fdtrc(n_levels - 1, n - n_levels, ratio), np.nan)


def left_out_effects(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(G, K) the effect of each person's level by the others: residual (G, G, K) of person h under the fit without g.

    0 for a person of no level, or whose level nobody else is of.
    """
    others = member[None] * (1.0 - np.eye(len(member)))[:, :, None]
    counts = others.sum(axis=1)
    mean = np.einsum("ghc,ghk->gck", others, residual) / np.maximum(counts, 1.0)[:, :, None]
    grand = np.einsum("gc,gck->gk", counts, mean) / np.maximum(counts.sum(axis=1), 1.0)[:, None]
    alone = (counts == 0)[:, :, None]
    effect = np.where(alone, 0.0, mean - grand[:, None])
    return np.asarray(np.einsum("gc,gck->gk", member, effect))
