"""Who works where on made floors: rules of assignment, crews, lines that move together, rotation."""

from __future__ import annotations

from collections.abc import Callable

from made_floors import Floor


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
    steps = _plain_way(floor, "h")
    a, b = steps[:2]
    floor["stations"][a]["tasks"] = ["m", *floor["stations"][a]["tasks"][-1:]]
    if floor["stations"][a]["tasks"] == ["m", "m"]:
        floor["stations"][a]["tasks"] = [a.replace("s", "t"), "m"]
    shared = floor["stations"][a]["tasks"][1:]
    floor["stations"][a]["share"] = {"tasks": shared, "with": b, "when": floor.pick.one_of(["half_full", "full"])}


def brigade(floor: Floor) -> None:
    _crew(floor, "bucket_brigade")


def rabbits(floor: Floor) -> None:
    _crew(floor, "rabbit_chase")


def _crew(floor: Floor, kind: str) -> None:
    steps = _plain_way(floor, kind[0])
    names = [f"{kind[:2]}{n}" for n in range(floor.pick.whole(2, 3))]
    _more_workers(floor, names, steps)
    floor["crews"][kind] = {"kind": kind, "stations": steps, "workers": names}


ODD = {"batch", "preempt", "share", "inspect"}
"""Keys of stations at which jobs are not passed on one by one, in their order."""


def _plain_way(floor: Floor, letter: str) -> list[str]:
    """The way of the only main product where it is plain and nobody goes by it yet, else a way of its own."""
    steps, products = _steps(floor), floor["products"]
    stations = [floor["stations"][step] for step in steps]
    odd = ODD & {key for station in stations for key in station}
    teams = any("team" in floor["tasks"][task] for station in stations for task in station["tasks"])
    whole = all(product.get("route", []) == steps for product in products.values())
    if len(products) > 1 or len(steps) < 2 or not whole or odd or teams or floor["crews"]:
        return _way_of_its_own(floor, letter)
    return steps


def _way_of_its_own(floor: Floor, letter: str, **keys) -> list[str]:
    """Two or three stations with a product and a source of their own."""
    pick = floor.pick
    stations = [f"{letter}{n}" for n in range(pick.whole(2, 3))]
    for station in stations:
        floor["tasks"][f"t{station}"] = {"fixed": f"{pick.whole(6, 30)} s", "repeat": pick.whole(1, 2)}
        floor.add_station(station, tasks=[f"t{station}"], **keys)
    floor["products"][f"p{letter}"] = {"route": stations}
    kind = pick.one_of([{"kind": "saturated"}, {"kind": "poisson", "every": "30 s"}])
    floor["sources"][f"f{letter}"] = {**kind, "products": [f"p{letter}"]}
    return stations


def indexed_line(floor: Floor) -> None:
    _line(floor, {"kind": "indexed"})


def moving_line(floor: Floor) -> None:
    _line(
        floor,
        {"kind": "moving", "length": "4 m", **{key: f"{floor.pick.whole(0, 2)} m" for key in ("drift", "upstream")}},
    )


def _line(floor: Floor, line: dict) -> None:
    pick = floor.pick
    steps = _way_of_its_own(floor, line["kind"][0])
    floor["flow"].pop("blocking", None)
    for step in steps:
        del floor["stations"][step]["buffer"]
    andon = {"andon": {"workers": ["w0"], "at": f"{pick.whole(5, 14)} s", "does": pick.one_of(["take_over", "help"])}}
    unfinished = pick.one_of(["stop", "send_on"])
    floor["lines"][line["kind"]] = {
        **line,
        "stations": steps,
        "takt": f"{pick.whole(15, 40)} s",
        "unfinished": unfinished,
    }
    if pick.whole(0, 1):
        floor["lines"][line["kind"]].update(andon)


def rotation(floor: Floor) -> None:
    """Two workers change posts by the clock or by count; both have the skills of all posts."""
    posts = [[station] for station in floor.pick.shuffled(floor.stations)[:2]]
    _more_workers(floor, ["r0", "r1"], list(floor["stations"]))
    how = floor.pick.one_of([{"every": "4 min"}, {"after": 5}, {"every": "5 min", "rule": "least_time"}])
    floor["rotations"]["turns"] = {"workers": ["r0", "r1"], "posts": posts, **how}


def _more_workers(floor: Floor, names: list[str], stations: list[str]) -> None:
    """Workers with a shift who can work at some stations; nobody patrols then."""
    if floor["allocation"]["idle"] == "patrol":
        floor["allocation"]["idle"] = "stay"
        floor["allocation"].pop("serve", None)
        for worker in floor["workers"].values():
            del worker["patrol"]
    for name in names:
        floor.add_worker(name, everywhere=True)
        skills = {station: floor.pick.one_of([0.8, 1.0, 1.25]) for station in stations}
        floor["workers"][name].update(skills=skills, shift=floor.pick.one_of(list(floor["shifts"])))


def _steps(floor: Floor) -> list[str]:
    """Stations of a main product's route from its second step on, as far as each comes once and alone."""
    route = next((floor["products"][name]["route"] for name in floor.routed), [])
    return [step for step in route if isinstance(step, str) and step in floor.stations and route.count(step) == 1]


CREWS: dict[str, Callable[[Floor], None]] = {
    block.__name__: block
    for block in (
        *(choice_of_work, levels, zones, floaters, station_priorities, limited, work_sharing),
        *(brigade, rabbits, indexed_line, moving_line, rotation),
    )
}
"""By name, in the order in which they are put in."""
