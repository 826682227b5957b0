"""How far sequences of canonical postures stray from a reference sequence of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Variability:
    """E, the mean share of time that is spent in another canonical posture than the reference; Var E over sequences.

    mean, variance : of ``each`` (M,), in [0, 1]; the variance is NaN for one sequence
    """

    mean: float
    variance: float
    each: np.ndarray


def variability(labels: np.ndarray, reference: np.ndarray) -> Variability:
    """E(m) = share of times at which labels (M, T) differ from reference (T,), its mean and variance.

    The reference is the quantized mean sequence of the training. Small is not good in itself: compare with what
    the recorded sequences have. Raises ValueError for unequal lengths.
    Source: Chen, Park & Srivastava sec. 4.4 (3), E and Var(E), table 4.
    """
    labels, reference = np.atleast_2d(labels), np.asarray(reference)
    if labels.shape[1:] != reference.shape:
        raise ValueError(f"variability: labels {labels.shape} and reference {reference.shape}, expected equal lengths")
    each = (labels != reference).mean(axis=1)
    return Variability(float(each.mean()), float(each.var(ddof=1)) if len(each) > 1 else float("nan"), each)
