"""Stations with stops, set-ups, alternatives, inspections and hours, put on made floors as values."""

from __future__ import annotations

import re
from collections.abc import Callable
from copy import deepcopy
from itertools import product as pairs
from typing import Any

from engine_evidence.more_material import plain_stations
from engine_evidence.more_times import Values, slow, sources_of

CYCLES: tuple[Any, ...] = (5, 8, {"dist": "geometric", "mean": 7}, {"dist": "uniform", "low": 3, "high": 9})
STOPS = tuple(pairs(("clock", "busy", "cycles"), ("resume", "restart", "scrap")))


def stops(pick, values: Values) -> None:
    """Two or three stations break down, or are looked after, with one team of one or two for all of them."""
    team = pick.one_of([{}, {"team": "mechanics"}, {"team": "mechanics"}])
    for station in pick.shuffled(plain_stations(values))[: pick.whole(2, 3)]:
        if pick.whole(0, 3):
            by, job = pick.one_of(STOPS)
            mean_s = pick.whole(40, 120) * slow(values)
            every = pick.one_of([{"dist": "exponential", "mean": f"{mean_s} s"}, {"fixed": f"{mean_s} s"}])
            jam = {"every": pick.one_of(CYCLES) if by == "cycles" else every, "by": by, "job": job}
            station["breakdowns"] = {
                "jam": {**jam, "repair": {"fixed": f"{pick.whole(5, 15) * slow(values)} s"}, **team}
            }
        else:
            care = {"every": "90 s", "first": f"{pick.whole(20, 60)} s", "lasts": f"{pick.whole(5, 12)} s"}
            station["maintenance"] = {"care": {**care, "when": pick.one_of(["after_job", "at_once"]), **team}}
    if team:
        values.setdefault("repair_teams", {})["mechanics"] = {"n": pick.one_of([1, 1, 2])}


def setups(pick, values: Values) -> None:
    """One or two stations are set up: by a time or a task, by somebody or alone, by product or by family."""
    if pick.whole(0, 1):
        _one_more_product(values)
    names = list(values["products"])
    if len(names) < 2:
        return
    values["tasks"].setdefault("change", {"fixed": f"{pick.whole(2, 8)} s"})
    by = pick.one_of(["product", "family"])
    for number, name in enumerate(names):
        if by == "family":
            values["products"][name]["family"] = "big" if number % 2 == 0 else "small"
    for station in pick.shuffled(plain_stations(values))[: pick.whole(1, 2)]:
        said = {"otherwise": pick.one_of(["change", f"{pick.whole(1, 5)} s"]), "attended": bool(pick.whole(0, 1))}
        if by == "product" and pick.whole(0, 1):
            said["first"] = names[0]
        station["setup"] = {**said, "by": by}


def _one_more_product(values: Values) -> None:
    """Two products more that go the way of the first one, where that is a plain route."""
    first = next(iter(values["products"].values()))
    if "route" not in first or {"parts", "split"} & set(first) or any(name in values for name in ("lines", "crews")):
        return
    added = ("q8", "q9")
    for name in added:
        values["products"][name] = {"route": list(first["route"])} | {"carried": first.get("carried", False)}
        values["products"][name] |= {"mass": first["mass"]} if "mass" in first else {}
    if "release" in values:
        for product in values["products"].values():
            product["share"] = 1 / len(values["products"])
    else:
        values["sources"]["nine"] = {
            "kind": "renewal",
            "every": {"fixed": f"{25 * slow(values)} s"},
            "products": list(added),
        }


def parallel(pick, values: Values) -> None:
    """A station beside another one, for whoever can work there; jobs go to the one or the other by a rule."""
    able = [name for name in values["stations"] if values["stations"][name] in plain_stations(values)]
    able = [name for name in able if _steps_at(values, name)]
    if not able:
        return
    old = pick.one_of(able)
    new = f"{old}b"
    values["stations"][new] = deepcopy(values["stations"][old])
    for worker in values["workers"].values():
        if old in worker["skills"]:
            worker["skills"][new] = worker["skills"][old]
            if "patrol" in worker:
                worker["patrol"].append(new)
    for product in values["products"].values():
        if "route" in product:
            product["route"] = [[new, old] if step == old else step for step in product["route"]]
    rule = pick.one_of(["least_loaded", "first_free", "in_order", "shortest_queue"])
    values.setdefault("flow", {})["routing"] = rule


def _steps_at(values: Values, name: str) -> bool:
    """Whether jobs come to a station by routes alone, and nothing else is said of it by its name."""
    routes = [step for product in values["products"].values() for step in product.get("route", [])]
    beside = {key: values[key] for key in ("cards", "transporters", "rotations", "crews", "lines") if key in values}
    said = [product.get(key) for product in values["products"].values() for key in ("parts", "split", "routing")]
    others = [station.get(key) for station in values["stations"].values() for key in ("share", "inspect")]
    return name in routes and f"'{name}'" not in repr((beside, said, others))


def looks(pick, values: Values) -> None:
    """A station leaves defects, a later one of a way finds some of them and scraps them, or sends them back."""
    for product in values["products"].values():
        steps = [step for step in product.get("route", []) if isinstance(step, str)]
        steps = [step for step in steps if step in values["stations"]]
        if len(set(steps)) > 1 and "crews" not in values:
            first, last = (values["stations"][step] for step in (steps[0], steps[-1]))
            first["yield"] = pick.one_of([0.6, 0.85])
            for station in (first, last):
                station.pop("scrap", None)
            then = pick.one_of(["scrap", "scrap", {"rework": steps[0]}])
            most = {} if then == "scrap" or pick.whole(0, 1) else {"most": pick.whole(1, 2)}
            last["inspect"] = {"finds": 0.9, "false_alarms": pick.one_of([0, 0.1]), "then": then, **most}
            return


def opening(pick, values: Values) -> None:
    """Stations and sources have hours, of up to three windows in the run."""
    if "shifts" in values or "start" in values["run"]:
        return
    horizon_s = _seconds(values["run"]["horizon"])
    edges = sorted(pick.shuffled(range(10, horizon_s - 10))[:6])
    clock = [f"06:{second // 60:02d}:{second % 60:02d}" for second in edges]
    windows = zip("abc", clock[::2], clock[1::2])
    values["shifts"] = {name: {"from": begins, "to": ends} for name, begins, ends in windows}
    for station in plain_stations(values):
        if pick.whole(0, 2):
            station |= {"shift": list(pick.shuffled("abc")[:2]), "at_close": pick.one_of(["finish", "resume"])}
    for source in sources_of(values):
        if pick.whole(0, 2) == 0 and source["kind"] != "base_stock":
            source["shift"] = ["a", "c"]


def _seconds(said: str) -> int:
    found = re.fullmatch(r"(\d+) (s|min|h)", said)
    assert found is not None, said
    return int(found[1]) * {"s": 1, "min": 60, "h": 3600}[found[2]]


STATIONS_MORE: dict[str, Callable[[Any, Values], None]] = {
    one.__name__: one for one in (parallel, stops, setups, looks, opening)
}
"""By name, in the order in which they are put on."""
