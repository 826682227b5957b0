"""What the sheet says of paced lines."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import LinePlan, Plan

Line = tuple[str, str]


def lines(plan: Plan) -> Iterator[Line]:
    """(topic, what is assumed) of each paced line, most weighty first."""
    for line in plan.lines:
        yield "lines", f"{line.name}: {_late(line)}"
        yield "lines", f"{line.name}: {_moves(line)}"
        if line.floaters:
            names = listed([plan.workers[rank].name for rank in line.floaters])
            how = (
                "takes his own share of what is left, and both are done at once"
                if line.helps
                else "takes a time of his own for what is left, and whoever was there is free"
            )
            yield "lines", f"{line.name}: {names} only when called; who comes {how}"


def _late(line: LinePlan) -> str:
    if line.sends_on:
        return (
            "a job that is not done in time goes on as it is and is bad, whatever is missing; nobody makes up for it "
            "further down, and inspections find it as they find other defects"
        )
    return "while a job that should move on is worked on, the line stands and all other work goes on"


def _moves(line: LinePlan) -> str:
    if not line.moves:
        return "moving on takes no time; while it stands because of a station or a break, its clock stands too"
    return (
        f"jobs come every {line.takt_s:g} s at the earliest, and the line moves {line.speed_m_per_s:.4g} m/s at once "
        "or not at all; workers do not get into each other's way, walk straight to the next job, and whoever comes "
        "from elsewhere is at the beginning of a stretch first"
    )
