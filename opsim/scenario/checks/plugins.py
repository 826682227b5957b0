"""Plug-ins that a scenario names: they are installed, can be used, and take what is said to them."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.engine.rules import ALLOCATION_RULES
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.positions import Node, child, entries, problem, text


def plugin_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with tasks that say ``plugin`` and with an allocation rule that is none of ours."""
    for name, task in entries(tree, "tasks").items():
        if text(task, "plugin"):
            yield from _emulator(task, ("tasks", name))
    rule = child(tree, "allocation", "rule")
    if rule is not None and isinstance(rule.value, str) and rule.value not in ALLOCATION_RULES:
        yield from _rule(rule)


def _emulator(task: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    from opsim.plugins import plugin_problems as problems_of

    said = child(task, "with")
    values = said.plain() if said is not None and isinstance(said.value, dict) else {}
    for key, message, hint in problems_of(text(task, "plugin") or "", values):
        node, where = child(said, key), (*path, "with", key)
        if node is None:
            node, where = task.value["plugin"], (*path, "plugin")
        yield problem(node.place, where, message, hint)


def _rule(rule: Node) -> Iterator[Problem]:
    from opsim.plugins import NoSuchPlugin, PluginError, dispatch_rule, plugins

    try:
        dispatch_rule(rule.value)
    except NoSuchPlugin:
        hint = did_you_mean(rule.value, {*ALLOCATION_RULES, *plugins("opsim.dispatch")}, otherwise="known rules")
        yield problem(rule.place, ("allocation", "rule"), f"no rule {shown(rule.value)}", hint)
    except PluginError as error:
        yield problem(rule.place, ("allocation", "rule"), str(error))
