"""Which scheme of the paper's family foretells held-out sequences best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from emulator.judge.prediction import Choice, chosen, dealt_folds, energy_scores, people_folds
from emulator.judge.sequence_distances import distances
from emulator.schemes.scheme import SCHEMES, Scheme, parsed

CANDIDATES = tuple(name for name in SCHEMES if name.startswith(("SIEM/", "IS-TVF/")) and "VAR" not in name)
"""Those that stand on one clock and draw whole sequences; others may be asked for by name."""
N_DRAWN = 100


def choose_scheme(
    directions: np.ndarray,
    worker_index: np.ndarray,
    names: Sequence[str] = CANDIDATES,
    dims: Any = None,
    seed: int = 0,
) -> Choice:
    """The scheme whose draws have the smallest energy score of sequences (N, T, B, 3) that it was not fitted to.

    worker_index : (N,) whose each sequence is: folds of repetitions of everybody, and of people held out whole
    dims         : as for ``Scheme.fit``
    Raises ValueError for an unknown name, or where fewer than three sequences would be left to fit.
    """
    _refuse(directions, worker_index, names)
    folds = [("repetitions", mask) for mask in dealt_folds(worker_index, np.random.default_rng(seed))]
    folds += [("workers", mask) for mask in people_folds(worker_index)]
    folds = [(over, mask) for over, mask in folds if np.sum(~mask) >= 3]
    if not folds or not names:
        raise ValueError(
            f"nothing to choose by: {len(names)} schemes, {len(folds)} folds of {len(directions)} sequences"
        )
    overs = dict.fromkeys(over for over, _ in folds)
    scores = {name: {over: np.full(len(directions), np.nan) for over in overs} for name in names}
    for name in names:
        for fold, (over, held) in enumerate(folds):
            scheme = Scheme.fit(directions[~held], name, dims, seed=seed)
            drawn = scheme.sample(N_DRAWN, np.random.default_rng([seed, fold]))
            scores[name][over][held] = energy_scores(distances(drawn, directions[held]), distances(drawn))
    return chosen(scores, worker_index)


def _refuse(directions: np.ndarray, worker_index: np.ndarray, names: Sequence[str]) -> None:
    wrong = [] if not isinstance(names, str) else [f"names: found {names!r}, expected a list of names"]
    for name in () if isinstance(names, str) else names:
        try:
            parsed(name)
        except ValueError as error:
            wrong.append(str(error))
    index = np.asarray(worker_index)
    if index.shape != (len(directions),) or index.dtype.kind not in "iu":
        found = f"{index.dtype} of shape {index.shape}"
        wrong.append(f"worker_index: found {found}, expected a whole number for each of {len(directions)} sequences")
    if wrong:
        raise ValueError("\n".join(wrong))
