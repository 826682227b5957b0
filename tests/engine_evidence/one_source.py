"""Must-show: a fault planted in the one source of the floor is read by both drivers, and caught; by whom.

``PYTHONPATH=tests python -m engine_evidence.one_source`` plants one fault after the other. As both drivers read the
same source, their rows are equal with most faults: it is other judges that catch them. They are

- ``twins``     : the floors written by hand in plain SimPy (``simpy_twins``) have other rows;
- ``golden``    : a made floor's rows are not those of ``golden_logs.txt``;
- ``audit``     : a log breaks a law that holds for any floor, or the run does not come to its end;
- ``sanitizer`` : SimPy's driver refuses a rule that compiled code would run otherwise;
- ``drivers``   : SimPy's and the compiled driver have different rows.

Exit code 1 where a fault is caught by none, or the sound source is not right.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

from engine_evidence.mutants import Fault, make_sound_code
from engine_evidence.planted import is_sanitized, make_ready, plant, planted_in_simpy

FAULTS = {
    "wrong_tie": Fault(
        "of two jobs that wait since the same instant the one of the higher number is served first",
        *("routing.is_before", "one.number < other.number", "one.number > other.number"),
    ),
    "stale_timeout": Fault(
        "what was called off happens all the same",
        *("routing.cancel", "event.alive = 0", "event.alive = 1"),
    ),
    "lost_interruption": Fault(
        "who is stopped in the middle of a stretch never hears of it, and goes on to its end",
        *("worker.stop", "end_stretch(floor, worker)", "pass"),
    ),
    "begun_twice": Fault(
        "a job that moves up to a server stays in the queue, and is begun once more",
        *("flow.leave_station", "station.queue.pop(0)", "station.queue[0]"),
    ),
    "one_too_many": Fault(
        "a job that goes straight on to a buffer is let in where it is full by one",
        *("routing.goes_in_next", ".n_inside < gate", ".n_inside - 1 < gate"),
    ),
    "used_after": Fault(
        "a job that has left the floor, and is given back, is asked whether it is there",
        *("settle.operation_over", "floor.done is job", "job.on_floor"),
    ),
}
JUDGES = ("twins", "golden", "audit", "sanitizer", "drivers")
FLOORS = (3, 11, 86, 101, 268)
MOST_S, MOST_BYTES = 600.0, 4 << 30


def caught(name: str, floors: tuple[int, ...] = FLOORS) -> dict[str, str]:
    """By judge, how it shows a fault, or the sound source ('') as wrong: on the first floor where it does."""
    found: dict[str, str] = {}
    for sanitize in ("0", "1"):
        for judge, words in _looked(name, floors, sanitize):
            found.setdefault(judge, words)
    return {judge: found[judge] for judge in JUDGES if judge in found}


def _looked(name: str, floors: tuple[int, ...], sanitize: str) -> Iterator[tuple[str, str]]:
    """What is said in a process of its own, which may die, or not come to an end."""
    path = os.pathsep.join([str(Path(__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = os.environ | {"OPSIM_SANITIZE": sanitize, "PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "engine_evidence.one_source", "--look", name, *map(str, floors)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment, timeout=MOST_S)
        lines, code = done.stdout.splitlines(), done.returncode
    except subprocess.TimeoutExpired as error:
        lines, code = (error.stdout or b"").decode().splitlines(), "no end"
    yield from (tuple(json.loads(line)) for line in lines)
    if code == 1:
        raise RuntimeError(f"{name}: what plants and looks has failed itself, see above")
    if code:
        yield "drivers", f"the process ended with {code}"


def _look(name: str, floors: list[int]) -> None:
    """Plant a fault in both drivers, and say of each judge that shows it."""
    if not name:
        _tell_all(floors, None)
        return
    fault = FAULTS[name]
    place, old, new = fault.place, fault.old, fault.new
    faulty = None if is_sanitized() else plant(place, old, new)
    with planted_in_simpy(place, old, new):
        _tell_all(floors, faulty)


def _tell_all(floors: list[int], faulty: Any) -> None:
    for judge, words in chain(_of_twins(), *(_of_floor(number, faulty) for number in floors)):
        print(json.dumps([judge, words]), flush=True)


def _of_twins() -> Iterator[tuple[str, str]]:
    from plans import plan
    from simpy_twins import TWINS
    from simpy_twins.compared import first_difference, rows_of, whole_seconds
    from simpy_twins.floor import Floor

    for name, twin in TWINS.items() if not is_sanitized() else ():
        made, floor = plan(whole_seconds(twin.text)), Floor(1, 0, True)
        twin.build(floor)
        log, words = _run(made, 0)
        said = words or first_difference(floor.run(made.horizon_s), rows_of(log))
        if said:
            yield "twins", f"{name}: {said}"


def _of_floor(number: int, faulty: Any) -> Iterator[tuple[str, str]]:
    from checked_floors import plan_of
    from engine_evidence.floors import floor_text, replication_of
    from golden_logs import Golden, written

    plan, replication = plan_of(floor_text(number)), replication_of(number)
    log, words = _run(plan, replication)
    if is_sanitized():
        if words.startswith("Unsound"):
            yield "sanitizer", f"floor {number}: {words}"
        return
    if words:
        yield "audit", f"floor {number}: {words}"
        return
    moved = Golden.of(log).moved(written()[f"made/{number}"])
    if moved:
        yield "golden", f"floor {number}: {moved}"
    yield from _of_both(number, plan, replication, log, faulty)


def _of_both(number: int, plan: Any, replication: int, log: Any, faulty: Any) -> Iterator[tuple[str, str]]:
    from engine_evidence.rows import first_difference

    from opsim.engine.fast_engine import ready, run_plan

    if faulty is None:
        ready(plan)
    else:
        make_ready(plan, faulty)
    said = first_difference(log, run_plan(plan, replication))
    if said:
        yield "drivers", f"floor {number}: {said}"


def _run(plan: Any, replication: int) -> tuple[Any, str]:
    """The log by SimPy's driver, looked at; and what goes wrong, in words."""
    from opsim import audit
    from opsim.engine.floor.run import run_plan

    try:
        log = run_plan(plan, replication)
        audit(log, plan)
    except Exception as error:  # of rules that are on trial
        return None, f"{type(error).__name__}: {error}"
    return log, ""


def main() -> int:
    """The exit code."""
    if sys.argv[1:2] == ["--look"]:
        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))  # a faulty rule may make jobs for ever
        _look(sys.argv[2], [int(one) for one in sys.argv[3:]])
        return 0
    make_sound_code(FLOORS)
    wrong = caught("")
    print(f"the sound source: {wrong or 'right'}", flush=True)
    unseen = 0
    for name, fault in FAULTS.items():
        found = caught(name)
        unseen += not found
        print(f"{name}: {fault.says}\n  caught by {', '.join(found) or 'nobody'}")
        for judge, words in found.items():
            print(f"    {judge}: {words}", flush=True)
    return int(bool(wrong or unseen))


if __name__ == "__main__":
    sys.exit(main())
