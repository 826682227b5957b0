"""What figures of scores take as given: how postures are scored, what nobody said, what no skeleton shows.

What figures of lifting, holding still, energy and rest take as given.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from opsim.engine.rules import LEAST_EXPOSED
from opsim.ergonomics.anthropometry import HEIGHT_M, MASS_KG
from opsim.ergonomics.options import NOT_SEEN, RULES, Options, Thresholds
from opsim.ergonomics.shift.walks import EMPTY_HANDS
from opsim.ergonomics.strain.energy import (
    BENCH_M,
    BENT_DEG,
    PRICE_ACCEPTABLE_W,
    PRICE_RESTING_W,
    SQUAT_DEG,
    STANDARD_KCAL_PER_MIN,
)
from opsim.ergonomics.strain.lifting import LEAST_TRAVEL_M, seated
from opsim.ergonomics.strain.lifting_pattern import PAUSE_S
from opsim.ergonomics.strain.posture_limits import EN_1005_4
from opsim.ergonomics.strain.static_holds import STATIC_WORK
from opsim.kpi.catalogue import ENERGY, HELD, LIFTED, REGION, REST, SCORED, read_asked
from opsim.plan import Plan
from opsim.problems import Assumption, listed
from opsim.subjects.exposure.plan import END, START, Handling, leaves_open, unsaid
from opsim.subjects.tasks.plan import TaskPlan
from opsim.subjects.tasks.warnings import has_body, lacking

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


def ergonomics(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed), where figures of scores are asked for, or somebody is sent by exposure."""
    if not plan.posture:
        yield "postures", "posture: off: nobody looks at postures, and there is no figure of them; times are as ever"
        return
    if plan.evens_out:
        yield "exposure", _sent_by_dose()
    asked = {*loaded.scenario.outputs, *(read_asked(one).kpi for one in loaded.scenario.frontier or ())}
    bodies = [task for task in plan.tasks if has_body(task) and task.levels is None]
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


def _forks(options: Options) -> Iterator[Assumption]:
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


def _counted(plan: Plan) -> Iterator[Assumption]:
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


def _loads(tasks: list[TaskPlan]) -> Iterator[Assumption]:
    said = [f"{task.name} {_load(task.handling)}" for task in tasks if task.handling.load_kg]
    if said:
        yield "loads", f"in the hands, as the scenario says: {listed(said)}"
    teams = [task.name for task in tasks if task.handling.load_kg and task.team > 1]
    if teams:
        yield "loads", f"{listed(teams)}: in the hands of each member of the team"


def _load(handling: Handling) -> str:
    always = handling.start == START and handling.end == END
    return f"{handling.load_kg:g} kg{' all the time' if always else ' between two moments of each performance'}"


def _unsaid(tasks: list[TaskPlan]) -> Iterator[Assumption]:
    for key, names in unsaid((task.name, task.handling.load_kg, task.handling) for task in tasks).items():
        yield "not said", f"{listed(names)}: {key.replace('_', ' ')}: {leaves_open(key)}"


