"""Teams that can come together: enough people with the skill, and none of them on a round."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import visited
from opsim.scenario.positions import Node, child, entries, items, problem, text


def team_problems(tree: Node) -> Iterator[Problem]:
    """Tasks for more workers than have the skill, and teams of people who serve only where they stand."""
    patrols, on_a_way = text(tree, "allocation", "idle") == "patrol", visited(tree)
    for name, station in entries(tree, "stations").items():
        team = _team(tree, station) if name in on_a_way else None
        if team is None:
            continue
        task, wanted = team
        able = [worker for worker, node in entries(tree, "workers").items() if name in entries(node, "skills")]
        if 0 < len(able) < wanted:  # nobody at all is told of elsewhere
            found = (
                f"task {shown(task)} takes a team of {wanted}, and only {len(able)} of the workers can work at {name}"
            )
            yield problem(
                station.name_place, ("stations", name), found, "give more workers the skill, or a smaller team"
            )
        if patrols:
            found = (
                f"task {shown(task)} takes a team, and workers who patrol serve each only the station where he stands"
            )
            yield problem(station.name_place, ("stations", name), found, "write 'idle: stay' or 'idle: home'")


def _team(tree: Node, station: Node) -> tuple[str, int] | None:
    """The task of a station for most workers, and how many; None where one is enough everywhere."""
    teams = []
    for node in items(station, "tasks"):
        size = child(tree, "tasks", node.value, "team") if isinstance(node.value, str) else None
        if size is not None and type(size.value) is int and size.value > 1:
            teams.append((node.value, size.value))
    return max(teams, key=lambda team: team[1], default=None)
