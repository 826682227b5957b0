"""Tools: how many of each there are, who needs them, and between which moments of a task one is held."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.plan.ranks import ranked

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


Needs = tuple[tuple[int, int], ...]
"""(rank of a tool, how many of it), in natural order of the tools."""


@dataclass(frozen=True, slots=True)
class ToolPlan:
    """Tools of one kind, n of them."""

    name: str
    n: int


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment of a performance: its ``mark``-th mark, or a share of its duration where mark is -1."""

    mark: int = -1
    share: float = 0.0


@dataclass(frozen=True, slots=True)
class HoldPlan:
    """The rank of a tool that is in the hands from one moment of each performance to another."""

    tool: int
    start: Moment
    end: Moment


def plan_tools(scenario: Scenario) -> tuple[ToolPlan, ...]:
    """Tools in natural order."""
    return tuple(ToolPlan(name, scenario.tools[name].n) for name in ranked(scenario.tools))


def needs_of(block, scenario: Scenario) -> Needs:
    """What a station or a task needs."""
    ranks = ranked(scenario.tools) if block.needs else {}
    return tuple(sorted((ranks[name], n) for name, n in block.needs.items()))


def hold_of(task, scenario: Scenario, model) -> HoldPlan | None:
    """What a task holds; its marks by the names that its model has for them. Raises ValueError for another name."""
    if task.hold is None:
        return None
    names = tuple(getattr(model, "mark_names", ()))
    moments = (moment_of(said, names) for said in (task.hold.start, task.hold.end))
    return HoldPlan(ranked(scenario.tools)[task.hold.tool], *moments)


def moment_of(said: float | str, names: tuple[str, ...]) -> Moment:
    """A moment by a share of a performance, or by the name of one of its marks. Raises ValueError for another name."""
    if isinstance(said, float):
        return Moment(share=said)
    if said not in names:
        raise ValueError(f"no mark {said!r}; the movement has: {', '.join(names) or 'none'}")
    return Moment(mark=names.index(said))
