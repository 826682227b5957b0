"""One table for a class of recordings: schemes and two controls, judged on repetitions that they have not seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.judge.drawers import COPIER, RECORDED, SHAKER, USUAL, drawer, unknown_names
from emulator.judge.halves import N_TIMES, in_halves, too_few
from emulator.judge.held_out_figures import N_DRAWN, Unseen, figures, recorded_figures
from emulator.judge.held_out_meaning import MIDDLE, Figures
from emulator.motion import MotionSet
from emulator.sound import refuse_unsound

CONTROLS = (COPIER, SHAKER)
HONEST = 0.8
"""Novelty from here on is that of unseen recordings; a control that reaches it would mean blind judges."""
SPLITS_OF_A_SEED = 1000

Progress = Callable[[int, int, str], None] | None
Found = tuple[dict[str, Figures], dict[str, list[str]]]


@dataclass(frozen=True, eq=False)
class Judged:
    """What was found: for each split, name of the drawer -> its figures; the recordings come first, controls last.

    notes : which figures are missing, and why, in words
    """

    task: str
    splits: tuple[dict[str, Figures], ...]
    notes: tuple[str, ...]

    @property
    def rows(self) -> dict[str, Figures]:
        """Name -> figures over the splits that have them: means, and of p values the middle."""
        return {name: _over([split[name] for split in self.splits]) for name in self.splits[0]}

    @property
    def passing_controls(self) -> list[str]:
        """Controls that novelty does not see through: it then says nothing of the others."""
        return [name for name in CONTROLS if not self.rows[name].novelty < HONEST]


def judge_held_out(
    motions: MotionSet,
    names: Sequence[str] = USUAL,
    n_splits: int = 5,
    seed: int = 0,
    progress: Progress = None,
    *,
    n_times: int = N_TIMES,
    n_drawn: int = N_DRAWN,
) -> Judged:
    """Judge schemes (of ``drawers.KNOWN``) on halves of each person's repetitions, dealt out ``n_splits`` times.

    Split k of seed s is dealt out by the number 1000 s + k; a scheme's figures do not depend on the other schemes.
    progress : called with (done, total, label)
    n_times  : points of the common clock, from 21; n_drawn : sequences of each drawer
    Raises ValueError for unknown names, repetitions with mistakes, or too few of them. A scheme that cannot be fitted
    or drawn from has a note in place of its figures.
    """
    refuse(motions, names)
    asked = (*dict.fromkeys(names), *CONTROLS)
    step = _Steps(n_splits * (1 + len(asked)), motions.task, progress)
    first = SPLITS_OF_A_SEED * seed
    with threadpool_limits(1, user_api="blas"):
        halves = (in_halves(motions, number, n_times) for number in range(first, first + n_splits))
        found = [_split(Unseen.of(one, n_drawn), asked, step) for one in halves]
    return Judged(motions.task, tuple(split for split, _ in found), _notes([wrong for _, wrong in found]))


def refuse(motions: MotionSet, names: Sequence[str] = USUAL) -> None:
    """Raises ValueError with all that speaks against judging, before anything is done."""
    wrong = unknown_names(names) + too_few(motions)
    try:
        refuse_unsound(motions)
    except ValueError as error:
        wrong.append(str(error))
    if wrong:
        raise ValueError("\n".join(wrong))


class _Steps:
    """Counts what is done, aloud."""

    def __init__(self, total: int, label: str, progress: Progress) -> None:
        self.done, self.total, self.label, self.progress = 0, total, label, progress

    def __call__(self) -> None:
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, self.total, self.label)


def _split(unseen: Unseen, asked: Sequence[str], step: _Steps) -> Found:
    """The figures of each drawer, and what went wrong with it."""
    found = {RECORDED: recorded_figures(unseen)}
    wrong = {RECORDED: [f"limits, speeds and feet: {unseen.why}"] if unseen.why else []}
    step()
    for name in asked:
        try:
            found[name], wrong[name] = figures(unseen, drawer(name, unseen.halves))
        except ValueError as error:
            found[name], wrong[name] = Figures(), [str(error)]
        step()
    return found, wrong


def _notes(wrong: Sequence[dict[str, list[str]]]) -> tuple[str, ...]:
    """For each drawer that lacks something, why in the first of its splits, and in how many."""
    notes = []
    for name in wrong[0]:
        lacking = [split[name] for split in wrong if split[name]]
        if lacking:
            splits = f"in {len(lacking)} of {len(wrong)} splits" if len(wrong) > 1 else "missing"
            notes.append(f"{name}: {splits}: {'; '.join(dict.fromkeys(lacking[0]))}")
    return tuple(notes)


def _over(splits: Sequence[Figures]) -> Figures:
    return Figures(**{field.name: _one(field.name, splits) for field in fields(Figures)})


def _one(name: str, splits: Sequence[Figures]) -> float:
    values = np.array([getattr(split, name) for split in splits])
    known = values[~np.isnan(values)]
    if not len(known):
        return float("nan")
    return float(np.median(known) if name in MIDDLE else np.mean(known))
