"""What theory says of the scenario files beside this one, and how to ask the simulation for the same figure.

The expected numbers are those of ``known_answers.json`` (each with its formula and source; every one can be had anew
from the closed form or the Markov chain named there), or come from the Markov chain of ``chains.py``.
"""

from known_answers import assembly, assignment, duty, failures, lines, pull, sequence
from known_answers.case import HERE, Case
from known_answers.chains import line_rate

__all__ = ["CASES", "HERE", "TAKE_LONG", "Case"]


def _queue(file: str, variant: str, model: str, few: int = 12) -> list[Case]:
    return [
        Case(file, variant, "time_in_system_s", (model, "W"), most_half_width=0.02, few=few),
        Case(file, variant, "work_in_progress", (model, "L"), most_half_width=0.02, few=few),
    ]


def _rate(file: str, variant: str, *expected: str) -> Case:
    return Case(file, variant, "throughput_per_h", expected, scale=3600.0)


def _chain(file: str, variant: str, mean_s: tuple[float, ...], phases: int = 1, room: int = 0) -> Case:
    return Case(file, variant, "throughput_per_h", line_rate(mean_s, phases, room), scale=3600.0)


_TWO = "two-station line, exponential, equal rates"
_ANY = "two stations, no buffer, any distribution"
_LINES = "balanced exponential lines (Hillier & Boling type table)"
_SHAPES = {
    "uniform": "uniform(0,2)",
    "deterministic": "deterministic",
    "erlang": "Erlang-2",
    "normal": "normal cv=0.2",
    "lognormal": "lognormal cv=0.5",
}
_ROOM = {3: (0, 1, 2, 3, 5), 4: (0, 1, 2, 3), 5: (0, 1, 2)}
_WORD = {3: "three", 4: "four", 5: "five"}
_JACKSON = "Jackson line with rework"

CASES = (
    *_queue("mmc", "one_server", "M/M/1 rho=0.80"),
    *_queue("mmc", "two_servers", "M/M/2 rho=0.90", few=24),
    *_queue("mmc", "eight_servers", "M/M/8 rho=0.85"),
    _rate("mm1k", "base", "M/M/1/5 rho=0.9", "throughput"),
    Case("mm1k", "base", "work_in_progress", ("M/M/1/5 rho=0.9", "L")),
    Case("mg1", "fixed", "work_in_progress", ("M/G/1 D rho=0.8", "L"), most_half_width=0.02),
    Case("mg1", "erlang", "work_in_progress", ("M/G/1 E3 rho=0.8", "L"), most_half_width=0.02),
    Case("mg1", "exponential", "work_in_progress", ("M/G/1 M rho=0.8", "L"), most_half_width=0.02),
    Case("mg1", "lognormal", "work_in_progress", ("M/G/1 LN cv=0.5 rho=0.8", "L"), most_half_width=0.02),
    Case("jackson", "base", "time_in_system_s", (_JACKSON, "total_flow_time"), most_half_width=0.02),
    Case("jackson", "base", "work_in_progress", (_JACKSON, "L", "sum"), most_half_width=0.02),
    Case(
        *("polling", "base", "time_in_system_s"),
        ("one worker walking round 4 stations (exhaustive polling)", "mean_wait"),
        shift=1.0,
        most_half_width=0.02,
        few=20,
    ),
    *(_rate("line_of_two", f"buffer_{b}" if b else "base", _TWO, "throughput", str(b)) for b in (0, 1, 2, 3, 5, 10)),
    *(_rate("line_of_two", variant, _ANY, "throughput", key) for variant, key in _SHAPES.items()),
    *(
        _rate(f"line_of_{_WORD[k]}", f"buffer_{b}" if b else "base", _LINES, "throughput", f"K={k},B={b}")
        for k, room in _ROOM.items()
        for b in room
    ),
    _chain("line_of_three", "bowl", (1.1, 0.8, 1.1)),
    _chain("line_of_three", "arch", (0.9, 1.2, 0.9)),
    *(_chain(f"line_of_{word}", "erlang", (1.0,) * k, phases=2) for k, word in _WORD.items()),
    *(_chain(f"line_of_{word}", "erlang_buffer_1", (1.0,) * k, phases=2, room=1) for k, word in _WORD.items()),
    *failures.CASES,
    *assembly.CASES,
    *pull.CASES,
    *sequence.CASES,
    *duty.CASES,
    *assignment.CASES,
    *lines.CASES,
)

TAKE_LONG = {
    *(("gershwin", variant) for variant in ("n10", "n20", "uneven", "infinite")),
    *(("base_stock", "base"), ("priorities", "restart"), ("priorities", "shortest"), ("batches", "eight")),
    *(("kitting", "uneven"), ("interrupted", "in_use_spread"), ("transfer_line", "k10")),
    *(("polling", "limited"), ("mmc", "two_servers"), ("mmc", "eight_servers"), ("priorities", "resume")),
    ("interrupted", "any_time"),
}
"""Variants that need more replications than there is time for in a test with SimPy."""
