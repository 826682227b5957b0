"""Who goes where first on made floors: rules of choice, zones, floaters, priorities, levels, shared work."""

from __future__ import annotations

from made.floors import Floor
from made.ways import plain_way


def choice_of_work(floor: Floor) -> None:
    """The two rules of choice that look at the way ahead and at skills."""
    floor["allocation"]["rule"] = floor.pick.one_of(["most_downstream", "best_skill"])
    for worker in floor["workers"].values():
        for station in worker["skills"]:
            worker["skills"][station] = floor.pick.one_of([0.5, 1.0, 1.25])


def zones(floor: Floor) -> None:
    """Everybody but the first has a zone, which comes before the rule."""
    for name, worker in floor["workers"].items():
        able = list(worker["skills"])
        if name != "w0" and able:
            worker["zone"] = list(floor.pick.shuffled(able))[: floor.pick.whole(1, len(able))]


def floaters(floor: Floor) -> None:
    floor["workers"][floor.pick.one_of(list(floor["workers"]))]["floater"] = True


def station_priorities(floor: Floor) -> None:
    for _ in range(2):
        floor.some_station["priority"] = floor.pick.whole(1, 3)
    floor["allocation"]["priorities"] = list(floor.pick.shuffled(["stations", "products"]))


def levels(floor: Floor) -> None:
    """Skills by name: a pace and a share of good work."""
    floor["skill_levels"].update(expert=1.25, learner={"pace": 0.8, "quality": 0.7})
    for worker in floor["workers"].values():
        for station in worker["skills"]:
            worker["skills"][station] = floor.pick.one_of(["expert", "learner", 1.0, {"pace": 1.0, "quality": 0.8}])


def limited(floor: Floor) -> None:
    """Patrolling workers serve one job a visit."""
    if "z0" in floor["workers"]:  # a team, which nobody on a round is part of
        return
    floor["allocation"].update(idle="patrol", serve="one")
    for worker in floor["workers"].values():
        worker["skills"] = worker["skills"] or {floor.stations[0]: 1.0}
        worker["patrol"] = list(floor.pick.shuffled(list(worker["skills"])))


def work_sharing(floor: Floor) -> None:
    """The last task of a station, which the next one may do."""
    steps = plain_way(floor, "h")
    a, b = steps[:2]
    floor["stations"][a]["tasks"] = ["m", *floor["stations"][a]["tasks"][-1:]]
    if floor["stations"][a]["tasks"] == ["m", "m"]:
        floor["stations"][a]["tasks"] = [a.replace("s", "t"), "m"]
    shared = floor["stations"][a]["tasks"][1:]
    floor["stations"][a]["share"] = {"tasks": shared, "with": b, "when": floor.pick.one_of(["half_full", "full"])}
