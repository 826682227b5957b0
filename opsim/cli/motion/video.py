"""The mean performance of a task beside simulated ones, for ``opsim motion show --video``."""

from __future__ import annotations

from typing import Any

from opsim.report.plot.animation import Video
from opsim.report.sections.motions import CARD_RATE_HZ, Card


def video(model: Any, *, n: int, people: str, person: str | None, seed: int) -> Video:
    """The mean and ``n`` draws of ``model``; the draws are those of ``opsim motion sample`` and of the strips.

    people : "new" draws each by another person of the population; "recorded" by the people of the fit in turn
    person : draws all by this person of the fit and shows this person's own mean; None: as ``people`` says
    Raises ValueError for an unknown person.
    """
    from emulator.model.mean_performance import mean_performance

    mean = mean_performance(model, person)
    drawn = _as(model, person, n, seed) if person else _drawn(model, n, people, seed)
    return Video(
        model.task,
        _lead(model, n, person),
        _card(mean, mean.dwell_s.sum(), ""),
        tuple(_card(one, model.dwell_s(one.scores).sum(), who) for one, who in drawn),
        model.skeleton,
        tuple(_notes(model, mean, people, person, seed)),
    )


def _drawn(model: Any, n: int, people: str, seed: int) -> list[tuple[Any, str]]:
    """Performances of one, each with who it is."""
    import numpy as np

    rng = np.random.default_rng(seed)
    if people == "new":
        together = model.sample(n, rng)
        return [(together[k], "") for k in range(n)]
    names = [model.workers[i] for i in rng.permutation(len(model.workers))]
    return [(model.sample(1, rng, worker=name), f"as {name}") for name in (names * n)[:n]]


def _as(model: Any, person: str, n: int, seed: int) -> list[tuple[Any, str]]:
    import numpy as np

    together = model.sample(n, np.random.default_rng(seed), worker=person)
    return [(together[k], f"as {person}") for k in range(n)]


def _card(performance: Any, paused_s: float, who: str) -> Card:
    """One performance, decoded at the frames that are shown."""
    import numpy as np

    from opsim.report.sections.motions import staged

    duration_s = float(performance.duration_s[0])
    times_s = np.arange(max(round(duration_s * CARD_RATE_HZ), 1) + 1) / CARD_RATE_HZ
    said = [f"{duration_s:.2f} s", f"{paused_s:.2f} s of it paused" if paused_s > 0 else "", who]
    return Card(
        staged(performance.positions_m(times_s)[0], CARD_RATE_HZ, performance.skeleton),
        False,
        ", ".join(filter(None, said)),
    )


def _lead(model: Any, n: int, person: str | None) -> str:
    from opsim.task_model import behind

    report = model.report
    shown = f"{n} simulated one{'s' if n > 1 else ''}"
    whose = f"{person}'s mean performance" if person else "The mean performance"
    return f"{whose} beside {shown}, emulated from {behind(report.source, report.n_sequences, report.n_workers)}."


def _notes(model: Any, mean: Any, people: str, person: str | None, seed: int) -> list[tuple[str, str]]:
    report = model.report
    drawn = "new people, each another, as a simulation draws them" if people == "new" else "the people of the fit"
    said = (
        "posture, path and pace after registration, at the mean duration; it need not be a movement that anybody makes"
    )
    if mean.dwell_s.sum() > 0:
        said += f"; it pauses {mean.dwell_s.sum():.2f} s, the mean of all, also of those who do not pause"
    told = [("Notes of the fit", "; ".join(report.notes))] if report.notes else []
    return [
        ("Mean", said),
        ("Simulated", f"{f'all as {person}' if person else drawn}; seed {seed}"),
        ("Fitted to", f"{report.source} ({report.where})"),
        *told,
        ("Licence", report.licence),
    ]
