"""Why results have nothing of a figure, and what to do about it.

Variants against a base, replication by replication: common random numbers make the pairs alike.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from opsim.kpi.catalogue import KPIS, needs_postures
from opsim.problems import did_you_mean
from opsim.results import Key, Result, Table, figures_of
from opsim.study.intervals import CONFIDENCE, FEW, ROUNDING, Interval, holm, paired, t_interval

__all__ = ["ROUNDING", "Comparison", "Difference", "NotComparable", "compare", "holm", "paired", "scheduled_hours"]


ONLY_WHERE = {
    "rest_taken_min_per_h": "people rest by need ('human: rest')",
    "fatigue_mean": "people tire ('human: fatigue')",
    "fatigue_most": "people tire ('human: fatigue')",
    "learned_share": "people learn ('human: learning')",
    "experience": "people learn ('human: learning')",
    **dict.fromkeys(("on_duty_h", "duty_use", "overtime_h", "absent_share"), "workers have shifts"),
    **dict.fromkeys(
        ("stops_per_h", "down_s", "wait_for_repair_s", "mean_time_between_failures_s", "stop_share"),
        "stations have 'breakdowns' or 'maintenance'",
    ),
    "repair_team_use": "there are 'repair_teams'",
    **dict.fromkeys(
        ("stock", "stock_empty", "stored_per_h", "time_to_store_s", "parts_used_per_h"), "there are 'stores'"
    ),
    **dict.fromkeys(("on_conveyor", "conveyor_blocked"), "there are 'conveyors'"),
    **dict.fromkeys(("transporter_states", "driven_m", "pickup_wait_s"), "there are 'transporters'"),
    **dict.fromkeys(("tool_use", "tools_waited_for"), "there are 'tools'"),
    **dict.fromkeys(("incomplete_share", "line_stopped_share"), "there are 'lines'"),
    "handoff_position": "there are 'crews'",
    **dict.fromkeys(("scrap_share", "scrap_per_h"), "work can be scrapped ('yield', 'inspect', 'breakdowns')"),
    **dict.fromkeys(("first_pass_yield", "defects_out_share"), "work can go wrong ('yield')"),
    "rework_per_h": "an inspection sends work back ('inspect: {then: {rework: ...}}')",
    **dict.fromkeys(("late_share", "tardiness_s"), "jobs have due dates ('due')"),
}
"""Figures that there are only where the scenario says something; the others are not listed."""


def remedy(kpi: str, names: Iterable[str]) -> str:
    """What is to be said of a figure that is not there: some are made only where the scenario asks for them.

    names : of the figures that there are
    """
    if needs_postures([kpi]):
        return "it is made where the scenario's 'outputs' list it: add it there, and run again"
    if kpi in KPIS:
        why = f": there is one only where {ONLY_WHERE[kpi]}" if kpi in ONLY_WHERE else ""
        return f"these results have none of it{why}"
    return did_you_mean(kpi, names)


NOT_PROVEN = "not proven"
PER_SCHEDULED_HOUR, PER_CALENDAR_HOUR = ("throughput_per_h",), "throughput_per_calendar_h"
_NOT_PROVEN_WORDS = (
    "by itself its interval leaves 0 out, but among so many comparisons chance alone brings some that do; more "
    "replications, or fewer figures and variants, can settle it."
)


class NotComparable(ValueError):
    """Results that cannot be compared, and why."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One figure of a variant minus that of the base.

    base, mean      : means of the base and of the variant
    interval        : of the mean of paired differences, for itself alone
    p, p_together   : two-sided paired t test; the same held against all comparisons made (Holm)
    variance_ratio  : (var a + var b) / var(a - b): so many times more replications independent runs would need for the
                      same interval; None where the difference does not vary
    other_hours     : whether it is per scheduled hour, and the variant and the base are open for different hours: their
                      difference says nothing of what comes out, and is not tested
    """

    variant: str
    key: Key
    base: float
    mean: float
    interval: Interval
    p: float
    p_together: float
    variance_ratio: float | None
    other_hours: bool = False

    @property
    def identical(self) -> bool:
        """The same in every replication, but for rounding."""
        return self.interval.n > 0 and self.interval.mean == 0 and self.interval.sd == 0

    @property
    def verdict(self) -> str:
        """What may be said: higher, lower, not proven, no clear difference, identical, other hours, too few, nothing.

        not proven : its own interval leaves 0 out, but not clearly enough for as many comparisons as are made
        """
        if self.other_hours:
            return "other hours"
        if self.interval.n == 0:
            return "nothing observed"
        if self.identical:
            return "identical"
        if np.isnan(self.p_together):
            return "one replication says nothing" if self.interval.n == 1 else "too few replications to say"
        if self.p_together > 1 - CONFIDENCE:
            return "no clear difference" if self.p > 1 - CONFIDENCE else NOT_PROVEN
        return "higher" if self.interval.mean > 0 else "lower"


@dataclass(frozen=True, slots=True)
class Comparison:
    """All differences from ``base``; ``n`` is the number of pairs of replications.

    hours : by variant, for how many hours of the window the floor is scheduled to be open; empty where none keeps hours
    """

    base: str
    seed: int
    n: int
    differences: tuple[Difference, ...]
    hours: Mapping[str, float] = field(default_factory=dict)

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row for each figure of each variant. Raises ImportError where pandas is absent."""
        from opsim.notebook import COLUMNS, comparison_rows
        from opsim.results import frame_of_rows

        return frame_of_rows(COLUMNS, comparison_rows(self))

    def _repr_html_(self) -> str:
        from opsim.notebook import comparison_html

        return comparison_html(self)

    @property
    def tests(self) -> int:
        """How many comparisons are held against each other."""
        return sum(not np.isnan(_tested(difference)) for difference in self.differences)

    @property
    def pairs(self) -> str:
        """``20 pairs of replications with the same random numbers (seed 7)``."""
        pairs = "1 pair" if self.n == 1 else f"{self.n} pairs"
        return f"{pairs} of replications with the same random numbers (seed {self.seed})"

    @property
    def short_words(self) -> tuple[str, ...]:
        """The same as ``words`` for who has read them once."""
        alone = "(*) would be clear by itself, but is not proven among so many comparisons."
        few = f" {self.n} are few: more replications make ± smaller." if 1 < self.n < FEW else ""
        return (
            f"± is the {100 * CONFIDENCE:.0f} % interval of a difference by itself, from {self.pairs}.{few}",
            f"* is clearly higher or lower, with all {self.tests} comparisons held together (Holm 1979).",
            *([alone] if self._any_not_proven else ()),
            *self._hours_words(),
        )

    @property
    def words(self) -> tuple[str, ...]:
        """How the numbers are to be read."""
        m = self.tests
        own, wrong = f"{100 * CONFIDENCE:.0f} %", f"{100 * (1 - CONFIDENCE):.0f} %"
        return (
            f"Differences from {self.base} in {self.pairs}.",
            f"Each {own} interval is for its own figure alone. 'higher' and 'lower' are said so that "
            f"all comparisons together ({m}) are wrong with a chance of at most {wrong} (Holm 1979).",
            *([f"'{NOT_PROVEN}': {_NOT_PROVEN_WORDS}"] if self._any_not_proven else ()),
            "Pairing: so many times more replications would be needed with independent random numbers.",
            *self._hours_words(),
        )

    @property
    def _any_not_proven(self) -> bool:
        return any(d.verdict == NOT_PROVEN for d in self.differences)

    def _hours_words(self) -> Iterator[str]:
        others = list(dict.fromkeys(d.variant for d in self.differences if d.other_hours))
        if others:
            open_h = ", ".join(f"{name} {self.hours[name]:g} h" for name in (self.base, *others))
            yield (
                f"Other hours: the variants are open for different times ({open_h}), so what comes out per scheduled "
                "hour says nothing of which has more; see the throughput per calendar hour."
            )


