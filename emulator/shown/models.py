"""Emulators and libraries in a notebook: what they were learned from, and what they say."""

from __future__ import annotations

from typing import Any

import numpy as np

from emulator.shown.html import bodies, count, sentence, table


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
