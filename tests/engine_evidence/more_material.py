"""Keys of material and stations that made floors seldom have, put on them as values."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

from engine_evidence.more_times import Values, sources_of

from opsim.engine.rules import ROUTING_RULES, SEQUENCING_RULES


def flow_rules(pick, values: Values) -> None:
    """A rule of sequence at every station, with due dates, and one of routing."""
    flow = values.setdefault("flow", {})
    flow["dispatch"] = pick.one_of([*SEQUENCING_RULES][1:])
    flow.setdefault("routing", pick.one_of(list(ROUTING_RULES)))
    for product in list(values["products"].values())[:2]:
        product["due"] = f"{pick.whole(20, 90)} s"


def families(pick, values: Values) -> None:
    """Products in families, by which servers are set up and batches go together."""
    for name, product in values["products"].items():
        product["family"] = pick.one_of(["big", "small"]) if name != "q0" else "big"
    for station in plain_stations(values)[:2]:
        if "batch" in station:
            station["batch"]["of"] = "family"
        elif "setup" not in station:
            station["setup"] = {
                "otherwise": f"{pick.whole(1, 4)} s",
                "by": "family",
                "attended": bool(pick.whole(0, 1)),
            }


def family_batches(pick, values: Values) -> None:
    """One station takes jobs of a family, or of a product, together; some wait for a full batch."""
    able = [
        one
        for one in plain_stations(values)
        if not {"batch", "preempt", "blocking", "share"} & set(one) and "blocking" not in values.get("flow", {})
    ]
    if able and not any("carried" in product for product in values["products"].values()):
        for product in values["products"].values():
            product.setdefault("family", "big")
        batch = {"size": 2, "of": pick.one_of(["family", "product"])}
        if pick.whole(0, 2):
            batch["most_wait"] = f"{pick.whole(3, 12)} s"
        able[0].update(batch=batch, buffer=6)


def spoils(pick, values: Values) -> None:
    """A share of jobs that a station spoils."""
    for station in pick.shuffled(plain_stations(values))[: pick.whole(1, 2)]:
        if not {"yield", "inspect"} & set(station):
            station["scrap"] = pick.one_of([0.05, 0.1, 0.2])


def heavy_lots(pick, values: Values) -> None:
    """Lots that are carried in several walks."""
    if any("batch" in station for station in values["stations"].values()):
        return
    for product in values["products"].values() if "lines" not in values else ():
        if pick.whole(0, 2):
            product.update(carried=True, mass="6 kg", lot=pick.whole(2, 3))
    for worker in values["workers"].values():
        if pick.whole(0, 1):
            worker["most_load"] = pick.one_of(["9 kg", "13 kg", "30 kg"])


def homing(pick, values: Values) -> None:
    """Empty vehicles drive home; where there are none, some come."""
    if "transporters" not in values and "lines" not in values:
        for product in values["products"].values():
            steps = product.get("route", [])
            legs = [[a, b] for a, b in pairwise(steps) if {type(a), type(b)} == {str} and a != b]
            legs = [leg for leg in legs if set(leg) <= set(values["stations"])]
            if legs and not product.get("carried"):
                place = pick.one_of(list(values["layout"]["places"]))
                truck = {"n": pick.whole(1, 2), "at": place, "speed": "2 m/s", "capacity": pick.whole(1, 3)}
                values["transporters"] = {"truck": {**truck, "load": "1 s", "unload": "2 s", "legs": legs[:2]}}
                break
    for truck in values.get("transporters", {}).values():
        if pick.whole(0, 2):
            truck["idle"] = "home"
        if list(values["layout"]["places"]) == ["p0", "p1", "p2"] and pick.whole(0, 1):
            truck["roads"] = [{"from": a, "to": b, "one_way": True} for a, b in pairwise(["p0", "p1", "p2", "p0"])]


def long_belts(pick, values: Values) -> None:
    """A belt between two steps, as long as is said, one way or the other."""
    for product in values["products"].values() if "lines" not in values else ():
        steps = product.get("route", [])
        for number, (a, b) in enumerate(pairwise(steps)):
            if {type(a), type(b)} != {str} or not {a, b} <= set(values["stations"]) or a == b:
                continue
            first, last = (values["stations"][step]["at"] for step in (a, b))
            legs = [leg for truck in values.get("transporters", {}).values() for leg in truck["legs"]]
            if first != last and [a, b] not in legs:
                belt = {
                    "from": first,
                    "to": last,
                    "speed": "0.5 m/s",
                    "pitch": "1 m",
                    "length": f"{pick.whole(2, 6)} m",
                }
                values.setdefault("conveyors", {})["track"] = {**belt, "accumulating": bool(pick.whole(0, 1))}
                product["route"] = [*steps[: number + 1], "track", *steps[number + 1 :]]
                return


def store_cards(pick, values: Values) -> None:
    """A kanban that ends at a store: the card comes back when a piece is taken out."""
    for name, store in values.get("stores", {}).items():
        ends = [one for one, product in values["products"].items() if name in product.get("route", [])]
        if ends:
            first = values["products"][ends[0]]["route"][0]
            lying = store.get("initial", 0)
            n = (sum(lying.values()) if isinstance(lying, dict) else lying) + pick.whole(2, 4)
            values.setdefault("cards", {})["kanban"] = {"n": n, "from": first, "to": name, "products": ends[:1]}


def open_orders(pick, values: Values) -> None:
    """A schedule that says how many, and leaves the product to the mix."""
    for source in sources_of(values)[:1]:
        if "q0" in values["products"] and not {"sequence", "shift"} & set(source):
            file = "open_orders.csv" if pick.whole(0, 2) or "q1" in values["products"] else "orders.csv"
            says = file == "open_orders.csv" and "products" in source
            products = {"products": source["products"]} if says else {}
            source.clear()
            source.update(kind="schedule", file=file, **products)


def unequal_shares(pick, values: Values) -> None:
    """A source that makes one product more often than the other."""
    for source in sources_of(values):
        if isinstance(source.get("products"), list) and len(source["products"]) == 2:
            source["products"] = dict(zip(source["products"], (0.3, 0.7)))


def unlimited(pick, values: Values) -> None:
    """Buffers without end."""
    for station in plain_stations(values):
        if pick.whole(0, 1):
            station["buffer"] = "unlimited"


def plain_stations(values: Values) -> list[Values]:
    """Stations with tasks that belong to no crew and no paced line."""
    kept = [one for block in ("crews", "lines") for made in values.get(block, {}).values() for one in made["stations"]]
    return [one for name, one in values["stations"].items() if name not in kept and one.get("tasks")]


MATERIAL: dict[str, Callable[[Any, Values], None]] = {
    one.__name__: one
    for one in (
        *(flow_rules, families, family_batches, spoils, heavy_lots, homing, long_belts, store_cards),
        *(open_orders, unequal_shares, unlimited),
    )
}
"""By name, in the order in which they are put on."""
