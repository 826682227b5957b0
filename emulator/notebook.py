"""Pieces of HTML for notebooks: every text escaped, no script. NOTE: opsim has its own, as neither asks the other.

Emulators and libraries in a notebook: what they were learned from, and what they say.

Recorded motions in a notebook: whose, how many, how long, and the body.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

MOST_ROWS = 20
WIDE, TALL = 480, 150
FIGURES = 6


def sentence(*words: str) -> str:
    """A paragraph."""
    return f"<p>{escape(' '.join(word for word in words if word))}</p>"


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], most: int = MOST_ROWS) -> str:
    """A table; of more than ``most`` rows the first, and how many follow."""
    listed = list(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in listed[:most])
    more = sentence(f"and {len(listed) - most} more") if len(listed) > most else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def count(n: int, word: str, words: str = "") -> str:
    """``1 worker``, ``2 workers``."""
    return f"{n} {word if n == 1 else words or word + 's'}"


def bodies(positions_m: np.ndarray, parents: Sequence[int], said: str) -> str:
    """Lines along the bones at some even moments, left to right, from the side. positions_m : (T, J, 3), z up"""
    moments = np.linspace(0, len(positions_m) - 1, min(FIGURES, len(positions_m))).round().astype(int)
    some = positions_m[moments] - positions_m[moments][:, :1] * [1, 1, 0]
    across = some[:, :, int(np.argmax(np.ptp(some[:, :, :2], axis=(0, 1))))]
    up = some[:, :, 2] - some[:, :, 2].min()
    scale = (TALL - 20) / max(float(up.max()), 1e-6)
    step = WIDE / len(moments)
    lines = [f'<path d="M0 {TALL - 10}H{WIDE}" stroke="#999"/>']
    for at in range(len(moments)):
        xs, ys = step * (at + 0.5) + scale * across[at], TALL - 10 - scale * up[at]
        bones = (
            f"M{xs[parent]:.1f} {ys[parent]:.1f}L{xs[joint]:.1f} {ys[joint]:.1f}"
            for joint, parent in enumerate(parents)
            if parent >= 0
        )
        lines.append(f'<path d="{"".join(bones)}" fill="none" stroke="#0072B2" stroke-width="2.5"/>')
    size = f'viewBox="0 0 {WIDE} {TALL}" width="{WIDE}" style="max-width:100%"'
    said = escape(said)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{said}">{"".join(lines)}</svg>'


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f'<td style="text-align:left">{escape(value)}</td>'
    missing = value is None or (isinstance(value, float) and not np.isfinite(value))
    text = "" if missing else f"{value:.4g}" if isinstance(value, float) else str(value)
    return f'<td style="text-align:right">{escape(text)}</td>'


def emulator_html(model: Any) -> str:
    """A sentence, a drawn body (always the same), and the report's figures that are numbers."""
    report = model.report
    words = f"{model.task}: {_learned(report)} {getattr(report, 'source', '')}"
    rows = [(name, value) for name, value in vars(report).items() if isinstance(value, float | int)]
    return sentence(f"{type(model).__name__}:", words) + _body(model) + table(("figure", "value"), rows)


def library_html(library: Any) -> str:
    """A sentence, the tasks, and once each where they come from."""
    rows = [_row(task, library[task]) for task in library]
    reports = [library[task].report for task in library]
    said = dict.fromkeys((str(getattr(one, "source", "")), str(getattr(one, "licence", ""))) for one in reports)
    behind = "".join(sentence(source, f"Licence: {licence}" if licence else "") for source, licence in said)
    columns = ("task", "kind", "repetitions", "people", "mean s")
    return sentence("MotionLibrary:", f"{count(len(library), 'task')}.") + table(columns, rows) + behind


def _row(task: str, model: Any) -> tuple[object, ...]:
    report = model.report
    return (
        task,
        type(model).__name__,
        getattr(report, "n_sequences", None),
        getattr(report, "n_workers", None),
        float(model.mean_duration_s()),
    )


def _learned(report: Any) -> str:
    n, people = getattr(report, "n_sequences", None), getattr(report, "n_workers", None)
    if n is None or people is None:
        return ""
    return f"learned from {count(n, 'repetition')} of {count(people, 'person', 'people')}."


def _body(model: Any) -> str:
    """A draw of a stream of its own: a notebook that shows a model changes no luck."""
    drawn = model.sample(1, np.random.default_rng(0))
    return bodies(drawn[0].positions_m(n_times=6)[0], drawn.skeleton.parents, f"{model.task}, a drawn body")


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
