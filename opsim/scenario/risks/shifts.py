"""Shifts that change nothing: nobody works in them, or what they say of people is followed by none."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.clock import on_the_clock
from opsim.names import natural_key
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario, Shift


def shift_risks(scenario: Scenario) -> Iterator[str]:
    """Shifts without use, and breaks of shifts that no person follows."""
    people = _followed(scenario.workers.values())
    sources = [*scenario.sources.values(), *([] if scenario.release is None else [scenario.release])]
    things = _followed([*scenario.stations.values(), *sources])
    idle = sorted(set(scenario.shifts) - people - things, key=natural_key)
    if idle:
        it = "it" if len(idle) == 1 else "them"
        yield f"shift {listed(idle)}: nobody works in {it}, and nothing is open by {it}"
    for name in sorted(people | things, key=natural_key):
        shift = scenario.shifts[name]
        if shift.start_s == shift.end_s:
            yield f"shift {name}: it ends when it begins ({on_the_clock(shift.start_s)}), which is 24 h later"
    for name in sorted(things - people, key=natural_key):
        said = _of_people(scenario.shifts[name])
        if said:
            hint = "a station closes over noon where it has two shifts, before and after"
            yield f"shift {name}: its {listed(said)} are for people, and no worker follows it; {hint}"


def _followed(blocks) -> set[str]:
    return {name for block in blocks for name in block.shift or ()}


def _of_people(shift: Shift) -> list[str]:
    """What a shift says that is of people alone."""
    return [key for key in ("breaks", "meetings") if getattr(shift, key)]
