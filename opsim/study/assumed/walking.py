"""How workers walk, where a scenario says it: what is assumed, and the recordings behind it."""

from collections.abc import Iterator
from typing import Any

from opsim.bodies import keys_read
from opsim.libraries import walked_m_per_s
from opsim.names import listed
from opsim.plan import Plan
from opsim.provenance import behind, fit_report


def walking(_loaded: Any, plan: Plan) -> Iterator[tuple[str, str]]:
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
    yield from _bodies(plan, plan.walking.model)


def _bodies(plan: Plan, model: Any) -> Iterator[tuple[str, str]]:
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


def walking_source(loaded: Any, plan: Plan) -> dict[str, Any] | None:
    """What stands behind the walks, as ``task_sources`` says it of a task; None where walking is time alone."""
    if plan.walking is None:
        return None
    report, said = fit_report(plan.walking.model), loaded.scenario.walking
    return {
        "model": f"emulator {plan.walking.name}",
        "library": loaded.scenario.libraries[said.library],
        "library_task": said.library_task,
        "source": report.source,
        "licence": report.licence,
        "n_sequences": report.n_sequences,
        "n_workers": report.n_workers,
    }
