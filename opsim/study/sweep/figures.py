"""Which figures a sweep tells: those that are asked for, or what the scenario puts in front."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.kpi.better import Asked, better_of, read_asked
from opsim.kpi.names import KPIS
from opsim.kpi.subjects import subject_of
from opsim.problems import did_you_mean
from opsim.results import Key
from opsim.study.no_figure import remedy

SECTIONS = {"worker": "workers", "station": "stations", "task": "tasks", "product": "products"}
MOST_BY_ITSELF = 6
"""Figures that a sweep chooses, where nobody does."""


def kept_of(figures: Sequence[str] | None, outputs: Sequence[str]) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    return tuple(dict.fromkeys(read_asked(text).kpi for text in figures)) if figures else tuple(dict.fromkeys(outputs))


def check_figures(figures: Sequence[str], scenario: Any) -> None:
    """Raises ValueError with everything that is wrong with the figures, before anything is run."""
    wrong = [words for text in figures if (words := _wrong(read_asked(text), scenario))]
    if wrong:
        raise ValueError("\n".join(wrong))


def chosen(figures: Sequence[str] | None, outputs: Sequence[str], keys: Sequence[Key]) -> list[tuple[Key, str]]:
    """The figures and which way of each is better. keys : of all that the replications have

    Raises ValueError where one that was asked for is in no replication.
    """
    if figures:
        return [_found(read_asked(text), keys) for text in figures]
    whole = [key for kpi in outputs for key in keys if key[0] == kpi and not key[1] and not key[2]]
    if not whole:
        raise ValueError("the scenario's outputs are of single things: name figures, such as --figure throughput_per_h")
    return [(key, better_of(key[0], key[2])) for key in whole[:MOST_BY_ITSELF]]


def _found(asked: Asked, keys: Sequence[Key]) -> tuple[Key, str]:
    for key in keys:
        if key[:3] == (asked.kpi, asked.subject, asked.part):
            return key, asked.better
    of = [Asked(*key[:3]).name for key in keys if key[0] == asked.kpi]
    if of:
        raise ValueError(f"no figure {asked.name!r}; {did_you_mean(asked.name, of, otherwise='there are')}")
    raise ValueError(f"no figure {asked.name!r}; {remedy(asked.kpi, {key[0] for key in keys})}")


def _wrong(asked: Asked, scenario: Any) -> str:
    """What is wrong with one figure; nothing where all is well."""
    if asked.kpi not in KPIS:
        return f"no figure {asked.kpi!r}; {did_you_mean(asked.kpi, KPIS)}"
    kind = subject_of(asked.kpi)
    names = list(getattr(scenario, SECTIONS.get(kind, ""), None) or ())
    if kind and not asked.subject:
        such = f", such as {asked.kpi}/{names[0]}" if names else f": {asked.kpi}/NAME"
        return "" if asked.part else f"{asked.kpi}: it is of each {kind}: say which{such}"
    if kind in SECTIONS and asked.subject and asked.subject not in (*names, "none"):
        return f"{asked.name}: no {kind} {asked.subject!r}; {did_you_mean(asked.subject, names)}"
    return ""
