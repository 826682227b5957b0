"""What a run takes as given of human effects: each with its source and parameters, and how far postures follow.

How workers walk, where a scenario says it: what is assumed, and the recordings behind it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from opsim.ergonomics.anthropometry import HEIGHT_M, MASS_KG
from opsim.libraries import walked_m_per_s
from opsim.plan import Plan
from opsim.problems import Assumption, listed
from opsim.subjects.human.catalogue import Entry, as_written, entry, name_written
from opsim.subjects.human.plan import EFFECTS
from opsim.subjects.tasks.warnings import shifted_by, unmoved
from opsim.task_model import behind, fit_report, keys_read

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded

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


def human(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
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


def _postures(plan: Plan) -> Iterator[Assumption]:
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


def _bodies(plan: Plan) -> Iterator[Assumption]:
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


def _experience(plan: Plan) -> Iterator[Assumption]:
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


def walking(_loaded: Any, plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of walks that have postures; nothing where walking is time alone."""
    if plan.walking is None or not plan.workers:
        return
    report = fit_report(plan.walking.model)
    people = behind(report.source, report.n_sequences, report.n_workers)
    yield (
        "walking",
        f"people walk as in {plan.walking.name} ({people}): each walk is a draw of its own, over the length of the way "
        "and at the worker's walking speed, which with his legs decides how long his steps are; it takes distance / "
        "speed to the bit, as it would without postures, starting and stopping included, so that in the middle of a "
        "short way people are faster than their walking speed",
    )
    slowest, fastest = walked_m_per_s()
    yield (
        "walking",
        f"people walk at {slowest:g} to {fastest:g} m/s: a walking speed beyond is refused, and where "
        "walking is a task of its own, a pace or slowness that would lead beyond counts only as far as that",
    )
    yield (
        "walking",
        "a drawn walk is straight, from standing to standing and with empty hands: how people turn, pass doors or "
        "carry is not measured",
    )
    yield from _walking_bodies(plan, plan.walking.model)


def _walking_bodies(plan: Plan, model: Any) -> Iterator[Assumption]:
    """What walking makes of bodies and of who people are."""
    tall = [worker.name for worker in plan.workers if worker.body.height_m is not None]
    if tall and "height_m" in keys_read(model):
        yield "walking", f"height of {listed(tall)}: bones are scaled to it, and with the legs the steps"
    people = [worker for worker in plan.workers if worker.body.person is not None]
    unknown = [worker.name for worker in people if worker.body.person not in getattr(model, "workers", ())]
    if unknown:
        yield (
            "walking",
            f"{listed(unknown)}: nobody recorded their walking: they walk as people drawn from the population",
        )


def walking_source(loaded: Loaded, plan: Plan) -> dict[str, Any] | None:
    """What stands behind the walks, as ``task_sources`` says it of a task; None where walking is time alone."""
    said = loaded.scenario.walking
    if plan.walking is None or said is None:
        return None
    report = fit_report(plan.walking.model)
    return {
        "model": f"emulator {plan.walking.name}",
        "library": loaded.scenario.libraries[said.library],
        "library_task": said.library_task,
        "source": report.source,
        "licence": report.licence,
        "n_sequences": report.n_sequences,
        "n_workers": report.n_workers,
    }
