"""Keys of people that made floors seldom have, put on them as values: effects, tools in hands, rules of choice."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from engine_evidence.more_material import plain_stations
from engine_evidence.more_times import Values, emulated
from made.troubles import held_tools, preempted_setups, round_runs

LEARNING: tuple[Values, ...] = (
    {"model": "wright", "rate": 0.85},
    {"model": "plateau", "floor": 0.6},
    {"model": "de_jong", "incompressible": 0.4},
    {"model": "stanford_b", "prior": 2},
    {"model": "hyperbolic", "half_at": 20},
    {"model": "dual_phase", "cognitive_share": 0.5},
)
INTERRUPTIONS = ("finish", "finish_job", "resume", "resume_any", "hand_over", "restart")
RULES = ("longest_queue", "nearest", "oldest_job", "most_downstream", "best_skill")


def learning(pick, values: Values) -> None:
    """Times fall with repetitions; some have some behind them, some forget."""
    human = values.setdefault("human", {})
    human["learning"] = {**pick.one_of(LEARNING), "measured_at": pick.one_of([1, 30, 200])}
    if pick.whole(0, 1):
        human["forgetting"] = {"model": "lfcm", "forgotten_in": "2 h", "least_pause": f"{pick.whole(5, 60)} s"}
    for worker in values["workers"].values():
        if pick.whole(0, 1):
            worker["experience"] = {pick.one_of(list(values["tasks"])): pick.whole(1, 200)}


def fatigue(pick, values: Values) -> None:
    """People tire; some rest by need, some leave defects then."""
    human = values.setdefault("human", {})
    human["fatigue"] = {"model": "lffrm", "tires_half_in": f"{pick.whole(2, 15)} min", "recovers_half_in": "3 min"}
    if pick.whole(0, 1):
        human["rest"] = {"above": 0.4, "until": 0.2}
    if pick.whole(0, 1):
        human["errors"] = {"at_full_fatigue": 0.2}
    human["acts_on"] = pick.one_of(["posture", "time"])


def muscles(pick, values: Values) -> None:
    """Fatigue by the load on joints, of tasks that are movements."""
    emulated(pick, values)
    human = values.setdefault("human", {})
    human["fatigue"] = dict(
        pick.one_of(
            [{"model": "3cc_r"}, {"model": "3cc_r"}, {"model": "lffrm", "by": "posture", "tires_half_in": "10 min"}]
        )
    )
    if pick.whole(0, 2) == 0:
        human["rest"] = {"above": 0.1, "until": 0.05}


def by_state(pick, values: Values) -> None:
    """People are quicker or slower by what waits, or by the time of the day."""
    human = values.setdefault("human", {})
    which = pick.whole(0, 2)
    if which != 1:
        human["state_pace"] = {"model": "schultz", "faster": 0.3, "slower": 0.2}
    if which != 0:
        human["circadian"] = {"amplitude": 0.2, "peak": pick.one_of(["03:00", "16:00"])}
    human["acts_on"] = pick.one_of(["posture", "time"])


def exposure(pick, values: Values) -> None:
    """Who goes, or who takes a post, is whose body has gone through least: where tasks are movements."""
    emulated(pick, values)
    turns = list(values.get("rotations", {}).values())
    if turns and pick.whole(0, 1):
        turns[0]["rule"] = "least_exposed"
    else:
        values["allocation"]["rule"] = "least_exposed"


def rules_of_choice(pick, values: Values) -> None:
    """Any of the rules, with priorities of stations and jobs before it, in any order, or with none."""
    values["allocation"]["rule"] = pick.one_of(RULES)
    priorities = pick.one_of([["stations", "products"], ["products", "stations"], ["products"], []])
    values["allocation"]["priorities"] = priorities
    for station in values["stations"].values():
        station.pop("priority", None)
    for station in plain_stations(values)[:2] if "stations" in priorities else ():
        station["priority"] = pick.whole(0, 2)
    for product in list(values["products"].values())[:1]:
        product["priority"] = pick.whole(0, 2)


def turns(pick, values: Values) -> None:
    """Another way to change posts, for those who rotate."""
    for rotation in values.get("rotations", {}).values():
        for key in ("every", "after", "rule"):
            rotation.pop(key, None)
        how = [{"after": pick.whole(3, 8)}, {"rule": "least_time"}, {"after": 4, "rule": "least_time"}]
        rotation.update(pick.one_of([*how, {"every": "3 min", "rule": "in_turn"}, {"rule": "in_turn"}]))
        if pick.whole(0, 1):
            rotation["posts"] = [*rotation["posts"], []]


def left_by_rule(pick, values: Values) -> None:
    """Tasks are left by rules of their own."""
    for name, task in values["tasks"].items():
        if task.get("automatic") is not True and name != "change" and pick.whole(0, 2):
            task["interruption"] = pick.one_of(INTERRUPTIONS)


def team_runs(pick, values: Values) -> None:
    """What somebody attends, or does by hand, is attended or done by two."""
    if "crews" in values or any("patrol" in worker for worker in values["workers"].values()):
        return
    for task in list(values["tasks"].values())[:2]:
        if "hold" not in task and task.get("automatic") is not True:
            task["team"] = 2
            if pick.whole(0, 1) and not {"emulator", "motions"} & set(task):
                task["automatic"] = "attended"
    for name in ("x8", "x9"):
        values["workers"][name] = {"skills": dict.fromkeys(values["stations"], 1.0), "walk": "2 m/s"}


def away(pick, values: Values) -> None:
    """Everybody with a shift misses some; shifts and breaks of some days alone."""
    if any("shift" in worker for worker in values["workers"].values()):
        values.setdefault("human", {})["absence"] = pick.one_of([0.1, 0.3])
    for shift in values.get("shifts", {}).values():
        if pick.whole(0, 1):
            shift["days"] = ["Mon", "Tue", "Sun"]
        for pause in shift.get("breaks", {}).values():
            if pick.whole(0, 2) == 0:
                pause["days"] = ["Mon", "Sun"]


def called_to_lines(pick, values: Values) -> None:
    """Whoever is called to a paced line, by each of its ways; of a moving one, stretches that differ, and its speed."""
    for line in values.get("lines", {}).values():
        names = list(values["workers"])
        of_crews = {name for crew in values.get("crews", {}).values() for name in crew["workers"]}
        able = [name for name in names if name not in of_crews]
        if able:
            does = pick.one_of(["take_over", "help"])
            line["andon"] = {"workers": able[:1], "at": f"{pick.whole(0, 12)} s", "does": does}
        if line["kind"] == "moving" and pick.whole(0, 1):
            line["lengths"] = {line["stations"][-1]: f"{pick.whole(2, 6)} m"}
            if pick.whole(0, 1):
                line["speed"] = pick.one_of(["0.1 m/s", "0.2 m/s"])


PEOPLE_MORE: dict[str, Callable[[Any, Values], None]] = {
    one.__name__: one
    for one in (
        *(away, rules_of_choice, turns, called_to_lines, left_by_rule, team_runs, learning, fatigue, muscles, by_state),
        *(exposure, preempted_setups, held_tools, round_runs),
    )
}
"""By name, in the order in which they are put on."""
