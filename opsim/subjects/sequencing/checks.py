"""Mistakes of rules (dispatch, routing, pre-emption) and of set-ups.

What the assumption sheet says of queues and set-ups.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from opsim.engine.rules import BY_DUE_DATE, ROUTING_RULES, SEQUENCING_RULES
from opsim.plan import Plan
from opsim.problems import Assumption, Problem, did_you_mean, listed, shown
from opsim.scenario.checks.lookup import stations_of
from opsim.scenario.tree import Node, Part, Place, child, entries, problem, text
from opsim.subjects.sequencing.plan import FIFO, FINISH_FIRST
from opsim.subjects.stations.checks import batch_before_problems


def sequence_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with ``flow``, and with dispatch, preempt and setup of stations."""
    stations = entries(tree, "stations")
    asked: dict[tuple[Part, ...], Node | None] = {("flow", "dispatch"): child(tree, "flow", "dispatch")}
    asked |= {("stations", name, "dispatch"): child(station, "dispatch") for name, station in stations.items()}
    for path, rule in asked.items():
        yield from rule_problems(rule, path, "opsim.sequencing", SEQUENCING_RULES)
        if rule is not None and rule.value in BY_DUE_DATE and not _has_due_dates(tree):
            hint = "give a product one, such as 'due: 4 h', or a schedule with a column due"
            yield problem(rule.place, path, f"{rule.value} goes by due dates, and no job has one", hint)
    yield from rule_problems(child(tree, "flow", "routing"), ("flow", "routing"), "opsim.routing", ROUTING_RULES)
    for name, station in stations.items():
        yield from _preempt(station, ("stations", name))
        yield from batch_before_problems(tree, station, ("stations", name))
        yield from _setup(tree, name, child(station, "setup"))


def setup_times(station: Node) -> list[Node]:
    """What a station's set-ups take: times, and names of tasks."""
    times = [time for row in entries(station, "setup", "times").values() for time in entries(row).values()]
    otherwise = child(station, "setup", "otherwise")
    return times if otherwise is None else [*times, otherwise]


def rule_problems(rule: Node | None, path: tuple[Part, ...], group: str, ours: dict) -> Iterator[Problem]:
    """A rule that is none of ours, and no plug-in that can be used."""
    if rule is None or not isinstance(rule.value, str) or rule.value in ours:
        return
    from opsim.plugins import NoSuchPlugin, PluginError, plugins, rule_of

    try:
        rule_of(group, rule.value)
    except NoSuchPlugin:
        hint = did_you_mean(rule.value, {*ours, *plugins(group)}, otherwise="known rules")
        yield problem(rule.place, path, f"no rule {shown(rule.value)}", hint)
    except PluginError as error:
        yield problem(rule.place, path, str(error))


def _has_due_dates(tree: Node) -> bool:
    sources = [child(tree, "release"), *entries(tree, "sources").values()]
    by_schedule = any(text(source, "kind") == "schedule" for source in sources)
    return by_schedule or any(child(product, "due") is not None for product in entries(tree, "products").values())


