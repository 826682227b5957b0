"""optuna as a Search: its tree-structured Parzen estimator, seeded by a named stream."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.scenario.schema.studies.between import is_whole
from opsim.streams import stream
from opsim.study.select.search import Changes
from opsim.study.sweep.factors import Factor

STARTED = 10
"""Points that are drawn at random before the estimator says where to look; fewer where few are tried."""


class OptunaSearch:
    """Looks for the best point of some factors. Source: Watanabe 2023, arXiv:2304.11127 (the estimator); limits:
    Watanabe & Hutter 2023, IJCAI (constrained TPE).
    """

    def __init__(self, factors: Sequence[Factor], seed: int, trials: int):
        """Raises ValueError where optuna is not installed."""
        try:
            import optuna
        except ImportError:
            raise ValueError(
                "a search needs optuna, which is not installed; 'pip install opsim[search]' brings it"
            ) from None
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self._factors = {factor.path: factor for factor in factors}
        self._spaces = {factor.path: _space(factor) for factor in factors}
        self._failed = optuna.trial.TrialState.FAIL
        sampler = optuna.samplers.TPESampler(
            seed=int(stream(seed, 0, "select", "search").integers(2**31)),
            n_startup_trials=min(STARTED, max(2, trials // 3)),
            constant_liar=True,
        )
        self._study = optuna.create_study(direction="maximize", sampler=sampler)
        self._open: list[Any] = []

    def ask(self) -> Changes:
        """The next point to try."""
        trial = self._study.ask(self._spaces)
        self._open.append(trial)
        return {path: _value(self._factors[path], said) for path, said in trial.params.items()}

    def tell(self, changes: Changes, value: float | None, over: Sequence[float]) -> None:
        """What came of the first point that was asked for and not told yet."""
        trial = self._open.pop(0)
        for place, one in enumerate(over):
            trial.set_constraint(f"limit {place}", float(one))
        if value is None:
            self._study.tell(trial, state=self._failed)
        else:
            self._study.tell(trial, value)


def _space(factor: Factor) -> Any:
    """Ranges as shares of themselves, whole numbers and lists of numbers by rank, other lists by number."""
    from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution

    if factor.is_range:
        low, high = factor.values
        return IntDistribution(low, high) if is_whole(low, high) else FloatDistribution(0.0, 1.0)
    if factor.is_number:
        return IntDistribution(0, len(factor.values) - 1)
    return CategoricalDistribution(tuple(range(len(factor.values))))


def _value(factor: Factor, said: float) -> Any:
    if not factor.is_range:
        ordered = sorted(factor.values, key=factor.number) if factor.is_number else factor.values
        return ordered[int(said)]
    return int(said) if is_whole(*factor.values) else factor.at(float(said))
