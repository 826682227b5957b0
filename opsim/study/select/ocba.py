"""Optimal computing budget allocation: replications go where they tell most who is best.

It promises nothing beforehand; it says, from what was seen, how probable it is that the choice is right.
Source: Chen, Lin, Yucesan & Chick 2000, Discrete Event Dynamic Systems 10:251-270.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.study.select.selection import CHOSEN, SPENT, Asked, Observe, Selection, Stage, plain_means, sign_of

TINY = 1e-12
ASSUMES = (
    "means of replications are normally distributed (nearly so where many jobs pass)",
    "replications are independent, and so are variants: each has random numbers of its own",
    "nothing was known before of means and spreads (flat prior)",
)


def ocba_allocation(
    means: Sequence[float] | np.ndarray,
    sds: Sequence[float] | np.ndarray,
    budget: float,
    *,
    better: str = MORE,
    least_gap: float = 0.0,
) -> np.ndarray:
    """(k,) replications of each system, not rounded, whose sum is the budget.

    least_gap : a system nearer to the best than this counts as this far from it; so equals do not take everything
    Source: Chen et al. 2000, theorem 1: N_i / N_j = ((sd_i / gap_i) / (sd_j / gap_j))^2 for i, j not the best b;
    N_b = sd_b sqrt(sum of N_i^2 / sd_i^2).
    """
    seen, spread = sign_of(better) * np.asarray(means, dtype=float), np.asarray(sds, dtype=float)
    best = int(np.argmax(seen))
    size = max(float(np.abs(seen).max()), 1.0)
    spread = np.maximum(spread, TINY * size)
    gap = np.maximum(seen[best] - seen, max(least_gap, TINY * size))
    ratio = np.square(spread / gap)
    ratio[best] = 0.0
    ratio[best] = spread[best] * np.sqrt(np.sum(np.square(ratio / spread)))
    return np.asarray(budget * ratio / ratio.sum())


def chance_of_best(means: np.ndarray, sds: np.ndarray, n: np.ndarray, *, better: str, within: float = 0.0) -> float:
    """At least this probable, given what was seen: the system with the best mean is best, or ``within`` of the best.

    A bound over all pairs: 1 - the sum of T(-gap_i / error_i), T of Student's t with Welch's degrees of freedom, as few
    replications know the spread badly; n : of each system, 2 or more
    Source: Branke, Chick & Schmidt 2007, Management Science 53:1916-1932 (Bonferroni's PCS and PGS, unknown variances);
    Chen et al. 2000, eq. 4, which it is of many replications.
    """
    from scipy.special import stdtr

    seen = sign_of(better) * np.asarray(means, dtype=float)
    best = int(np.argmax(seen))
    own = np.square(sds) / n
    squares = own + own[best]
    gap = seen[best] - seen + within
    others = np.arange(seen.size) != best
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = np.square(squares) / (np.square(own) / (n - 1) + np.square(own[best]) / (n[best] - 1))
        wrong = np.where(squares > 0, stdtr(freedom, -gap / np.sqrt(squares)), np.where(gap > 0, 0.0, 0.5))
    return float(max(0.0, 1.0 - wrong[others].sum()))


def ocba(
    observe: Observe,
    systems: Sequence[str],
    *,
    indifference: float,
    confidence: float = 0.95,
    better: str = MORE,
    first_stage: int = 10,
    batch: int = 20,
    budget: int = 1000,
) -> Selection:
    """The system with the best mean, once it is good with a probability of ``confidence`` or the budget is spent.

    good   : best, or within the indifference of the best (Bonferroni bound of the posterior)
    batch  : replications given out at a time, over all systems
    budget : replications over all systems
    """
    asked = Asked(tuple(systems), indifference, confidence, better, first_stage, max(budget, first_stage))
    if budget < asked.k * first_stage:
        least = f"{asked.k * first_stage} ({first_stage} of each of {asked.k})"
        raise ValueError(f"budget: the first stage alone needs {least} replications, found {budget}")
    answered = asked.answered(observe)
    answered.upto(dict.fromkeys(range(asked.k), first_stage))
    while True:
        means, limited = plain_means(answered, answered.n)
        sds, n = np.array([of[:, 0].std(ddof=1) for of in answered.values]), np.array(answered.n)
        good = chance_of_best(np.array(means), sds, n, better=better, within=indifference)
        spent = int(n.sum())
        if good >= confidence or spent >= budget:
            break
        upto = min(budget, spent + max(1, batch))
        wanted = ocba_allocation(means, sds, upto, better=better, least_gap=indifference)
        answered.upto({i: int(n[i] + more) for i, more in enumerate(shared(wanted - n, upto - spent)) if more})
    best = chance_of_best(np.array(means), sds, n, better=better)
    winner = asked.systems[int(np.argmax(sign_of(better) * np.array(means)))]
    return Selection(
        procedure="ocba",
        systems=asked.systems,
        winner=winner,
        ended=CHOSEN if good >= confidence else SPENT,
        stages=(Stage(0, asked.systems), Stage(max(answered.n), (winner,))),
        out=(),
        means=means,
        limited=limited,
        n=answered.n,
        asked=answered.n,
        confidence=confidence,
        indifference=indifference,
        promise="nothing is promised beforehand: the probability is that of what was seen",
        assumes=ASSUMES,
        posterior=(best, good),
        values=tuple(answered.values),
    )


def shared(wanted: np.ndarray, amount: int) -> list[int]:
    """``amount`` in whole numbers over systems as they lack it; who lacks nothing gets nothing.

    Largest remainders; of equals the first.
    """
    lacking = np.maximum(wanted, 0.0)
    lacking = lacking / lacking.max() if lacking.any() else np.ones(lacking.size)
    exact = amount * lacking / lacking.sum()
    whole = np.floor(exact + 1e-9).astype(int)
    rest = np.argsort(-(exact - whole), kind="stable")[: amount - int(whole.sum())]
    whole[rest] += 1
    return [int(one) for one in whole]
