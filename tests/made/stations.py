"""Blocks of the language at stations and between them, each put into a made floor with keys drawn at random."""

from __future__ import annotations

from itertools import pairwise

from made.floors import PLACES, Floor

from opsim.engine.rules import SEQUENCING_RULES


def buffer_after(floor: Floor) -> None:
    for _ in range(floor.pick.whole(2, 3)):
        floor.some_station["buffer_after"] = floor.pick.whole(1, 3)


def blocking_before(floor: Floor) -> None:
    """Not where there are batches, whose jobs go on one by one."""
    if floor.pick.whole(0, 1):
        floor["flow"]["blocking"] = "before"
        for station in floor["stations"].values():
            if "batch" in station:
                station["blocking"] = "after"
    elif "batch" not in (station := floor.some_station):
        station["blocking"] = "before"


def queue_rule(floor: Floor) -> None:
    rule = floor.pick.one_of([*SEQUENCING_RULES][1:])
    station = floor.some_station
    station.update(dispatch=rule, buffer=max(3, station["buffer"]))
    for name in floor.mains:
        floor["products"][name]["due"] = f"{floor.pick.whole(20, 90)} s"


def priorities(floor: Floor) -> None:
    """One of two products goes first; half the time it takes servers from the other."""
    if len(floor.mains) == 2:
        floor["products"]["q0"]["priority"] = floor.pick.whole(1, 2)
        how = floor.pick.one_of([None, "resume", "restart"])
        if how is not None:
            alone = [station for station in floor.crossed if "batch" not in station]  # batches are not pre-empted
            station = floor.pick.one_of(alone) if alone else {"buffer": 0}
            station.update(preempt=how, buffer=max(1, station["buffer"]))


def setup(floor: Floor) -> None:
    pick = floor.pick
    if len(floor.mains) != 2:
        return
    times = {"q0": {"q1": f"{pick.whole(1, 4)} s"}}
    floor["tasks"]["change"] = {"fixed": "3 s"}
    more = pick.one_of([{"attended": True}, {"attended": False}, {"first": "q0"}, {"otherwise": "change"}])
    floor.pick.one_of(floor.crossed)["setup"] = {"times": times, "otherwise": "2 s", **more}


def fixtures(floor: Floor) -> None:
    """Tools of a station, from the server until the job leaves it."""
    floor["tools"]["fixture"] = {"n": floor.pick.one_of([1, 1, 2])}
    for _ in range(floor.pick.whole(2, 3)):
        floor.some_station["needs"] = {"fixture": 1}


def task_tools(floor: Floor) -> None:
    floor["tools"]["gun"] = {"n": floor.pick.one_of([1, 1, 2])}
    tasks = [name for name in floor["tasks"] if name != "change"]  # a set-up is done without tools
    for _ in range(floor.pick.whole(2, 3)):
        floor["tasks"][floor.pick.one_of(tasks)]["needs"] = {"gun": 1}


def breakdowns(floor: Floor) -> None:
    pick = floor.pick
    by = pick.one_of(["clock", "busy", "cycles"])
    every_s = f"{pick.whole(30, 90)} s"
    law = pick.one_of([{"dist": "exponential", "mean": every_s}, {"fixed": every_s}])
    if by == "cycles":
        law = pick.one_of(
            [pick.whole(4, 9), {"dist": "geometric", "mean": 8}, {"dist": "uniform", "low": 3, "high": 9}]
        )
    job = pick.one_of(["resume", "restart", "scrap"])
    jam = {"every": law, "by": by, "repair": {"fixed": f"{pick.whole(2, 9)} s"}, "job": job}
    floor.some_station["breakdowns"] = {"jam": jam | _team(floor)}


def maintenance(floor: Floor) -> None:
    pick = floor.pick
    when = pick.one_of(["after_job", "at_once"])
    oiling = {"every": f"{pick.whole(60, 120)} s", "first": "30 s", "lasts": f"{pick.whole(3, 9)} s", "when": when}
    floor.some_station["maintenance"] = {"oiling": oiling | _team(floor)}


def _team(floor: Floor) -> dict:
    if floor.pick.whole(0, 1):
        return {}
    floor["repair_teams"].setdefault("mechanics", {"n": floor.pick.whole(1, 2)})
    return {"team": "mechanics"}


def quality(floor: Floor) -> None:
    """A station that makes defects, and one further on that finds them: scrap, or rework at the first."""
    pick, name = floor.pick, next(iter(floor.routed), None)
    steps = [step for step in floor["products"].get(name, {}).get("route", []) if isinstance(step, str)]
    if len(set(steps)) < 2:
        return
    maker, finder = steps[0], steps[-1]
    floor["stations"][maker]["yield"] = pick.one_of([0.5, 0.8])
    back = maker if len(floor.mains) == 1 else floor.add_station("y0")  # of two products one may come there later only
    then = pick.one_of(["scrap", {"rework": back}, {"rework": back}])
    most = {} if then == "scrap" else {"most": pick.whole(1, 3)}
    floor["stations"][finder]["inspect"] = {"finds": 0.9, "false_alarms": 0.1, "then": then} | most
    if then != "scrap":
        for step in steps:
            floor["stations"][step]["buffer"] = 9


def teams(floor: Floor) -> None:
    """Two workers at one task: a second worker with all skills joins."""
    if floor["allocation"]["idle"] == "patrol":  # each then serves only the station where he stands
        floor["allocation"]["idle"] = "stay"
        for worker in floor["workers"].values():
            del worker["patrol"]
    if not floor["tasks"]["m"].get("automatic"):
        for name in ("z0", "z1"):
            floor.add_worker(name, everywhere=True)
            worker = floor["workers"][name]
            worker["skills"] = dict.fromkeys(floor["stations"], 1.0)
        floor["tasks"]["m"]["team"] = 2


def attended(floor: Floor) -> None:
    floor["tasks"][floor.pick.one_of([t for t in floor["tasks"] if t != "m"])]["automatic"] = "attended"


def conveyor(floor: Floor) -> None:
    """Between two steps of a product that are at different places."""
    route = next((floor["products"][name]["route"] for name in floor.routed), [])
    for number, pair in enumerate(pairwise(route)):
        if all(step in floor["stations"] for step in pair if isinstance(step, str)) and list not in map(type, pair):
            a, b = (floor["stations"][step]["at"] for step in pair)
            if a != b:
                how = floor.pick.one_of([True, False])
                belt = {"from": a, "to": b, "speed": "1 m/s", "pitch": "1 m", "accumulating": how}
                floor["conveyors"]["belt"] = belt
                route.insert(number + 1, "belt")
                return


def transporter(floor: Floor) -> None:
    pick, name = floor.pick, next(iter(floor.routed), None)
    steps = [step for step in floor["products"].get(name, {}).get("route", []) if step in floor.stations]
    legs = [[a, b] for a, b in pairwise(steps) if a != b]
    if legs:
        roads = pick.one_of([{}, {"roads": [list(PLACES)]}])
        truck = {"n": pick.whole(1, 2), "at": "p0", "speed": "2 m/s", "capacity": pick.whole(1, 3)}
        floor["transporters"]["truck"] = {**truck, "load": "1 s", "unload": "1 s", "legs": legs, **roads}


def carrying(floor: Floor) -> None:
    """Workers carry jobs on; what somebody could not lift would be refused."""
    if any("batch" in station for station in floor["stations"].values()):
        return  # nobody carries a batch
    for name in floor.mains:
        floor["products"][name].update(carried=True, mass="8 kg")
    floor["workers"]["w0"]["most_load"] = "15 kg"
