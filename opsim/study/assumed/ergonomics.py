"""What figures of scores take as given: how postures are scored, what nobody said, what no skeleton shows."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.ergonomics.options import Options, Thresholds
from opsim.ergonomics.scores.not_seen import NOT_SEEN, RULES
from opsim.ergonomics.shift.carried import EMPTY_HANDS
from opsim.kpi.better import read_asked
from opsim.kpi.names import REGION, SCORED
from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.evenness import LEAST_EXPOSED, evens_out
from opsim.plan.handling import END, START, Handling
from opsim.plan.tasks import TaskPlan
from opsim.plan.unsaid import leaves_open, unsaid
from opsim.plan.unseen import has_body, lacking

Lines = Iterator[tuple[str, str]]


def ergonomics(loaded, plan: Plan) -> Lines:
    """(topic, what is assumed), where figures of scores are asked for, or somebody is sent by exposure."""
    if not plan.posture:
        yield "postures", "posture: off: nobody looks at postures, and there is no figure of them; times are as ever"
        return
    if evens_out(plan):
        yield "exposure", _sent_by_dose()
    asked = {*loaded.scenario.outputs, *(read_asked(one).kpi for one in loaded.scenario.frontier or ())}
    bodies = [task for task in plan.tasks if has_body(task)]
    if asked.isdisjoint((*SCORED, *REGION)) or not bodies:
        return
    yield from _forks(plan.ergonomics)
    yield from _counted(plan)
    yield "scores", _thresholds(plan.ergonomics.thresholds)
    yield from _loads(bodies)
    yield from _unsaid(bodies)
    yield from (("not seen", f"{listed(names)}: {sentence}") for sentence, names in lacking(bodies).items())
    yield from (("not seen", sentence) for sentence in NOT_SEEN)
    yield from (("by rule", sentence) for sentence in RULES)


def _sent_by_dose() -> str:
    return (
        f"{LEAST_EXPOSED} goes by the dose so far: seconds at work on each task times the mean RULA, the least it may "
        "be, of a few draws of the worker's own; what a shift adds (repetition, postures held long) and walking are "
        "not in it, and a task without a body adds nothing"
    )


def _forks(options: Options) -> Lines:
    """Which way is taken where the published methods part."""
    arms = {"trunk": "the trunk: arms that hang in a stoop are flexed", "gravity": "gravity: hanging arms are upright"}
    table = {"published": "the paper (1993)", "worksheet2000": "the worksheet of 2000"}
    force = {"paper": "the paper's", "worksheet": "the worksheet's (more than 10 kg is always 3)"}
    disputed = (
        f"the other category for {listed(options.owas_disputed)}" if options.owas_disputed else "as most print it"
    )
    yield (
        "scores",
        f"{options.rate_hz:g} postures a second; upper arms are measured against {arms[options.arm_reference]}; RULA's "
        f"table A is that of {table[options.rula_table_a]}, its force rule {force[options.rula_force]}; disputed OWAS "
        f"codes: {disputed}",
    )
    yield (
        "scores",
        "repeated (RULA's muscle use, REBA's activity): the worker did the same task at least 4 times a minute, "
        "which is a cycle of 15 s or less (4 beginnings within 45 s); static: a posture was held for more than a "
        "minute; both are taken from the whole shift",
    )
    if options.waiting == "upright":
        yield "scores", "who waits is taken as standing upright with hanging arms, which nobody has seen"


def _counted(plan: Plan) -> Lines:
    """What figures of scores are of, beside work."""
    if plan.walking is not None:
        yield (
            "scores",
            "figures of scores and of raised arms count walking too; a walk that is not looked at has the postures of "
            "the one of the same worker that is nearest in length; figures of the trunk are of work alone, so those by "
            "task, station or product sum to more than they say",
        )
        yield "scores", f"{EMPTY_HANDS}: as heavy as it is told, else of any mass"
    if plan.ergonomics.waiting == "upright":
        yield "scores", "they count waiting too, as said above; breaks, meetings and absence are never counted"


def _thresholds(thresholds: Thresholds) -> str:
    t = thresholds
    spread = "; twist and side are taken over all from 5 to 20, and scores are intervals over it" if t.spread else ""
    return (
        f"angles that papers give as pictures or words, in degrees: twisted from {t.twist:g}, bent sideways from "
        f"{t.side:g}, arm abducted from {t.abducted:g} (beyond {t.arm_sideways:g} its elevation counts as flexion); "
        f"neck extended from {t.neck_extended:g} behind its neutral, "
        f"upright up to {t.trunk_upright:g}, wrist straight up to {t.wrist_straight:g}; OWAS: back bent from "
        f"{t.owas_back:g}, twisted or sideways from {t.owas_twist:g}, knee bent below {t.owas_knee:g}; a hand is "
        f"across the midline from {t.across_m:g} m, and out to the side from {t.outside_m:g} m{spread}"
    )


def _loads(tasks: list[TaskPlan]) -> Lines:
    said = [f"{task.name} {_load(task.handling)}" for task in tasks if task.handling.load_kg]
    if said:
        yield "loads", f"in the hands, as the scenario says: {listed(said)}"
    teams = [task.name for task in tasks if task.handling.load_kg and task.team > 1]
    if teams:
        yield "loads", f"{listed(teams)}: in the hands of each member of the team"


def _load(handling: Handling) -> str:
    always = handling.start == START and handling.end == END
    return f"{handling.load_kg:g} kg{' all the time' if always else ' between two moments of each performance'}"


def _unsaid(tasks: list[TaskPlan]) -> Lines:
    for key, names in unsaid((task.name, task.handling.load_kg, task.handling) for task in tasks).items():
        yield "not said", f"{listed(names)}: {key.replace('_', ' ')}: {leaves_open(key)}"
