"""Breaks and meetings: each within its shift and on its days, no two at once, and time left to work.

Shifts: those that are named exist, their breaks lie within them, and nobody is in two at once.

What is risky: shifts that change nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from opsim.clock import DAY_S, DAYS, WEEK_S, on_the_clock
from opsim.problems import Problem, did_you_mean, enumerated, natural_key, shown
from opsim.scenario.checks.lookup import block_read, named
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, TreePath, child, entries, items, problem
from opsim.subjects.shifts.words import Pause, Shift

Found = tuple[TreePath, Pause, Node]
"""Where a pause stands, what it says, and its node."""


def pause_problems(node: Node, shift: Shift, path: TreePath) -> Iterator[Problem]:
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


def _pauses(node: Node, shift: Shift, path: TreePath) -> Iterator[Found]:
    for kind, pauses in (("breaks", shift.breaks), ("meetings", shift.meetings)):
        for name, pause in pauses.items():
            found = child(node, kind, name)
            if found is not None:
                yield (*path, kind, name), pause, found


def _outside(one: Found, shift: Shift) -> Iterator[Problem]:
    path, pause, node = one
    hours = f"{on_the_clock(shift.start_s)} to {on_the_clock(shift.end_s)}"
    first, last = on_the_clock(shift.start_s), on_the_clock(shift.end_s - pause.lasts_s)
    offset_s = shift.offset_s(pause)
    if pause.lasts_s > shift.length_s:
        found = f"lasts {pause.lasts_s / 60:g} min, and the whole shift {shift.length_s / 60:g} min"
        yield problem(_at(node, "lasts"), (*path, "lasts"), found, "make it shorter")
    elif offset_s >= shift.length_s:
        found = f"{on_the_clock(pause.at_s)} is outside the shift, {hours}"
        yield problem(_at(node, "at"), (*path, "at"), found, f"begin it from {first} to {last}")
    elif offset_s + pause.lasts_s > shift.length_s:
        found = f"goes on until {on_the_clock(pause.at_s + pause.lasts_s)}, beyond the shift, {hours}"
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


def _nothing_left(pauses: list[Found], shift: Shift, node: Node, path: TreePath) -> Iterator[Problem]:
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


def shift_problems(tree: Node) -> Iterator[Problem]:
    """Shifts that do not exist, breaks outside their shift or at the same time, workers in two shifts at once."""
    nodes, places = entries(tree, "shifts"), entries(tree, "layout", "places")
    shifts = {name: shift for name, node in nodes.items() if (shift := block_read(Shift, node)) is not None}
    for owner, path in _owners(tree):
        yield from _unknown(owner, nodes, path)
    for name, node in nodes.items():
        for kind in ("breaks", "meetings"):
            for pause, said in entries(node, kind).items():
                yield from named(child(said, "place"), places, "place", ("shifts", name, kind, pause, "place"))
        if name in shifts:
            yield from pause_problems(node, shifts[name], ("shifts", name))
    for name, worker in entries(tree, "workers").items():
        yield from _in_two(worker, shifts, nodes, ("workers", name, "shift"))


def _owners(tree: Node) -> Iterator[tuple[Node, TreePath]]:
    """What may follow a shift, each with its path."""
    for section in ("workers", "stations", "sources"):
        for name, node in entries(tree, section).items():
            yield node, (section, name, "shift")
    release = child(tree, "release")
    if release is not None:
        yield release, ("release", "shift")


def _names(owner: Node) -> list[Node]:
    said = child(owner, "shift")
    return [] if said is None else [said] if isinstance(said.value, str) else items(said)


def _unknown(owner: Node, known: dict[str, Node], path: TreePath) -> Iterator[Problem]:
    several = isinstance(getattr(child(owner, "shift"), "value", None), list)
    for number, node in enumerate(_names(owner)):
        if isinstance(node.value, str) and node.value not in known:
            hint = did_you_mean(node.value, known, otherwise="known shifts")
            hint = hint or f"add a section 'shifts: {{{node.value}: {{from: 06:00, to: 14:00}}}}'"
            yield problem(node.place, (*path, number) if several else path, f"no shift {shown(node.value)}", hint)


def _in_two(worker: Node, shifts: dict[str, Shift], nodes: dict[str, Node], path: TreePath) -> Iterator[Problem]:
    """The first time in his weeks that a worker's next shift begins before the last one, or its overtime, is over."""
    named_here = _names(worker)
    names = [node.value for node in named_here]
    if not names or not all(isinstance(name, str) and name in shifts for name in names):
        return
    for (start_s, name), (next_s, other) in pairwise(_begins([*names, names[0]], shifts)):
        shift, end_s = shifts[name], start_s + shifts[name].length_s
        if end_s > next_s:
            found = f"{name} ends {_when(end_s)}, and {other} begins {_when(next_s)} already"
            yield problem(child(worker, "shift").place, path, found, "nobody works two shifts at once")  # type: ignore[union-attr]
            return
        if shift.overtime is not None and end_s + shift.overtime.most_s > next_s:
            place = child(nodes[name], "overtime", "most")
            found = (
                f"overtime may last until {_when(end_s + shift.overtime.most_s)}, and {other} begins {_when(next_s)}"
            )
            where = ("shifts", name, "overtime", "most")
            yield problem((place or nodes[name]).place, where, found, f"at most {(next_s - end_s) / 3600:g} h are left")
            return


def _begins(names: list[str], shifts: dict[str, Shift]) -> Iterator[tuple[float, str]]:
    """(start_s, name) of each shift, in seconds from Monday 00:00 of the first week, in order of time."""
    for week, name in enumerate(names):
        for day in shifts[name].days:
            yield week * WEEK_S + DAYS.index(day) * DAY_S + shifts[name].start_s, name


def _when(time_s: float) -> str:
    return f"{DAYS[int(time_s // DAY_S) % 7]} {on_the_clock(time_s)}"


def shift_risks(scenario: Scenario) -> Iterator[str]:
    """Shifts without use, and breaks of shifts that no person follows."""
    people = _followed(scenario.workers.values())
    sources = [*scenario.sources.values(), *([] if scenario.release is None else [scenario.release])]
    things = _followed([*scenario.stations.values(), *sources])
    idle = sorted(set(scenario.shifts) - people - things, key=natural_key)
    if idle:
        it = "it" if len(idle) == 1 else "them"
        yield f"shift {enumerated(idle)}: nobody works in {it}, and nothing is open by {it}"
    for name in sorted(people | things, key=natural_key):
        shift = scenario.shifts[name]
        if shift.start_s == shift.end_s:
            yield f"shift {name}: it ends when it begins ({on_the_clock(shift.start_s)}), which is 24 h later"
    for name in sorted(things - people, key=natural_key):
        said = _of_people(scenario.shifts[name])
        if said:
            hint = "a station closes over noon where it has two shifts, before and after"
            yield f"shift {name}: its {enumerated(said)} are for people, and no worker follows it; {hint}"


def _followed(blocks) -> set[str]:
    return {name for block in blocks for name in block.shift or ()}


def _of_people(shift: Shift) -> list[str]:
    """What a shift says that is of people alone."""
    return [key for key in ("breaks", "meetings") if getattr(shift, key)]
