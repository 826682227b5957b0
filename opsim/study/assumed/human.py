"""What a run takes as given of human effects: each with its source and parameters, and how far postures follow."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.ergonomics.joint_loads.strength import HEIGHT_M, MASS_KG
from opsim.human.catalogue import Entry, entry
from opsim.human.listing import as_written, name_written
from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.human import EFFECTS
from opsim.plan.unmoved import shifted_by, unmoved

Lines = Iterator[tuple[str, str]]
TOPIC = "human effects"
ASSUMED = {
    "fatigue": "that fatigue slows people, in proportion of log time and by so much, is an assumption: the source says "
    "how tired they are, not how fast they work",
    "rest": "both levels are assumptions; a rest is a break of its own in the log, and begins when a task is done",
    "state_pace": "that pace changes in proportion to how full buffers are is an assumption",
    "circadian": "that log time follows the hour in proportion, and by so much, is an assumption",
    "errors": "that defects grow in proportion to fatigue, and by so much, is an assumption",
    "learning": "the time alone is multiplied: postures and the spread of times about their mean stay as they are",
    "forgetting": "all pauses between two performances of a task count by their length alone",
}
"""What no source bears out."""
RESTS = (
    "who does not perform a task rests, as far as fatigue goes, wholly: also who walks or carries something from one "
    "place to another, and who waits standing"
)


def human(loaded, plan: Plan) -> Lines:
    """(topic, what is assumed) of every effect that is on; nothing where none is."""
    said = loaded.scenario.human
    for effect in EFFECTS:
        block = getattr(said, effect)
        if block is not None:
            yield TOPIC, f"{_words(entry(effect, block.model), block, effect, loaded.given)}; {ASSUMED[effect]}"
    yield from _postures(plan)
    if plan.human.fatigue is not None:
        yield TOPIC, RESTS
    yield from _bodies(plan)
    yield from _experience(plan)
    if said.absence:
        found = [
            w.name for w in plan.workers if w.duties is not None and f"workers.{w.name}.absence" not in loaded.given
        ]
        if found:
            yield "absence", f"{listed(found)}: {said.absence:g} of their shifts, as the scenario says of everybody"


def _words(one: Entry, block, effect: str, given) -> str:
    """``fatigue lffrm (slows 0.2 by default, ...): what it does; source``."""
    told = [
        f"{name_written(parameter)} {as_written(parameter, getattr(block, parameter.name))}"
        + ("" if f"human.{effect}.{name_written(parameter).removesuffix('_s')}" in given else " by default")
        for parameter in one.parameters
    ]
    return f"{effect.replace('_', ' ')}, {one.model} ({', '.join(told)}): {one.does}; source: {one.source}"


def _postures(plan: Plan) -> Lines:
    """How far postures follow what shifts the pace of people."""
    shifts = shifted_by(plan)
    if shifts:
        yield (
            TOPIC,
            f"{listed(shifts)}: postures follow the shift of pace as those of slower performances differ in the "
            "recordings, which goes beyond what was recorded of anybody tired: an extrapolation",
        )
        still = [task.name for task in unmoved(plan)]
        if still:
            yield TOPIC, f"{listed(still)}: the time alone follows the shift of pace; there is no body that could"
    elif plan.human.acts_on == "time" and plan.human.changes_times:
        yield TOPIC, "acts_on: time: effects change times alone, and postures are those of an unhurried, rested person"


def _bodies(plan: Plan) -> Lines:
    """Bodies of which strength is not known, where it is asked for."""
    fatigue = plan.human.fatigue
    if fatigue is None or not getattr(fatigue, "needs_burden", False):
        return
    lacking = [w.name for w in plan.workers if None in (w.body.height_m, w.body.mass_kg, w.body.sex)]
    if lacking:
        yield (
            "bodies",
            f"{listed(lacking)}: height, mass or sex not given: as heavy and strong as of {HEIGHT_M:g} m, "
            f"{MASS_KG:g} kg and the mean of women and men",
        )
    empty = [task.name for task in plan.tasks if not task.automatic and getattr(task.model, "skeleton", None) is None]
    if empty:
        by_joint = type(fatigue) is entry("fatigue", "3cc_r").cls
        how = "it tires no muscle" if by_joint else "it tires as the mean of the others"
        yield "bodies", f"{listed(empty)}: no body, and hence no load on joints: {how}"


def _experience(plan: Plan) -> Lines:
    if plan.human.learning is None:
        return
    told = [
        f"{worker.name} {task.name} {times:g}"
        for worker, row in zip(plan.workers, plan.human.experience)
        for task, times in zip(plan.tasks, row)
        if times
    ]
    start = f"repetitions behind them at the start: {listed(told)}; " if told else ""
    yield "experience", f"{start}{'whoever else' if told else 'everybody'} starts a task for the first time"
