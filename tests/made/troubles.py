"""What breaks work off where it hurts, put on made floors with people: on top of the other blocks, as values.

Set-ups where servers change hands, tools that are waited for in the middle of work and before it, and runs of the
station's own time that end where breaks begin, so that work is begun and broken off in one instant.
"""

from __future__ import annotations


def troubled(pick, values: dict) -> dict:
    """The floor with one or two of them, where it has room for them."""
    for put in pick.shuffled([preempted_setups, held_tools, round_runs])[: pick.whole(1, 2)]:
        put(pick, values)
    return values


def preempted_setups(pick, values: dict) -> None:
    """Two products by turns on servers that the first takes from the second, set up for each by somebody."""
    products = [name for name in ("q0", "q1") if name in values["products"]]
    of_crews = [name for crew in values.get("crews", {}).values() for name in crew["stations"]]
    others = [one for name, one in values["stations"].items() if name not in of_crews]
    able = [one for one in others if "batch" not in one and one.get("tasks") and "buffer" in one]
    if len(products) < 2 or not able:
        return
    values["products"]["q0"]["priority"] = 2
    values["tasks"].setdefault("change", {"fixed": f"{pick.whole(5, 40)} s"})
    for station in able[: pick.whole(1, 3)]:
        station.update(preempt=pick.one_of(["resume", "resume", "restart"]), buffer=max(3, station["buffer"]))
        station.setdefault("setup", {"otherwise": "change", "attended": True})


def held_tools(pick, values: dict) -> None:
    """One or two tools for all who hold one, some from the very beginning of their work."""
    values.setdefault("tools", {})["clamp"] = {"n": pick.one_of([1, 1, 2])}
    for name, task in values["tasks"].items():
        if name != "change" and not {"automatic", "team", "needs"} & set(task) and pick.whole(0, 2):
            task["hold"] = {"tool": "clamp", "from": pick.one_of([0.0, 0.0, 0.3]), "to": pick.one_of([0.6, 1.0])}


def round_runs(pick, values: dict) -> None:
    """Stations begin with whole minutes that somebody attends, and go on with work of his own."""
    values["tasks"]["run"] = {"fixed": f"{pick.whole(1, 2)} min", "automatic": "attended"}
    for station in values["stations"].values():
        if "batch" not in station and station.get("tasks") and pick.whole(0, 2):
            station["tasks"] = ["run", *station["tasks"]]
            if pick.whole(0, 1) and "maintenance" not in station:
                every = f"{pick.whole(3, 8)} min"
                station["maintenance"] = {"oil": {"every": every, "first": every, "lasts": "1 min", "when": "at_once"}}
