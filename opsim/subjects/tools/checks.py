"""Tools that are needed exist, there are enough of them, and are held between moments that exist.

What the assumption sheet says of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from opsim.plan import Plan
from opsim.problems import Assumption, Problem, listed, shown
from opsim.scenario.checks.lookup import named, whole_number
from opsim.scenario.tree import Node, child, entries, items, problem, text
from opsim.subjects.tasks.checks import moment_problems


def tool_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Tools that are named and do not exist, wants that can never be met, and marks that no movement has."""
    tools = entries(tree, "tools")
    for section in ("stations", "tasks"):
        for name, block in entries(tree, section).items():
            for tool, number in entries(block, "needs").items():
                yield from named(Node(tool, number.name_place), tools, "tool", (section, name, "needs", tool))
    for name, task in entries(tree, "tasks").items():
        yield from named(child(task, "hold", "tool"), tools, "tool", ("tasks", name, "hold", "tool"))
        yield from moment_problems(tree, task, ("tasks", name, "hold"), folder)
    if tools:
        yield from _too_few(tree)
    yield from _set_ups(tree)


def _too_few(tree: Node) -> Iterator[Problem]:
    """A station where one job would need more of a tool than there are: it would wait for ever."""
    counts = {tool: whole_number(child(node, "n")) or 1 for tool, node in entries(tree, "tools").items()}
    there = {tool: n for tool, n in counts.items() if n > 0}  # the others are told of by the schema
    for name, station in entries(tree, "stations").items():
        for task, wanted in _wanted(tree, station):
            short = next((tool for tool in wanted if tool in there and wanted[tool] > there[tool]), None)
            if short is not None:
                who = f"a job at {name}" if task is None else f"a job at {name} in task {task}"
                found = f"{who} needs {wanted[short]} of {shown(short)}, and there {_are(there[short])}"
                hint = f"write 'tools: {{{short}: {{n: {wanted[short]}}}}}', or need fewer"
                yield problem(station.name_place, ("stations", name), found, hint)
                break


def _wanted(tree: Node, station: Node) -> Iterator[tuple[str | None, Counter[str]]]:
    """What one job has of each tool: at the station alone, and in each of its tasks besides."""
    always = _needs(station)
    yield None, always
    for node in items(station, "tasks"):
        task = child(tree, "tasks", node.value) if isinstance(node.value, str) else None
        if task is not None:
            held = text(task, "hold", "tool")
            yield node.value, always + _needs(task) + Counter([held] if held else [])


def _needs(block: Node) -> Counter[str]:
    return Counter({tool: whole_number(number) or 0 for tool, number in entries(block, "needs").items()})


def _are(n: int) -> str:
    return "is 1" if n == 1 else f"are {n}"


def _set_ups(tree: Node) -> Iterator[Problem]:
    """Set-ups that are tasks of a team, or with tools of their own."""
    for name, station in entries(tree, "stations").items():
        setup = child(station, "setup")
        times: list[tuple[tuple[str, ...], Node | None]] = [(("otherwise",), child(setup, "otherwise"))]
        for before, row in entries(setup, "times").items():
            times += [(("times", before, after), node) for after, node in entries(row).items()]
        for path, node in times:
            task = child(tree, "tasks", node.value) if node is not None and isinstance(node.value, str) else None
            key = next((key for key in ("team", "needs", "hold") if child(task, key) is not None), None)
            if key is not None and node is not None:
                found = f"{shown(node.value)} has {key!r}, and a set-up is done by one worker without tools of its own"
                hint = "let the station need the tools" if key != "team" else ""
                yield problem(node.place, ("stations", name, "setup", *path), found, hint)


def assumed_tools(plan: Plan) -> Iterator[Assumption]:
    if plan.tools:
        yield "tools", "a tool is where it is needed at once; jobs take all they need together, the first that can"
    if any(task.needs for task in plan.tasks):
        yield "tools", "tools of a task are taken as its worker sets out, and put back when the work is broken off"
    attended = [task.name for task in plan.tasks if task.attended]
    if attended:
        yield "stations", f"{listed(attended)}: takes the station's time, whoever attends it and whatever his skill"
    teams = [task.name for task in plan.tasks if task.team > 1]
    if teams:
        yield "teams", f"{listed(teams)}: nobody comes before all can, and the slowest ends it; each has his own time"
