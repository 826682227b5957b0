"""What a Plan uses of people: rules of choice, shifts and interruptions, crews, rotations, human effects."""

from __future__ import annotations

from collections.abc import Iterator

from engine_evidence.used_times import used_tasks

from opsim.engine.rules import ALLOCATION_RULES, INTERRUPTION_RULES, ROTATION_RULES
from opsim.plan import Plan
from opsim.subjects.human.catalogue import catalogue

PRIORITIES = {
    (): "none",
    ("stations",): "stations",
    ("products",): "products",
    ("stations", "products"): "stations, products",
    ("products", "stations"): "products, stations",
}
EFFECTS = {one.cls: f"human: {one.effect}, {one.model}" for one in catalogue()}
PEOPLE_WORDS = (
    *(f"allocation: {rule}" for rule in ALLOCATION_RULES),
    *(f"priorities: {name}" for name in PRIORITIES.values()),
    *("zones", "floaters", "skills: pace", "skills: quality", "idle: stay", "idle: home", "idle: patrol"),
    *("idle: patrol, serve one", "when_blocked: free", "when_blocked: held"),
    *("shifts", "shifts: always there beside", "shifts: several a person", "breaks", "breaks: at a place", "meetings"),
    *("overtime", "absence"),
    *(f"at_break: {rule}" for rule in INTERRUPTION_RULES),
    *(f"at_end: {rule}" for rule in INTERRUPTION_RULES),
    *("crew: bucket_brigade", "crew: rabbit_chase", "rotation: by the clock", "rotation: by count"),
    *("rotation: by rule alone", "rotation: empty post", *(f"rotation: {rule}" for rule in ROTATION_RULES)),
    *EFFECTS.values(),
    *("human: fatigue by posture", "human: experience", "human: acts on posture", "human: acts on time"),
)


def people_of(plan: Plan) -> set[str]:
    """Its words of ``PEOPLE_WORDS``."""
    by_hand = any(not plan.tasks[rank].automatic for rank in used_tasks(plan))
    return {*(_choice(plan) if by_hand else ()), *_duties(plan), *_together(plan), *_effects(plan)}


def _choice(plan: Plan) -> Iterator[str]:
    workers = plan.workers
    yield f"allocation: {plan.rule}"
    yield f"idle: {plan.idle}"
    yield f"when_blocked: {plan.when_blocked}"
    ranked = {station.priority for station in plan.stations} | {product.priority for product in plan.products}
    if len(ranked) > 1:
        yield f"priorities: {PRIORITIES[plan.priorities]}"
    yield from ("idle: patrol, serve one",) if plan.idle == "patrol" and plan.serve == "one" else ()
    yield from ("zones",) if any(worker.zone for worker in workers) else ()
    yield from ("floaters",) if any(worker.floater for worker in workers) else ()
    yield from ("skills: pace",) if {r for worker in workers for r in worker.rating} - {0.0, 1.0} else ()
    yield from ("skills: quality",) if any(worker.quality for worker in workers) else ()


def _duties(plan: Plan) -> Iterator[str]:
    shifted = [worker for worker in plan.workers if worker.duties is not None]
    if not shifted:
        return
    yield "shifts"
    yield from ("shifts: always there beside",) if len(shifted) < len(plan.workers) else ()
    yield from ("absence",) if any(worker.absence > 0 for worker in shifted) else ()
    for worker in shifted:
        duties = worker.duties or ()
        yield from ("shifts: several a person",) if len(duties) > 1 else ()
        for duty in duties:
            shift = plan.shifts[duty.shift]
            yield from () if duty.cut else (f"at_end: {shift.at_end}",)
            yield from ("overtime",) if shift.overtime_s > 0 and not duty.cut else ()
            for pause in duty.pauses:
                yield f"at_break: {shift.at_break}"
                yield "meetings" if pause.meeting else "breaks"
                yield from ("breaks: at a place",) if pause.place >= 0 else ()


def _together(plan: Plan) -> Iterator[str]:
    yield from (f"crew: {crew.kind}" for crew in plan.crews)
    for turns in plan.rotations:
        yield f"rotation: {turns.rule}"
        yield from ("rotation: empty post",) if () in turns.posts else ()
        if turns.every_s is not None:
            yield "rotation: by the clock"
        else:
            yield "rotation: by rule alone" if turns.after == 1 else "rotation: by count"


def _effects(plan: Plan) -> Iterator[str]:
    human = plan.human
    models = (human.learning, human.forgetting, human.fatigue, human.rest, human.state_pace, human.circadian)
    yield from (EFFECTS[type(model)] for model in (*models, human.errors) if model is not None)
    yield from ("human: fatigue by posture",) if getattr(human.fatigue, "by", "") == "posture" else ()
    yield from ("human: experience",) if human.experience else ()
    if human.changes_times:
        yield f"human: acts on {human.acts_on}"
