"""Which engine runs a Plan: the reference (SimPy), the fast one, or whichever is sooner done.

Both give the same rows, so that the choice decides nothing but the time it takes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.engine import AUTO, ENGINES, FAST, SIMPY
from opsim.problems import did_you_mean, shown

if TYPE_CHECKING:
    from opsim.log import EventLog
    from opsim.plan import Plan

VISIT_S = 40e-6
"""Processor seconds for each visit of a job to a station, all rows that come of it included.

NOTE: the shipped scenarios take 5 to 90 microseconds, the middle of them 35: an estimate within a factor of 3.
"""


def simpy_s(plan: Plan) -> float:
    """Processor seconds of one replication, about."""
    return visits(plan) * VISIT_S


def visits(plan: Plan) -> float:
    """Visits of jobs to stations in a run, by mean times; no more than the bottleneck lets through."""
    from opsim.plan.loads import loads_of

    loads = loads_of(plan)
    flows, limits = loads.flows, loads.limits
    most_per_h = limits[0].most_per_h if limits else None
    known_per_h = sum(step.per_h for step in flows.steps)
    if most_per_h is None:
        return known_per_h * plan.horizon_s / 3600
    if not flows.saturated:
        share = min(1.0, most_per_h / flows.per_h) if flows.per_h > 0 else 1.0
        return share * known_per_h * plan.horizon_s / 3600
    return (known_per_h + most_per_h * sum(step.per_job for step in flows.steps)) * plan.horizon_s / 3600


COMPILING_S, LOADING_S = 8.0, 1.0
"""What the fast engine costs before its first row: compiled on a machine that nothing is known of, and read later."""
Run = Callable[["Plan", int], "EventLog"]
Told = Callable[[int, int], None]
"""``told(done, total)`` while something is compiled."""


@dataclass(frozen=True, slots=True)
class Choice:
    """engine : ``simpy`` or ``fast``; why : in words that follow its name; asked : one of ``ENGINES``

    may_pay : whether the fast engine was only not worth it, and would be for more replications
    """

    engine: str
    why: str
    asked: str = SIMPY
    may_pay: bool = False

    @property
    def words(self) -> str:
        """One sentence."""
        return f"the {'fast' if self.engine == FAST else 'SimPy'} engine, {self.why}"


NO_COMPILER = "numba's compiler is switched off here (NUMBA_DISABLE_JIT); unset that to have it"
REFERENCE = Choice(SIMPY, "which is the reference")


@dataclass(frozen=True, slots=True)
class Refusal:
    """Something that the fast engine does not run, in words; places : paths of the scenario where it may stand."""

    words: str
    places: tuple[tuple[str, ...], ...] = ()


class NotFast(ValueError):
    """A Plan that the fast engine does not run; ``refusals`` is all of what it does not."""

    def __init__(self, refusals: Sequence[Refusal]):
        self.refusals = tuple(refusals)
        super().__init__(self.refusals)

    def __str__(self) -> str:
        return "\n".join(f"the fast engine does not run this: {one.words}" for one in self.refusals)


def able_to(asked: str, plan: Plan) -> Choice:
    """The engine for a Plan; ``auto`` is the fast one where it runs the Plan.

    Raises ValueError for an unknown word, NotFast.
    """
    known(asked)
    if asked == SIMPY:
        return REFERENCE
    refusals = refused(plan)
    if not refusals:
        return Choice(FAST, "as asked" if asked == FAST else "as it runs all of this scenario", asked)
    if asked == FAST:
        raise NotFast(refusals)
    more = f", and {len(refusals) - 1} more" if len(refusals) > 1 else ""
    return Choice(SIMPY, f"as the fast one does not run this: {refusals[0].words}{more}", AUTO)


def refused(plan: Plan) -> list[Refusal]:
    """All that the fast engine does not run of a Plan: rules that are plug-ins, then what it says itself.

    Without numba's compiler it runs nothing.
    """
    from numba import config

    if getattr(config, "DISABLE_JIT", 0):
        return [Refusal(NO_COMPILER)]
    from opsim.engine.fast_engine import unsupported
    from opsim.engine.plugin_rules import plugin_rules

    rules: dict[str, tuple[tuple[str, ...], ...]] = {}
    for rule in plugin_rules(plan):
        rules[str(rule)] = tuple(dict.fromkeys((*rules.get(str(rule), ()), *rule.places)))
    others = (words for words in unsupported(plan) if words not in rules)
    return [Refusal(words, places) for words, places in rules.items()] + [Refusal(words) for words in others]


def runner_of(choice: Choice) -> Run:
    """What runs one replication: ``run_plan`` of the chosen engine, imported now."""
    if choice.engine == FAST:
        from opsim.engine.fast_engine import run_plan
    else:
        from opsim.engine.floor.run import run_plan
    return run_plan


def make_ready(choice: Choice, plan: Plan, told: Told | None = None) -> None:
    """Compile what the chosen engine needs for a Plan, where that is not done: before other processes are started."""
    if choice.engine == FAST:
        from opsim.engine.fast_engine import ready

        ready(plan, told)


def known(asked: str) -> str:
    """The word itself. Raises ValueError with the nearest one where there is no such engine."""
    if asked not in ENGINES:
        words = f"expected {', '.join(ENGINES[:-1])} or {ENGINES[-1]}"
        raise ValueError(f"engine: found {shown(asked)}, {words}; {did_you_mean(asked, ENGINES)}".rstrip("; "))
    return asked


def worth(able: Choice, plan: Plan, simpy_s: float, *, of: str = "", here: bool = True) -> Choice:
    """What ``able_to`` found; of ``auto`` SimPy where compiling, or reading compiled code, takes longer than its work.

    simpy_s : by the clock, of all that is to be run, and ``of`` what in words, where that is more than this Plan
    here : whether this machine runs it: of others it is not known what is compiled there
    """
    if able.asked != AUTO or able.engine != FAST:
        return able
    from opsim.engine.fast_engine import compiling_s

    costs_s = compiling_s(plan) if here else COMPILING_S
    takes = f"{'less than a second' if simpy_s < 1 else f'about {_rounded(simpy_s)} s'}{of}"
    compiling = f"about {_rounded(costs_s)} s, {_how_often(here)}"
    if simpy_s > max(costs_s, LOADING_S):
        costs = f"compiling takes {compiling}" if costs_s else "the fast one is compiled already"
        return Choice(FAST, f"as SimPy would take {takes}, and {costs}", AUTO)
    costs = f"compiled ({compiling})" if costs_s else f"read from disk (about {LOADING_S:.0f} s)"
    return Choice(SIMPY, f"as it takes {takes}, and the fast one would first be {costs}", AUTO, may_pay=True)


def _how_often(here: bool) -> str:
    """It is compiled for a Plan."""
    from opsim.engine.fast_engine import is_kept

    if not here:
        return "once on each machine"
    return "once on this machine" if is_kept() else "each time, as it can be kept nowhere"


def _rounded(seconds: float) -> str:
    """Two digits, as an estimate has not more."""
    return f"{float(f'{seconds:.2g}'):,.0f}" if seconds >= 10 else f"{seconds:.2g}"