def compare(results: Mapping[str, Result], base: str = "base", kpis: Sequence[str] = ()) -> Comparison:
    """Paired differences of every variant from the base.

    kpis : names of figures, each with all its subjects; by default the headline figures of the whole
    Raises NotComparable (no such base, other seeds, unknown figures), OSError where results cannot be read.
    """
    _check(results, base)
    hours = scheduled_hours(results)
    apart = {name for name in hours if hours[name] != hours[base]}
    keys = _keys(results[base], list(results[base].kpis()), kpis, by_calendar=bool(apart))
    tables = tables_of(results, dict.fromkeys(key[0] for key in keys))
    shared = sorted(set.intersection(*({r for row in table.values() for r in row} for table in tables.values())))
    found = [
        _difference(name, key, table[key], tables[base][key], shared, key[0] in PER_SCHEDULED_HOUR and name in apart)
        for key in keys
        for name, table in tables.items()
        if name != base and key in table
    ]
    together = holm([_tested(difference) for difference in found])
    differences = tuple(replace(d, p_together=d.p if d.identical else float(p)) for d, p in zip(found, together))
    return Comparison(base, results[base].summary["seed"], len(shared), differences, hours)


def _tested(difference: Difference) -> float:
    """The p that is held against the others: nan where there is nothing to test, as between identical figures."""
    return np.nan if difference.identical or difference.other_hours else difference.p


