"""Random floors as plain values: stations, ways and people; ``made.blocks`` puts the other blocks of the language in.

Times are whole seconds, so that ties are real. ``text_of`` writes a floor as YAML, in any order of declaration.
"""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

FOLDER = Path(__file__).parents[1] / "opsim" / "engine" / "made"
"""Where the files are that made scenarios name: ``orders.csv`` (of the product q0) and ``mix.csv``."""
PLACES = {"p0": ["0 m", "0 m"], "p1": ["3 m", "0 m"], "p2": ["3 m", "4 m"]}


class Floor:
    """A floor under construction.

    scenario : the scenario as plain values; its products, stations and so on are dicts by name
    mains    : the products of the main source; their routes are lists of steps, or they have a routing
    """

    def __init__(self, pick):
        self.pick = pick
        n = pick.whole(2, 4)
        self.stations = [f"s{i}" for i in range(n)]
        self.mains = [f"q{i}" for i in range(pick.whole(1, 2))]
        self.scenario: dict = {
            "opsim": 1,
            "name": "random",
            "run": {"horizon": "1200 s", "warm_up": "20 s", "seed": 3},
            "layout": {"places": dict(PLACES)},
            "tasks": {"m": {"fixed": "2 s"}, **{f"t{i}": _task(pick) for i in range(n)}},
            "stations": {name: _station(pick, name) for name in self.stations},
            "products": {},
            "sources": {},
            "workers": {},
            "allocation": _allocation(pick),
        }
        self._add_products()
        for number in range(pick.whole(2, 4)):
            self.add_worker(f"w{number}", everywhere=number == 0)
        self.main: dict = _main(pick)

    def _add_products(self) -> None:
        """Ways in one order, most often: where jobs come back or cross, small buffers lock a floor soon."""
        pick = self.pick
        way, crossing = pick.one_of(["series", "series", "parallel", "again", "drawn"]), pick.whole(0, 4) == 0
        steps = pick.shuffled(self.stations)
        for name in self.mains:
            own = pick.shuffled(self.stations) if crossing else steps[pick.whole(0, 1) if len(steps) > 2 else 0 :]
            self.scenario["products"][name] = _way(list(own), way)
        for station in self.scenario["stations"].values():
            station["buffer"] = pick.whole(0, 9 if way == "drawn" or crossing else 3)

    def __getitem__(self, section: str) -> dict:
        """A section of the scenario, made where it is missing."""
        return self.scenario.setdefault(section, {})

    @property
    def routed(self) -> list[str]:
        """Main products with a route."""
        return [name for name in self.mains if "route" in self["products"][name]]

    @property
    def some_station(self) -> dict:
        return self["stations"][self.pick.one_of(self.stations)]

    @property
    def crossed(self) -> list[dict]:
        """Stations that all main products come by."""
        ways = [json.dumps(self["products"][name]) for name in self.mains]
        return [self["stations"][name] for name in self.stations if all(f'"{name}"' in way for way in ways)]

    def add_station(self, name: str, **keys) -> str:
        """A station more, with the task m, at which everybody can work."""
        self["stations"][name] = {"at": self.pick.one_of(list(PLACES)), "tasks": ["m"], "buffer": 3, **keys}
        for worker in self["workers"].values():
            worker["skills"][name] = 1.0
            if "patrol" in worker:
                worker["patrol"].append(name)
        return name

    def add_worker(self, name: str, everywhere: bool) -> None:
        pick = self.pick
        patrols = self.scenario["allocation"]["idle"] == "patrol"
        able = [s for i, s in enumerate(self.stations) if everywhere or (patrols and i == 0) or pick.whole(0, 1)]
        worker = {"walk": f"{pick.whole(1, 2)} m/s", "skills": dict.fromkeys(able, 1.0)}
        self["workers"][name] = worker | ({"patrol": list(pick.shuffled(able))} if patrols else {})

    @property
    def values(self) -> dict:
        """The whole scenario: a single source stands as ``release``, several as ``sources``."""
        sources, products = self.scenario["sources"], self["products"]
        whole = {key: value for key, value in self.scenario.items() if value != {}}
        if sources:
            said = {} if {"file", "sequence"} & set(self.main) else {"products": list(self.mains)}
            return whole | {"sources": {**sources, "main": {**self.main, **said}}}
        shares = {name: {**products[name], "share": 1 / len(self.mains)} for name in self.mains}
        return whole | {"release": self.main, "products": products | shares}


def text_of(values: dict, order: Random | None = None) -> str:
    """A scenario as YAML (JSON is), its keys in a random order where one is given; lists stay as they are."""
    return json.dumps(values if order is None else _shuffled(values, order), indent=1)


def _shuffled(value, order: Random):
    if not isinstance(value, dict):
        return value
    keys = order.sample(list(value), len(value))
    return {key: _shuffled(value[key], order) for key in keys}


def _task(pick) -> dict:
    task = {"fixed": f"{pick.whole(1, 3)} s", "repeat": pick.whole(1, 2)}
    return task | ({"automatic": True} if pick.whole(0, 2) == 0 else {})


def _station(pick, name: str) -> dict:
    own = name.replace("s", "t")
    tasks = pick.one_of([[own], ["m", own], [own, "m"]])
    return {"at": pick.one_of(list(PLACES)), "tasks": tasks, "servers": pick.whole(1, 2)}


def _allocation(pick) -> dict:
    return {
        "rule": pick.one_of(["longest_queue", "nearest", "oldest_job"]),
        "when_blocked": pick.one_of(["free", "free", "free", "free", "held"]),
        "idle": pick.one_of(["stay", "stay", "home", "patrol"]),
    }


def _main(pick) -> dict:
    return dict(
        pick.one_of(
            [
                {"kind": "saturated"},
                {"kind": "poisson", "every": "5 s"},
                {"kind": "poisson", "every": "5 s", "when_full": "lose"},
                {"kind": "renewal", "every": {"fixed": "6 s"}},
            ]
        )
    )


def _way(steps: list[str], way: str) -> dict:
    """A way through the stations: in series, the first two in parallel, one twice in a row, or drawn."""
    if way == "drawn":
        onward = [*steps[1:], "out"]
        return {"routing": {"start": steps[0], **{a: {steps[0]: 0.25, b: 0.75} for a, b in zip(steps, onward)}}}
    if way == "parallel" and len(steps) > 2:
        return {"route": [list(steps[:2]), *steps[2:]]}
    return {"route": [steps[0], *steps] if way == "again" else list(steps)}
