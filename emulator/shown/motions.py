"""Recorded motions in a notebook: whose, how many, how long, and the body."""

from __future__ import annotations

from typing import Any

import numpy as np

from emulator.shown.html import bodies, count, sentence, table


def motion_html(motion: Any) -> str:
    """A sentence, and the body at some moments."""
    words = f"{motion.name}: {motion.duration_s:.2f} s, {len(motion.time_s)} frames, {motion.skeleton.n_bones} bones."
    return sentence("Motion:", words) + bodies(
        motion.positions_m(), motion.skeleton.parents, f"{motion.name}, the body"
    )


def motion_set_html(motions: Any) -> str:
    """A sentence, whose motions they are, and the first of them."""
    marks = f" Marks: {', '.join(motions.mark_names)}." if motions.mark_names else ""
    source = f" {motions.source}" if motions.source else ""
    words = (
        f"{motions.task}: {count(len(motions), 'repetition')} of {count(len(motions.workers), 'worker')}, "
        f"{motions.duration_s.min():.2f} to {motions.duration_s.max():.2f} s.{marks}{source}"
    )
    first = motions.motions[0]
    picture = bodies(first.positions_m(), first.skeleton.parents, f"{first.name}, the body")
    durations, owner = motions.duration_s, motions.worker_index
    rows = [
        (
            worker,
            int(np.sum(owner == rank)),
            float(durations[owner == rank].mean()),
            float(durations[owner == rank].std()),
        )
        for rank, worker in enumerate(motions.workers)
    ]
    columns = ("worker", "repetitions", "mean s", "sd s")
    return sentence("MotionSet:", words) + picture + table(columns, rows)


def performances_html(drawn: Any) -> str:
    """A sentence, the first performance's body, and the times of the first ones."""
    n, task = len(drawn), drawn.model.task
    durations = np.asarray(drawn.duration_s)
    said = sentence("Performances:", f"{n} of {task}.")
    if not n:
        return said
    picture = bodies(drawn[0].positions_m(n_times=6)[0], drawn.skeleton.parents, f"{task}, the first one's body")
    names = tuple(f"{name} s" for name in getattr(drawn.model, "mark_names", ()))
    marks = np.asarray(drawn[:20].mark_s)
    names = names if len(names) == marks.shape[1] else tuple(f"mark {e} s" for e in range(marks.shape[1]))
    rows = [(k, float(durations[k]), *map(float, marks[k])) for k in range(min(n, 20))]
    more = sentence(f"and {n - len(rows)} more") if n > len(rows) else ""
    return said + picture + table(("k", "duration s", *names), rows) + more
