"""Breaks and meetings: each within its shift and on its days, no two at once, and time left to work."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.clock import on_the_clock
from opsim.problems import Problem, shown
from opsim.scenario.positions import Node, Part, child, problem
from opsim.scenario.schema.shifts import Pause, Shift

Path = tuple[Part, ...]
Found = tuple[Path, Pause, Node]
"""Where a pause stands, what it says, and its node."""


def pause_problems(node: Node, shift: Shift, path: Path) -> Iterator[Problem]:
    """What is wrong with the breaks and meetings of one shift."""
    pauses = list(_pauses(node, shift, path))
    within = []
    for one in pauses:
        mistakes = list(_outside(one, shift))
        yield from mistakes
        yield from _other_days(one, shift)
        if not mistakes:
            within.append(one)
    overlaps = list(_overlaps(within, shift))
    yield from overlaps
    if not overlaps:
        yield from _nothing_left(within, shift, node, path)


def _pauses(node: Node, shift: Shift, path: Path) -> Iterator[Found]:
    for kind, named in (("breaks", shift.breaks), ("meetings", shift.meetings)):
        for name, pause in named.items():
            found = child(node, kind, name)
            if found is not None:
                yield (*path, kind, name), pause, found


def _outside(one: Found, shift: Shift) -> Iterator[Problem]:
    path, pause, node = one
    hours = f"{on_the_clock(shift.start_s)} to {on_the_clock(shift.end_s)}"
    offset_s = shift.offset_s(pause)
    if pause.lasts_s > shift.length_s:
        found = f"lasts {pause.lasts_s / 60:g} min, and the whole shift {shift.length_s / 60:g} min"
        yield problem(_at(node, "lasts"), (*path, "lasts"), found, "make it shorter")
    elif offset_s >= shift.length_s:
        found = f"{on_the_clock(pause.at_s)} is outside the shift, {hours}"
        yield problem(_at(node, "at"), (*path, "at"), found, f"give a time from {on_the_clock(shift.start_s)} on")
    elif offset_s + pause.lasts_s > shift.length_s:
        found = f"goes on until {on_the_clock(pause.at_s + pause.lasts_s)}, beyond the shift, {hours}"
        last = on_the_clock(shift.end_s - pause.lasts_s)
        yield problem(_at(node, "at"), (*path, "at"), found, f"begin it at {last} or before, or make it shorter")


def _other_days(one: Found, shift: Shift) -> Iterator[Problem]:
    path, pause, node = one
    beyond = [day for day in pause.days or () if day not in shift.days]
    if beyond:
        found = f"the shift does not begin on {' or '.join(beyond)}"
        hint = f"days of this shift: {', '.join(shift.days)}"
        yield problem(_at(node, "days"), (*path, "days"), found, hint)


def _overlaps(pauses: list[Found], shift: Shift) -> Iterator[Problem]:
    """Pauses that begin, on one of their days, before another one is over; each is told of one."""
    in_order = sorted(pauses, key=lambda one: (shift.offset_s(one[1]), one[0]))
    for number, (path, pause, node) in enumerate(in_order):
        for before, other, _ in in_order[:number]:
            ends_s = shift.offset_s(other) + other.lasts_s
            if ends_s > shift.offset_s(pause) and set(pause.days or shift.days) & set(other.days or shift.days):
                found = f"begins before {before[-1]} is over, at {on_the_clock(shift.start_s + ends_s)}"
                yield problem(_at(node, "at"), (*path, "at"), found, "nobody is in two places at once")
                break


def _nothing_left(pauses: list[Found], shift: Shift, node: Node, path: Path) -> Iterator[Problem]:
    for day in shift.days:
        total_s = sum(pause.lasts_s for _, pause, _ in pauses if day in (pause.days or shift.days))
        if total_s >= shift.length_s:
            found = f"breaks and meetings take all of the shift ({total_s / 60:g} min on {day})"
            first = child(node, "breaks") or child(node, "meetings") or node
            yield problem(first.name_place, (*path, "breaks"), found, f"make {shown('lasts')} shorter")
            return


def _at(node: Node, key: str):
    found = child(node, key)
    return node.name_place if found is None else found.place
