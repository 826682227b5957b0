"""Recorded performances beside emulated ones of the same task, shuffled, for ``opsim motion show --beside``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.report.sections.motions import Card


@dataclass(frozen=True)
class Beside:
    """cards : in the order to show them; notes : (topic, words) on where they come from, without the answer."""

    cards: list[Card]
    notes: list[tuple[str, str]]


def beside(model: Any, file: str, *, where: str | None, n: int, people: str, seed: int) -> Beside:
    """``n`` repetitions of the recording ``file`` and ``n`` draws of ``model``.

    where  : as for a fit: None takes the correct repetitions, "all" all of them
    people : "new" draws each emulated performance by another person of the population, as a simulation with people
             of its own does; "recorded" by the people of the fit
    Raises ValueError for what is no recording, one of another skeleton, or one with fewer than ``n`` repetitions.
    """
    from emulator import read_motions
    from opsim.streams import stream

    chosen = {} if where is None else {"where": None if where == "all" else where}
    motions = read_motions(file, **chosen)
    _refuse(model, motions, file, n)
    real = _spread(motions, n, stream(seed, 0, "beside", model.task, "recordings"))
    rate_hz = (len(real[0].time_s) - 1) / real[0].duration_s
    drawn = _drawn(model, n, people, rate_hz, stream(seed, 0, "beside", model.task, "emulated"))
    cards = [_recorded(motion, rate_hz) for motion in real] + drawn
    order = stream(seed, 0, "beside", model.task, "order").permutation(len(cards))
    return Beside([cards[i] for i in order], _notes(model, motions, real, file, people))


def _refuse(model: Any, motions: Any, file: str, n: int) -> None:
    theirs, ours = motions.skeleton, model.skeleton
    if theirs != ours:
        apart = [f"without {_some(set(ours.names) - set(theirs.names))}" if set(ours.names) - set(theirs.names) else ""]
        apart += [f"with {_some(set(theirs.names) - set(ours.names))}" if set(theirs.names) - set(ours.names) else ""]
        said = " and ".join(filter(None, apart)) or "in another order or with other parents"
        raise ValueError(
            f"{file}: found a skeleton of {theirs.n_joints} joints, {said}; "
            f"expected the {ours.n_joints} joints of the task {model.task!r}"
        )
    if len(motions) < n:
        found = f"{len(motions)} repetition{'s' if len(motions) > 1 else ''} ({motions.selection})"
        raise ValueError(f"{file}: found {found}, expected {n} or more for -n {n}")


def _some(names: set[str]) -> str:
    listed = sorted(names)
    return ", ".join(listed[:4]) + (f" and {len(listed) - 4} more" if len(listed) > 4 else "")


def _spread(motions: Any, n: int, rng: Any) -> list[Any]:
    """n repetitions at random, of as many different people as there are: one body twice would give itself away."""
    queues = {worker: [m for m in motions.motions if m.worker == worker] for worker in motions.workers}
    ranked = []
    for worker in rng.permutation(motions.workers):
        mine = [queues[worker][i] for i in rng.permutation(len(queues[worker]))]
        ranked += list(enumerate(mine))
    return [motion for _, motion in sorted(ranked, key=lambda row: row[0])[:n]]


def _recorded(motion: Any, rate_hz: float) -> Card:
    from opsim.report.sections.motions import staged

    return Card(
        staged(_standing(motion), rate_hz, motion.skeleton), True, f"{motion.worker}, repetition {motion.trial}"
    )


def _standing(motion: Any) -> Any:
    """Joints (T, J, 3) with bones of one length, as an emulated body has them, and the feet where they were recorded.

    NOTE: rigid bones hung from the recorded pelvis would lift the feet of a squat by 5 to 9 cm, since markers on the
    skin make bones that breathe.
    """
    from emulator.model.feet import on_its_feet

    return on_its_feet(motion).positions_m()


def _drawn(model: Any, n: int, people: str, rate_hz: float, rng: Any) -> list[Card]:
    """n emulated performances, decoded at the frames of the recordings."""
    import numpy as np

    from opsim.report.sections.motions import staged

    if people == "new":
        together = model.sample(n, rng)
        drawn = [(together[k], "a new person") for k in range(n)]
    else:
        names = [model.workers[i] for i in rng.permutation(len(model.workers))]
        drawn = [(model.sample(1, rng, worker=name), f"as {name}") for name in (names * n)[:n]]
    cards = []
    for performance, who in drawn:
        times_s = np.arange(max(round(float(performance.duration_s[0]) * rate_hz), 1) + 1) / rate_hz
        cards.append(Card(staged(performance.positions_m(times_s)[0], rate_hz, model.skeleton), False, who))
    return cards


def _notes(model: Any, motions: Any, real: list[Any], file: str, people: str) -> list[tuple[str, str]]:
    from opsim.task_model import behind

    report = model.report
    drawn = "new people, each another, as a simulation draws them" if people == "new" else "the people of the fit"
    notes = [
        ("Emulated", f"{model.task} of {behind(report.source, report.n_sequences, report.n_workers)}; {drawn}"),
        ("Fitted to", f"{report.source} ({report.where}){' by ' + report.command if report.command else ''}"),
        ("Recorded", f"{Path(file).name}, task {motions.task} ({motions.selection}): {motions.source}"),
        ("Seen in the fit", seen(report, real, file)),
        ("Licences", f"recordings: {motions.licence}; library: {report.licence}"),
    ]
    return notes


def seen(report: Any, real: list[Any], file: str) -> str:
    """In words, how many of the recorded performances ``real`` the fit behind ``report`` was trained on.

    It is known where the library names this file, and where its choice gives as many repetitions of it as were fitted.
    """
    from emulator import read_motions
    from emulator.recordings.selection import WhereError

    everything = read_motions(file, where=None).motions
    unknown = "not known: the library does not say which repetitions it was fitted to; these may be among them"
    if f" {Path(file).name} " not in f" {report.command} ":
        return unknown
    try:
        fitted, shown = (_chosen_by(report.where, some) for some in (everything, real))
    except WhereError:
        return unknown
    if fitted != report.n_sequences:
        return unknown
    return f"{shown or 'none'} of the {len(real)} recorded performances" + ("" if shown else ": all are unseen")


def _chosen_by(where: str, motions: Any) -> int:
    """How many of the motions fulfil ``where``, a report's choice of repetitions. Raises WhereError."""
    from emulator.motion import table_of
    from emulator.recordings.selection import rows_where

    return len(motions) if where == "all" else int(rows_where(where, table_of(motions)).sum())
