"""Must-show: a fault planted in one engine is caught by the comparison of logs.

``PYTHONPATH=tests python -m engine_evidence.mutants [n]`` plants three faults in the SimPy engine, one after the other,
and tells on how many of the first n floors (60) its log is no more that of the sound engine: of the fast one, or with
``--simpy`` of SimPy itself. Exit code 1 where a fault goes unseen.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from checked_floors import plan_of
from engine_evidence.floors import floor_text, replication_of
from engine_evidence.rows import first_difference

from opsim.log import EventLog
from opsim.plan import Plan

Runs = Callable[[Plan, int], EventLog]


@contextmanager
def wrong_tie() -> Iterator[None]:
    """Of two workers to whom everything else is alike the last goes, not the first."""
    from opsim.engine.simpy_engine import floor

    sound = floor.dispatch_rule

    def turned(name: str) -> Callable[..., tuple[float, ...]]:
        rule = sound(name)
        return lambda *asked: (*rule(*asked)[:-1], -asked[-1])

    with _in_place_of((floor, "dispatch_rule", turned)):
        yield


@contextmanager
def stale_timeout() -> Iterator[None]:
    """What was called off happens all the same."""
    from opsim.engine.simpy_engine import boarding, human_rest, interruption, line_clock, wear

    modules = (boarding, human_rest, interruption, line_clock, wear)
    with _in_place_of(*((module, "cancel", lambda _event: None) for module in modules)):
        yield


@contextmanager
def lost_interruption() -> Iterator[None]:
    """Who is stopped in the middle of a stretch never hears of it, and goes on to its end."""
    from simpy import Process

    with _in_place_of((Process, "interrupt", lambda *_: None)):
        yield


MUTANTS = {one.__name__: one for one in (wrong_tie, stale_timeout, lost_interruption)}
"""By name, each a ``with`` in which the SimPy engine has the fault."""


@contextmanager
def _in_place_of(*places: tuple[Any, str, Any]) -> Iterator[None]:
    """Other things under some names, for a while."""
    sound = [getattr(home, name) for home, name, _ in places]
    for home, name, other in places:
        setattr(home, name, other)
    try:
        yield
    finally:
        for (home, name, _), one in zip(places, sound):
            setattr(home, name, one)


def caught(name: str, number: int, sound: Runs) -> str:
    """How a floor tells a faulty SimPy engine from a sound one, in words; nothing where it does not.

    A run that the fault makes impossible tells it as well.
    """
    from opsim.engine.simpy_engine import run_plan

    plan, replication = plan_of(floor_text(number)), replication_of(number)
    log = sound(plan, replication)
    with MUTANTS[name]():
        try:
            other = run_plan(plan, replication)
        except Exception as error:  # whatever becomes of a run in which something is wrong
            return f"{type(error).__name__}: {error}"
    return first_difference(other, log, ("faulty", "sound"))


def main() -> int:
    """The exit code."""
    parser = argparse.ArgumentParser(prog="engine_evidence.mutants", description=__doc__)
    parser.add_argument("n", type=int, nargs="?", default=60, help="so many floors")
    parser.add_argument("--simpy", action="store_true", help="compare with SimPy itself")
    asked = parser.parse_args()
    unseen = 0
    for name, fault in MUTANTS.items():
        told = [words for number in range(asked.n) if (words := caught(name, number, _sound(asked.simpy)))]
        unseen += not told
        print(f"{name}: {fault.__doc__}\n  caught on {len(told)} of {asked.n} floors, first:\n  {(told or ['-'])[0]}")
    return int(bool(unseen))


def _sound(simpy: bool) -> Runs:
    if simpy:
        from opsim.engine.simpy_engine import run_plan
    else:
        from opsim.engine.fast_engine import run_plan
    return run_plan


if __name__ == "__main__":
    sys.exit(main())
