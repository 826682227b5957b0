"""Where times come from, put on made floors as values: distributions, recorded times, gaps, switches, distances."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Values = dict[str, Any]

LAWS: dict[str, Callable[[int], Values]] = {
    "exponential": lambda s: {"mean": f"{s} s"},
    "lognormal": lambda s: {"mean": f"{s} s", "cv": 0.3},
    "gamma": lambda s: {"mean": f"{s} s", "cv": 0.4},
    "weibull": lambda s: {"mean": f"{s} s", "cv": 0.5},
    "hyperexponential": lambda s: {"mean": f"{s} s", "cv": 1.5},
    "erlang": lambda s: {"mean": f"{s} s", "k": 3},
    "geometric": lambda s: {"mean": f"{s} s", "step": "1 s"},
    "uniform": lambda s: {"low": f"{s / 2} s", "high": f"{s * 2} s"},
    "triangular": lambda s: {"low": f"{s / 2} s", "mode": f"{s} s", "high": f"{s * 2} s"},
    "normal": lambda s: {"mean": f"{s} s", "cv": 0.2},
    "beta": lambda s: {"low": "0 s", "high": f"{s * 3} s", "mean": f"{s} s", "cv": 0.4},
    "empirical": lambda s: {"values": [f"{s} s", f"{s + 1} s", f"{2 * s} s"]},
}
"""By name of a distribution, what else it says where its time is about so many seconds."""
SHARED = ("lognormal", "gamma", "weibull", "normal", "beta")
"""Those whose spread may lie between workers."""
TIME_KEYS = ("fixed", "dist", "recorded", "column", "by", "mean", "cv", "k", "step", "low", "high", "mode", "values")
EMULATED = ("reach", "pick", "place", "fasten", "inspect", "lift", "stoop")
MARKS = {"pick": ("grasp", 1.0), "fasten": ("start", "stop"), "inspect": ("raised", "turned")}


def law(pick, about_s: int, of_people: bool = True) -> Values:
    """A distribution with a mean of about so many seconds; of people, it may differ between them."""
    name = pick.one_of(list(LAWS))
    between = {"between_share": 0.3} if of_people and name in SHARED and pick.whole(0, 2) == 0 else {}
    return {"dist": name, **LAWS[name](max(1, about_s)), **between}


def distributions(pick, values: Values) -> None:
    """Some tasks take times by chance; a geometric one still whole seconds."""
    for task in pick.shuffled(list(values["tasks"].values()))[: pick.whole(1, 4)]:
        if "fixed" in task:
            _retimed(task, law(pick, _seconds(task["fixed"])))


def recorded_times(pick, values: Values) -> None:
    """Times from a file: whole seconds, drawn again, in order, or smoothed."""
    for task in pick.shuffled(list(values["tasks"].values()))[: pick.whole(1, 2)]:
        if "fixed" in task:
            _retimed(
                task,
                {"recorded": "times.csv", "column": "seconds", "by": pick.one_of(["resample", "trace", "smooth"])},
            )


def gaps(pick, values: Values) -> None:
    """Arrivals whose gaps are drawn."""
    for source in sources_of(values):
        if source["kind"] in ("renewal", "poisson"):
            source["kind"] = "renewal"
            source["every"] = law(pick, 10 * slow(values), of_people=False)
        if source["kind"] == "renewal" and pick.whole(0, 2) == 0:
            source["when_full"] = "lose"


def variability(pick, values: Values) -> None:
    """Some differences of times switched off, of tasks that have some."""
    distributions(pick, values)
    values["run"]["variability"] = pick.one_of(["within_only", "between_only", "none", "shuffled"])


def redrawn(pick, values: Values) -> None:
    """Other people in every replication, whose own pace differs."""
    values["run"]["staffing"] = "redrawn"
    for task in list(values["tasks"].values())[:2]:
        if "fixed" in task and task.get("automatic") is not True:
            about = _seconds(task["fixed"])
            _retimed(task, {"dist": "lognormal", "mean": f"{about} s", "cv": 0.3, "between_share": 0.5})


def distance(pick, values: Values) -> None:
    """Ways that are not along the axes."""
    values["layout"]["distance"] = "euclidean"
    if pick.whole(0, 1):
        names = list(values["layout"]["places"])
        if len(names) > 1:
            values["layout"].update(distance="paths", paths=[list(pick.shuffled(names))])


def emulated(pick, values: Values) -> None:
    """One or two tasks are movements of the synthetic library, with their postures; marks say when a tool is held."""
    values["libraries"] = {"bench": "libraries/bench_work.npz"}
    values["run"]["across_tasks"] = pick.one_of(["as_recorded", "same_pace"])
    able = [task for task in values["tasks"].values() if "fixed" in task and not task.get("automatic")]
    for worker in list(values["workers"].values())[: pick.whole(0, 2)]:
        worker.update(height=f"{pick.whole(155, 190) / 100} m", pace=pick.one_of([0.9, 1.1]))
    for task in pick.shuffled(able)[: pick.whole(1, 2)]:
        motion = pick.one_of(EMULATED)
        if pick.whole(0, 2) == 0:
            _retimed(task, {"motions": ["bench/reach", {"emulator": "bench/fasten", "repeat": 2}]})
            continue
        _retimed(task, {"emulator": f"bench/{motion}", **pick.one_of([{}, {"load": "6 kg"}])})
        if motion in MARKS and not {"team", "hold"} & set(task) and pick.whole(0, 1):
            begins, ends = MARKS[motion]
            values.setdefault("tools", {}).setdefault("driver", {"n": pick.whole(1, 2)})
            task["hold"] = {"tool": "driver", "from": begins, "to": ends}


def heights(pick, values: Values) -> None:
    """Some tasks go to heights that change, with the product or with the layer.

    NOTE: not among ``TIMES``, which would move all made floors: ``test_levels`` puts it on some of them.
    """
    values["libraries"] = {**values.get("libraries", {}), "handling": "libraries/handling.npz"}
    values.get("human", {}).pop("forgetting", None)
    places = values["layout"]["places"]
    name = pick.one_of(list(places))
    places[name] = {"at": places[name], "levels": {"low": "0.3 m", "hip": "0.9 m", "top": "1.5 m"}}
    levels = [f"{name}.low", f"{name}.hip", f"{name}.top", "0.6 m"]
    of_stations = {task for station in values["stations"].values() for task in station.get("tasks", ())}
    able = [
        task
        for key, task in values["tasks"].items()
        if key in of_stations and "fixed" in task and not {"automatic", "team", "hold"} & set(task)
    ]
    for task in pick.shuffled(able)[: pick.whole(2, 4)]:
        by_product = {product: pick.one_of(levels) for product in values["products"]}
        layers = {"layers": pick.shuffled(levels)[: pick.whole(1, 4)], "pieces_each": pick.whole(1, 5)}
        _retimed(task, {"emulator": "handling/shelf", "hands": {"grasp": pick.one_of([by_product, layers, layers])}})


def slow(values: Values) -> int:
    """How many times as long everything lasts: on floors of two days 24 times."""
    return 24 if values["run"]["horizon"] == "36 h" else 1


def sources_of(values: Values) -> list[Values]:
    """All sources of a scenario, or its one release."""
    return [values["release"]] if "release" in values else list(values["sources"].values())


def _retimed(task: Values, time: Values) -> None:
    """Another time in place of the one that a task has; all else stays."""
    for key in TIME_KEYS:
        task.pop(key, None)
    task.update(time)


def _seconds(said: str) -> int:
    """Whole seconds of ``6 s`` or ``2 min``."""
    number, unit = said.split()
    return int(float(number) * {"s": 1, "min": 60}[unit])


TIMES: dict[str, Callable[[Any, Values], None]] = {
    one.__name__: one for one in (distributions, recorded_times, gaps, variability, redrawn, distance, emulated)
}
"""By name, in the order in which they are put on."""