def strain(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed), for those of these figures that are asked for."""
    if not plan.posture:
        return
    asked = {*loaded.scenario.outputs, *(read_asked(one).kpi for one in loaded.scenario.frontier or ())}
    if not asked.isdisjoint(LIFTED):
        yield from (("lifting", sentence) for sentence in _lifting(plan))
    if not asked.isdisjoint(HELD):
        yield from (("limits", sentence) for sentence in _holding())
    if not asked.isdisjoint((*ENERGY, *REST)):
        yield from (("energy", sentence) for sentence in _energy(plan))
    if not asked.isdisjoint(REST):
        yield "rest", _resting()


def _lifting(plan: Plan) -> Iterator[str]:
    yield (
        "a lift is a performance with a load whose hands go up or down by at least "
        f"{LEAST_TRAVEL_M * 100:g} cm between the first and the last posture with it; lowering counts alike; distances "
        "are from the middle of the ankles to the middle of the hands, asymmetry is against the hips"
    )
    yield (
        "at least: only where it is taken counts; at most: where it is let go too, as if it had to be put down with "
        "care; a grip that nobody told is between good and poor"
    )
    yield (
        f"a time of more than {PAUSE_S / 60:g} min without a lift is recovery; lifts a minute are those of the time of "
        "lifting; beyond the equation's range (63 cm, 175 cm, 135 degrees, too often) the edge of the range stands, "
        "and what is told as at most is no bound there: lifts_out_of_range_share tells how many these are"
    )
    yield (
        "the duration of lifting is that of the shift: where only a part of a shift was simulated, the rest of it goes "
        "on as that part; a composite index at least and at most is sought over all orders its lifts may have"
    )
    unknown = [worker.name for worker in plan.workers if worker.duties is None]
    if unknown:
        yield f"{listed(unknown)}: no shifts: lifting lasts at least as long as in the run, and at most 8 h"
    sitting = [task.name for task, sits in zip(plan.tasks, seated(plan)) if sits and task.handling.load_kg]
    if sitting:
        yield f"{listed(sitting)}: done sitting, for which the equation is not made: no index, and none in composites"
    yield from _teams(plan)


def _teams(plan: Plan) -> Iterator[str]:
    names = [task.name for task in plan.tasks if task.team > 1 and task.handling.load_kg]
    if names:
        yield f"{listed(names)}: load is what each member of the team has in the hands, here as in energy and fatigue"


def _holding() -> Iterator[str]:
    yield (
        "the numbers of ISO 11226 and EN 1005-4 are as the literature about them gives them: check them against the "
        "standards before judging by them; nothing supports trunk, head or arms; the neck's zones are taken of the "
        "lean of the head, as nobody sees where eyes look"
    )
    yield (
        f"held still: within {STATIC_WORK.band_deg:g} degrees for more than {STATIC_WORK.least_s:g} s, and out of "
        f"neutral ({STATIC_WORK.trunk_deg:g} degrees of trunk and arms, {STATIC_WORK.neck_deg:g} of the neck, "
        f"{STATIC_WORK.backward_deg:g} backward), also from one performance to the next; what drifts farther than this "
        "is several holds, the longest first, each judged at its mean angle"
    )
    yield (
        f"up to {EN_1005_4.trunk.leeway_deg:g} degrees backward are upright, in both standards; an arm is backward "
        "where it is behind the plane of the trunk; how often one moves is counted by the minute of the clock, for "
        "each zone at the edge at which it begins"
    )


def _energy(plan: Plan) -> Iterator[str]:
    yield (
        f"one is bent from {BENT_DEG:g} degrees of trunk flexion, and lifts from the knees where they are bent by "
        f"{SQUAT_DEG:g} degrees; breaks are sat, waiting is stood; who walks within a task, as his feet tell, walks at "
        "the speed of his ways; not in it: tools, pushing, pulling; at most: light work of both arms while he stands "
        "at work without a load, and the body's part of lowering and lifting for each way down and up without a load "
        f"(hands below {BENCH_M * 100:g} cm, bent in the trunk or the knees), which at least leaves out"
    )
    yield _walking(plan)
    marks = [task.name for task in plan.tasks if task.handling.load_kg and not _timed(task)]
    if marks:
        yield f"{listed(marks)}: no body tells when hands are full: the load is held never at least, always at most"
    yield from _teams(plan)
    heavy = [worker.name for worker in plan.workers if worker.body.mass_kg is None]
    if heavy:
        yield f"{MASS_KG:g} kg are taken for {listed(heavy)}, whose mass nobody told"
    unknown = [worker.name for worker in plan.workers if worker.body.sex is None]
    if unknown:
        yield f"of both sexes the range, for {listed(unknown)}, of whom nobody told"


def _timed(task: TaskPlan) -> bool:
    """Whether it is known when its load is in the hands."""
    return task.handling.by_share or getattr(task.model, "skeleton", None) is not None


def _walking(plan: Plan) -> str:
    unknown = [one.name for one in plan.products if one.carried and one.mass_kg is None]
    nothing = f"; {listed(unknown)}: no mass told, so nothing" if unknown else ""
    return f"{EMPTY_HANDS} (as much of a lot as they may carry at once, also on its last way){nothing}"


def _resting() -> str:
    standard = STANDARD_KCAL_PER_MIN
    return (
        "shares are of the time at work (there, and in no break) with the rest it asks for; "
        f"Murrell: {standard['m']:g} kcal/min may be spent all day ({standard['f']:g} by women, both where it is not "
        f"said); Price: {PRICE_ACCEPTABLE_W:g} W, {PRICE_RESTING_W:g} W at rest, from memory and to be checked; "
        f"Rohmert: of the back and of straight arms, without load, of {HEIGHT_M:g} m where no height is told"
    )
