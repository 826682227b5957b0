"""Paced lines made at random, of either kind, with whatever a station of one may have; times tie: whole seconds."""

from __future__ import annotations

from random import Random


def line_scenario(seed: int) -> dict:
    """A made scenario of one line, with a station before it and one after it or neither."""
    pick = Random(seed)
    n, kind = pick.randint(1, 4), pick.choice(["indexed", "moving"])
    names = [f"s{i}" for i in range(n)]
    tasks: dict = {"hand": {"fixed": "6 s"}, "run": {"fixed": f"{pick.randint(5, 30)} s", "automatic": True}}
    tasks["slow"] = {"fixed": "40 s", "automatic": True}
    stations: dict = {}
    tools: dict = {}
    for name in names:
        tasks[f"t{name}"] = {"fixed": f"{pick.randint(8, 34)} s", **_hands(pick, tools)}
        stations[name] = {"at": pick.choice(["a", "b"]), "tasks": _tasks(pick, name), **_troubles(pick)}
    line = {"kind": kind, "stations": names, "takt": "30 s", "unfinished": pick.choice(["stop", "send_on"])}
    if kind == "moving":
        line |= {
            "length": "3 m",
            "drift": f"{pick.choice([0, 0, 1, 4])} m",
            "upstream": f"{pick.choice([0, 0, 1, 3])} m",
        }
    workers = {f"w{i}": _worker(pick, names) for i in range(pick.randint(1, 4))}
    workers |= {name: {"skills": dict.fromkeys(names, 1.0)} for name in ("every", "other")}
    if pick.random() < 0.6:
        workers["joker"] = {"skills": dict.fromkeys(names, pick.choice([0.5, 1.0, 2.0])), **_shift(pick)}
        does = pick.choice(["help", "take_over"])
        line["andon"] = {"workers": ["joker"], "at": f"{pick.randint(0, 29)} s", "does": does}
    if pick.random() < 0.35:  # nobody is there in a break
        workers = {name: {**worker, "shift": "early"} for name, worker in workers.items()}
    route = list(names)
    if pick.random() < 0.4:
        stations["before"] = {"at": "a", "tasks": ["run"], "buffer": pick.choice([0, 2])}
        route.insert(0, "before")
    if pick.random() < 0.5:
        stations["after"] = {"at": "b", "tasks": [pick.choice(["run", "slow"])], "buffer": pick.choice([0, 1])}
        route.append("after")
    products: dict = {"x": {"route": route, "lot": pick.choice([1, 1, 2])}, "y": {"route": route, "priority": 1}}
    sources: dict = {"in": {"kind": "saturated", "sequence": pick.choice([["x"], ["x", "y"]])}}
    if pick.random() < 0.4:
        sources["in"] = {"kind": "poisson", "every": f"{pick.randint(20, 60)} s", "products": {"x": 0.5, "y": 0.5}}
    made = {
        **{"opsim": 1, "name": "line", "run": {"start": "Mon 06:00", "horizon": "1800 s", "seed": seed}},
        **{"layout": {"places": {"a": ["0 m", "0 m"], "b": ["3 m", "0 m"]}}, "tasks": tasks, "stations": stations},
        **{
            "products": products,
            "sources": sources,
            "workers": workers,
            "lines": {"line": line},
            "shifts": _shifts(pick),
        },
        "allocation": {"when_blocked": pick.choice(["free", "held"]), "idle": pick.choice(["stay", "home"])},
    }
    if pick.random() < 0.3:
        _assembly(pick, made, names)
    if tools:
        made["tools"] = tools
    if pick.random() < 0.3:
        made["cards"] = {"conwip": {"n": pick.randint(1, 5), "products": ["x", "y"]}}
    return made


def _hands(pick: Random, tools: dict) -> dict:
    """How a task is done by hand: alone, several times, with a tool, by two, or by the station's time."""
    way = pick.randrange(7)
    if way == 1:
        tools["gun"] = {"n": 1}
        return {"needs": {"gun": 1}}
    return {2: {"repeat": 2}, 3: {"team": 2}, 4: {"automatic": "attended"}, 5: {"per": "lot"}}.get(way, {})


def _tasks(pick: Random, name: str) -> list[str]:
    return pick.choice([[f"t{name}"], [f"t{name}"], [f"t{name}", "hand"], ["run"], [], ["hand", "run", f"t{name}"]])


def _troubles(pick: Random) -> dict:
    """What may happen at a station."""
    jam = {"every": {"fixed": "200 s"}, "by": pick.choice(["clock", "busy"]), "repair": {"fixed": "25 s"}}
    jam["job"] = pick.choice(["resume", "restart", "scrap"])
    return pick.choice(
        [
            *3 * [{}],
            {"breakdowns": {"jam": jam}},
            {
                "maintenance": {
                    "oil": {"every": "300 s", "lasts": "40 s", "when": pick.choice(["at_once", "after_job"])}
                }
            },
            {"yield": 0.7, "inspect": {"finds": 0.9, "then": "scrap"}},
            {"setup": {"otherwise": "5 s", "by": "product"}},
            {"shift": "open", "at_close": pick.choice(["finish", "resume"])},
            {"scrap": 0.2},
        ]
    )


def _worker(pick: Random, names: list[str]) -> dict:
    skills = {name: pick.choice([0.8, 1.0, 1.5]) for name in pick.sample(names, pick.randint(1, len(names)))}
    return {"skills": skills, "walk": pick.choice(["0.5 m/s", "1 m/s", "2 m/s"]), **_shift(pick)}


def _shift(pick: Random) -> dict:
    return pick.choice([{}, {"shift": "early"}, {"shift": "early"}, {"shift": "late"}])


def _shifts(pick: Random) -> dict:
    rules = ["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"]
    rule = {"at_break": pick.choice(rules), "at_end": pick.choice(rules)}
    pause = {"coffee": {"at": "06:08", "lasts": "3 min", **pick.choice([{}, {"place": "b"}])}}
    return {
        "early": {
            "from": "06:00",
            "to": "06:20",
            "breaks": pause,
            **rule,
            **pick.choice([{}, {"overtime": {"most": "4 min"}}]),
        },
        "late": {"from": "06:05", "to": "06:28", **rule},
        "open": {"from": "06:00", "to": "06:12"},
        "again": {"from": "06:15", "to": "06:30"},
    }


def _assembly(pick: Random, made: dict, names: list[str]) -> None:
    """Parts that go in at a station, and come now and then."""
    made["stores"] = {"shelf": {"at": "a", "initial": {"p": 3}}}
    made["stations"]["cut"] = {"at": "a", "tasks": ["run"]}
    made["products"]["p"] = {"route": ["cut", "shelf"]}
    made["products"]["x"]["parts"] = {pick.choice(names): {"p": 1}}
    made["sources"]["parts"] = {"kind": "poisson", "every": f"{pick.randint(20, 60)} s", "products": ["p"]}
