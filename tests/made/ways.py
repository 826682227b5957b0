"""Ways through made floors on which jobs are passed on one by one, in their order."""

from __future__ import annotations

from made.floors import Floor

ODD = {"batch", "preempt", "share", "inspect"}
"""Keys of stations at which jobs are not passed on one by one, in their order."""


def plain_way(floor: Floor, letter: str) -> list[str]:
    """The way of the only main product where it is plain and nobody goes by it yet, else a way of its own."""
    steps, products = _steps(floor), floor["products"]
    stations = [floor["stations"][step] for step in steps]
    odd = ODD & {key for station in stations for key in station}
    teams = any("team" in floor["tasks"][task] for station in stations for task in station["tasks"])
    whole = all(product.get("route", []) == steps for product in products.values())
    if len(products) > 1 or len(steps) < 2 or not whole or odd or teams or floor["crews"]:
        return way_of_its_own(floor, letter)
    return steps


def way_of_its_own(floor: Floor, letter: str, **keys) -> list[str]:
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


def _steps(floor: Floor) -> list[str]:
    """Stations of a main product's route from its second step on, as far as each comes once and alone."""
    route = next((floor["products"][name]["route"] for name in floor.routed), [])
    return [step for step in route if isinstance(step, str) and step in floor.stations and route.count(step) == 1]