def _preempt(station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    preempt, buffer = child(station, "preempt"), child(station, "buffer")
    if preempt is None:
        return
    if buffer is not None and buffer.value == 0 and not isinstance(buffer.value, bool):
        found = "nothing is ever pre-empted where no job can wait: it would have no place to go"
        yield problem(preempt.place, (*path, "preempt"), found, "give the station a buffer, or remove 'preempt'")
    if child(station, "batch") is not None:
        found = "the jobs of a batch are not pre-empted"
        yield problem(preempt.place, (*path, "preempt"), found, "remove 'preempt', or 'batch'")


def _setup(tree: Node, name: str, setup: Node | None) -> Iterator[Problem]:
    if setup is None or not entries(setup):
        return
    path = ("stations", name, "setup")
    families = text(setup, "by") == "family"
    known, here = _classes(tree, families, None), _classes(tree, families, name)
    named = list(_named(setup, path))
    for word, node, where in named:
        if word not in known:
            what = "family" if families else "product"
            yield problem(node, where, f"no {what} {shown(word)}", did_you_mean(word, known))
    for last, row in entries(setup, "times").items():
        for new, time in entries(row).items():
            yield from _task(tree, time, (*path, "times", last, new))
    yield from _task(tree, child(setup, "otherwise"), (*path, "otherwise"))
    if child(setup, "otherwise") is None and all(word in known for word, _, _ in named):
        yield from _gaps(setup, here, path)


def _named(setup: Node, path: tuple[str, ...]) -> Iterator[tuple[str, Place, tuple[str, ...]]]:
    """Products or families that a set-up names, each with its place and path."""
    first = child(setup, "first")
    if first is not None and isinstance(first.value, str):
        yield first.value, first.place, (*path, "first")
    for last, row in entries(setup, "times").items():
        yield last, row.name_place, (*path, "times", last)
        for new, time in entries(row).items():
            yield new, time.name_place, (*path, "times", last, new)


def _gaps(setup: Node, here: list[str], path: tuple[str, ...]) -> Iterator[Problem]:
    """Changes that happen here and that nothing is said of."""
    times, first = entries(setup, "times"), text(setup, "first")
    gaps = [
        (a, b)
        for a in dict.fromkeys([*here, first or here[0]] if here else [])
        for b in here
        if a != b and b not in entries(times.get(a))
    ]
    if gaps:
        last, new = gaps[0]
        more = f" (and of {len(gaps) - 1} other changes)" if len(gaps) > 1 else ""
        found = f"nothing says how long the set-up from {shown(last)} to {shown(new)} takes{more}"
        yield problem(setup.name_place, path, found, "add it to times, or e.g. 'otherwise: 10 min'")


def _task(tree: Node, time: Node | None, path: tuple[Part, ...]) -> Iterator[Problem]:
    """The name of a task that does not exist; what begins with a digit is a time."""
    if time is None or not isinstance(time.value, str) or not time.value[:1].isalpha():
        return
    tasks = entries(tree, "tasks")
    if time.value not in tasks:
        hint = did_you_mean(time.value, tasks, otherwise="a time such as 5 min, or one of the tasks")
        yield problem(time.place, path, f"no task {shown(time.value)}", hint)


def _classes(tree: Node, families: bool, station: str | None) -> list[str]:
    """What set-ups tell apart, of all products or of those that come to a station: products, or their families."""
    found = {
        (text(product, "family") if families else None) or name: None
        for name, product in entries(tree, "products").items()
        if station is None or station in stations_of(product)
    }
    return list(found)


def assumed_setups(plan: Plan) -> Iterator[Assumption]:
    if plan.setups:
        alone = [plan.stations[one.station].name for one in plan.setups if not one.attended]
        who = f"; at {listed(alone)} without a worker" if alone else ""
        where = listed([plan.stations[one.station].name for one in plan.setups])
        yield (
            "set-ups",
            f"{where}: a server is set up when its next job is on it, not before, and stays so{who}",
        )


def assumed_queues(plan: Plan) -> Iterator[Assumption]:
    for rule in dict.fromkeys(queue.rule for queue in plan.queues if queue.rule != FIFO):
        where = listed([plan.stations[queue.station].name for queue in plan.queues if queue.rule == rule])
        yield "sequence", f"{where}: waiting jobs go by {rule.replace('_', ' ')}, higher priorities before it"
    for queue in plan.queues:
        name = plan.stations[queue.station].name
        if queue.preempt != FINISH_FIRST:
            then = "goes on where it was" if queue.preempt == "resume" else "begins its task anew"
            yield "sequence", f"{name}: a job of higher priority takes the server of a lower one, which {then} later"
    if plan.queues and all(queue.rule == FIFO for queue in plan.queues):
        yield "sequence", "higher priorities first, and first come, first served among equals"
    due = [product.name for product in plan.products if product.due_s < inf]
    if due:
        yield "sequence", f"{listed(due)}: due so long after they come in; a job that is late is made all the same"
    dated = [source.name for source in plan.sources if any(order.due_s < inf for order in source.orders)]
    if dated:
        instead = ", whatever their product's own due date" if due else ""
        yield "sequence", f"{listed(dated)}: orders are due when their file says, counted from the start{instead}"
