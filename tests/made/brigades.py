"""Random crews: lines of all widths, with arrivals, breaks, breakdowns, carried jobs and jobs that skip stations."""

from __future__ import annotations

import json

from choices import Lots

RULES = ("finish", "finish_job", "resume", "resume_any", "hand_over", "restart")


def scenario(seed: int) -> str:
    """One scenario as text; the same seed gives the same one."""
    pick = Lots(seed)
    n = pick.whole(2, 5)
    steps, people = [f"s{i}" for i in range(n)], [f"w{i}" for i in range(pick.whole(1, 4))]
    stations = {name: _station(pick, number, n) for number, name in enumerate(steps)}
    workers = {name: _worker(pick, steps) for name in people}
    some = [name for name in steps if pick.whole(0, 1)] or steps[:1]
    products = {"p": {"route": steps, "share": 0.6}, "q": {"route": some, "share": 0.4}}
    if pick.whole(0, 2) == 0:
        for product in products.values():
            product["carried"] = True
    made = {
        "opsim": 1,
        "name": "crew",
        "run": {"horizon": "40 min", "seed": seed},
        "layout": {"places": _places(pick, n)},
        "tasks": {f"t{i}": _task(pick) for i in range(n)},
        "stations": stations,
        "products": products,
        "release": pick.one_of([{"kind": "saturated"}, {"kind": "poisson", "every": f"{pick.whole(20, 60)} s"}]),
        "workers": {**workers, "other": {"skills": dict.fromkeys(steps, 1.0)}},
        "allocation": {"when_blocked": pick.one_of(["free", "held"]), "idle": pick.one_of(["stay", "home"])},
        "crews": {"crew": {"kind": pick.one_of(["bucket_brigade", "rabbit_chase"]), "stations": steps}},
    }
    made["crews"]["crew"]["workers"] = list(pick.shuffled(people))
    if pick.whole(0, 1):
        breaks = {"rest": {"at": "06:10", "lasts": f"{pick.whole(1, 5)} min"}}
        made["shifts"] = {"early": {"from": "06:00", "to": "14:00", "breaks": breaks, "at_break": pick.one_of(RULES)}}
        for name in people[1:]:
            workers[name]["shift"] = "early"
    if pick.whole(0, 4) == 0:
        made["cards"] = {"conwip": {"n": pick.whole(1, 6)}}
    return json.dumps(made)


def _places(pick: Lots, n: int) -> dict:
    at_m, places = 0, {}
    for number in range(n):
        places[f"p{number}"] = [f"{at_m} m", "0 m"]
        at_m += pick.one_of([0, 1, 2, 5])
    return places


def _task(pick: Lots) -> dict:
    mean_s = f"{pick.whole(3, 20)} s"
    task = pick.one_of([{"fixed": mean_s}, {"dist": "lognormal", "mean": mean_s, "cv": 0.4}])
    return task | pick.one_of(
        [{}, {}, {}, {"repeat": 2}, {"automatic": True}, {"automatic": "attended"}, {"interruption": "finish"}]
    )


def _station(pick: Lots, number: int, n: int) -> dict:
    tasks = [f"t{number}"] + ([f"t{pick.whole(0, n - 1)}"] if pick.whole(0, 2) == 0 else [])
    servers, buffer = pick.one_of([1, 1, 1, 2, 3]), pick.one_of([0, 0, 0, 1, 2])
    station = {"at": f"p{number}", "tasks": tasks, "servers": servers, "buffer": buffer}
    jam = {"every": {"fixed": f"{pick.whole(60, 200)} s"}, "repair": {"fixed": f"{pick.whole(5, 30)} s"}}
    jam["job"] = pick.one_of(["resume", "restart", "scrap"])
    oil = {"every": "100 s", "lasts": "10 s", "when": pick.one_of(["after_job", "at_once"])}
    more = [{}, {}, {}, {}, {"breakdowns": {"jam": jam}}, {"maintenance": {"oil": oil}}, {"blocking": "before"}]
    return station | pick.one_of([*more, {"buffer_after": 1}])


def _worker(pick: Lots, steps: list[str]) -> dict:
    skills = {step: pick.one_of([0.7, 1.0, 1.3]) for step in steps}
    return {"walk": f"{pick.whole(1, 2)} m/s", "skills": skills}