def scheduled_hours(results: Mapping[str, Result]) -> dict[str, float]:
    """By variant, its scheduled hours; all of the window where it keeps none. Nothing where none of them does."""
    said = {name: result.summary.get("scheduled_h") for name, result in results.items()}
    if all(found is None for found in said.values()):
        return {}
    low_s, high_s = next(iter(results.values())).summary["window_s"]
    return {name: (high_s - low_s) / 3600 if found is None else float(found) for name, found in said.items()}


def _difference(
    name: str, key: Key, of: dict[int, float], base: dict[int, float], shared: list[int], other_hours: bool
) -> Difference:
    a, b = ([row.get(replication, np.nan) for replication in shared] for row in (of, base))
    interval, p, ratio = paired(a, b)
    return Difference(name, key, t_interval(b).mean, t_interval(a).mean, interval, p, p, ratio, other_hours)


def tables_of(results: Mapping[str, Result], names: Collection[str]) -> dict[str, Table]:
    """By variant, the figures with some names."""
    if all(isinstance(result, Result) for result in results.values()):
        return dict(zip(results, figures_of(list(results.values()), names)))
    return {name: result.kpis() for name, result in results.items()}


def _check(results: Mapping[str, Result], base: str) -> None:
    if base not in results:
        raise NotComparable(
            f"no variant {base!r} to compare with; {did_you_mean(base, results, otherwise='there are')}"
        )
    if len(results) < 2:
        raise NotComparable(f"only {base} is there: nothing to compare it with")
    for what, of in (("scenario", "scenario"), ("window", "window_s")):
        found = {name: result.summary.get(of) for name, result in results.items()}
        other = next((name for name in found if found[name] != found[base]), None)
        if other is not None:
            raise NotComparable(
                f"not one study: the {what} of {base} is {found[base]}, that of {other} is {found[other]}; "
                f"run them with one file into one folder"
            )
    seeds = {name: result.summary["seed"] for name, result in results.items()}
    if len(set(seeds.values())) > 1:
        said = ", ".join(f"{name} has seed {seed}" for name, seed in seeds.items())
        raise NotComparable(f"pairs need the same random numbers: {said}; run all variants with one seed")


def _keys(base: Result, keys: list[Key], kpis: Sequence[str], by_calendar: bool) -> list[Key]:
    """by_calendar : whether the throughput per calendar hour has to stand beside that per scheduled hour."""
    names = {key[0] for key in keys}
    unknown = [f"no figure {kpi!r}; {remedy(kpi, names)}" for kpi in kpis if kpi not in names]
    if unknown:
        raise NotComparable("\n".join(unknown))
    if kpis:
        return [key for kpi in kpis for key in keys if key[0] == kpi]
    headline = {row["kpi"] for row in base.summary["kpis"] if row["headline"]}
    if by_calendar and headline.intersection(PER_SCHEDULED_HOUR):
        headline.add(PER_CALENDAR_HOUR)
    whole = [key for key in keys if not key[1]]
    return [key for key in whole if key[0] in headline] or whole
