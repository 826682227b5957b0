"""One floor, or one variant of a shipped scenario: run on both engines and looked at."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

from checked_floors import plan_of
from engine_evidence.coverage import blocks_of, finished, shown_by
from engine_evidence.floors import floor_text, replication_of
from engine_evidence.rows import first_difference
from engine_evidence.ties import contested_ties

from opsim.engine.floor.run import run_plan as run_simpy
from opsim.plan import Plan, compile_plan

REPLICATIONS = (0, 1)
"""Of each variant of a shipped scenario: two, as a floor that was used before must be as good as a new one."""


@dataclass(frozen=True)
class Seen:
    """What a comparison saw. words : of the vocabulary, of the plan and of the log; differs : in words, empty if not

    refused : what the fast engine says it does not run, empty where it runs all of it
    trouble : what went wrong in the fast engine, empty where nothing did
    """

    name: str
    words: frozenset[str]
    n_rows: int = 0
    n_finished: int = 0
    n_ties: int = 0
    simpy_s: float = 0.0
    fast_s: float = 0.0
    differs: str = ""
    refused: str = ""
    trouble: str = ""

    @property
    def is_wrong(self) -> bool:
        """Whether there are not two equal logs."""
        return bool(self.differs or self.refused or self.trouble)


def floor_seen(number: int, only: str = "", simpy_only: bool = False) -> Seen | None:
    """What a random floor shows; None where it does not use the block that is asked for."""
    plan = plan_of(floor_text(number))
    if only and only not in blocks_of(plan):
        return None
    return seen(f"floor {number}", plan, replication_of(number), simpy_only)


def shipped() -> Iterator[tuple[str, str, int]]:
    """(file, variant, replication) of every shipped scenario."""
    from opsim.scenario.read import scenarios_in
    from opsim.shipped import shipped_folder

    for path in sorted(shipped_folder().glob("*.yaml")):
        yield from product((path.stem,), scenarios_in(path.read_bytes(), path), REPLICATIONS)


def shipped_seen(
    name: str, variant: str, replication: int, horizon_s: float | None = None, simpy_only: bool = False
) -> Seen:
    """What a shipped scenario shows, to its own horizon or to a shorter one."""
    from opsim.scenario.read import scenarios_in
    from opsim.shipped import shipped_folder

    path = shipped_folder() / f"{name}.yaml"
    plan = compile_plan(scenarios_in(path.read_bytes(), path)[variant])
    if horizon_s is not None:
        plan = replace(plan, horizon_s=min(plan.horizon_s, horizon_s))
    return seen(f"{name}, {variant}, replication {replication}", plan, replication, simpy_only)


def seen(name: str, plan: Plan, replication: int, simpy_only: bool = False) -> Seen:
    """Run and look. Raises whatever the SimPy engine raises; what the fast one raises is told.

    The fast engine runs the replication twice: on a new floor, and again where most of its numbers are drawn ahead.
    """
    began = time.perf_counter()
    log = run_simpy(plan, replication)
    simpy_s = time.perf_counter() - began
    words = frozenset(blocks_of(plan) | shown_by(plan, log))
    found = Seen(name, words, len(log), finished(log), contested_ties(plan, log), simpy_s)
    if simpy_only:
        return found
    from opsim.engine.fast_engine import ready, unsupported
    from opsim.engine.fast_engine import run_plan as run_fast

    if refused := "; ".join(unsupported(plan)):
        return replace(found, refused=refused)
    try:
        ready(plan)
        began = time.perf_counter()
        other = run_fast(plan, replication)
        fast_s = time.perf_counter() - began
        run_fast(plan, replication + 1)
        again = run_fast(plan, replication)
    except Exception as error:  # of an engine that is on trial: the others are compared all the same
        return replace(found, trouble=f"{type(error).__name__}: {error}")
    return replace(found, fast_s=fast_s, differs=first_difference(log, other) or first_difference(log, again))
