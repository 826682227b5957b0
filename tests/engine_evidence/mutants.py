"""Must-show: a fault planted in the fast engine is caught by the comparison of logs.

``PYTHONPATH=tests python -m engine_evidence.mutants [n]`` plants one fault after the other, and tells on how many of
the first n floors (60), or with ``--sample`` of those of ``engine_evidence.sample``, and of ``helped.yaml``, the fast
engine's log is no more that of SimPy. Exit code 1 where no log shows a fault, or where the sound engine is wrong, be it
with its own words planted anew.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

from checked_floors import plan_of
from engine_evidence.compared import Seen, seen
from engine_evidence.equality import compared
from engine_evidence.floors import floor_text, replication_of
from engine_evidence.planted import make_ready, plant
from engine_evidence.sample import SAMPLE

from opsim.plan import Plan

MOST_S = 120.0
"""That one floor may take: a faulty engine may go on for ever."""
HELPED = "helped"
"""A floor beside the random ones, as a file of this folder."""


@dataclass(frozen=True)
class Fault:
    """says : what goes wrong; place : the function, ``file.name``; old, new : its words, and those instead"""

    says: str
    place: str
    old: str
    new: str


MUTANTS = {
    "wrong_tie": Fault(
        "of two workers to whom everything else is alike the last goes, not the first",
        *("keys.pair_numbers", "float(worker.rank)", "-float(worker.rank)"),
    ),
    "stale_timeout": Fault(
        "what was called off happens all the same",
        *("routing.cancel", "event.alive = 0", "event.alive = 1"),
    ),
    "lost_interruption": Fault(
        "who is stopped in the middle of a stretch never hears of it, and goes on to its end",
        *("event_list.end_stretch", "worker.version += 1", "worker.version += 0"),
    ),
    "last_who_waits": Fault(
        "tools that are given back go to who has waited shortest for them",
        *("tool_store.give_out", "crib.asked.append(claim)", "crib.asked.insert(0, claim)"),
    ),
    "late_breaks": Fault(
        "what a calendar says happens one tick late, 2^-20 s",
        *("calendar.turn", "due.at_s - floor.now,", "due.at_s - floor.now + 2.0**-20,"),
    ),
    "rest_of_two": Fault(
        "what two were at and is broken off takes one of them no longer than both",
        *("andon.help_broken_off", "job.rest_s * job.block.slower", "job.rest_s"),
    ),
}
"""By name: three faults of any simulator, then three of single blocks."""
CONTROL = "control"
PLANTED = MUTANTS | {
    CONTROL: Fault(
        "nothing: the engine's own words are planted",
        "andon.help_broken_off",
        *2 * ("job.rest_s * job.block.slower",),
    )
}
"""With a control: what planting does by itself would otherwise count as a fault that was caught."""


def found_by(name: str, floors: Sequence[int | str], processes: int = 1) -> list[Seen]:
    """What each of some floors, by number or name, shows of the fast engine with a fault, or the sound one ('')."""
    with redirect_stdout(io.StringIO()):  # of which each floor would be told
        return compared(floors, partial(_look, name), processes, MOST_S, "spawn")


def make_sound_code(floors: Sequence[int | str]) -> None:
    """Have the machine code of the sound engine on disk for some floors."""
    from opsim.engine.fast_engine import ready

    for floor in floors:
        ready(_plan(floor)[0])


def _look(name: str, floor: int | str) -> Seen:
    plan, replication = _plan(floor)
    if name:
        make_ready(plan, _plant(name))
    return seen(f"{floor}", plan, replication)


@cache
def _plant(name: str):
    """The function that has the fault, once in a process."""
    fault = PLANTED[name]
    return plant(fault.place, fault.old, fault.new)


def _plan(floor: int | str) -> tuple[Plan, int]:
    if isinstance(floor, str):
        return plan_of(Path(__file__).with_name(f"{floor}.yaml").read_text()), 0
    return plan_of(floor_text(floor)), replication_of(floor)


def _tell(name: str, told: Sequence[Seen], n: int) -> None:
    """On how many of n floors a fault was caught, how the first of them shows it, and which they are."""
    print(f"{name}: {MUTANTS[name].says}\n  caught on {len(told)} of {n} floors")
    if told:
        first = next((one for one in told if one.differs), told[0])
        print(f"  floor {first.name}: {first.differs or first.refused or first.trouble}")
        print(f"  {', '.join(one.name for one in told)}", flush=True)


def main() -> int:
    """The exit code."""
    parser = argparse.ArgumentParser(prog="engine_evidence.mutants", description=__doc__)
    parser.add_argument("n", type=int, nargs="?", default=60, help="so many floors")
    parser.add_argument("--sample", action="store_true", help="the floors of engine_evidence.sample")
    parser.add_argument("--only", choices=MUTANTS, action="append", help="this fault")
    parser.add_argument("--processes", type=int, default=1)
    asked = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    floors: list[int | str] = [*(SAMPLE if asked.sample else range(asked.n)), HELPED]
    make_sound_code(floors)
    wrong = [one for name in ("", CONTROL) for one in found_by(name, floors, asked.processes) if one.is_wrong]
    print(f"the sound engine, then with its own words planted: {len(wrong)} of {2 * len(floors)} floors differ")
    unseen = 0
    for name in asked.only or MUTANTS:
        told = [one for one in found_by(name, floors, asked.processes) if one.is_wrong]
        unseen += not any(one.differs for one in told)
        _tell(name, told, len(floors))
    return int(bool(unseen or wrong))


if __name__ == "__main__":
    sys.exit(main())
