"""A subject of the floor that somebody else adds: its words, and what hangs into each layer; see ``Subject``.

It comes in by the entry-point group ``opsim.subjects``. The name of the entry point is its key in a scenario.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from opsim.kpi.catalogue import Figure, Kpi

GROUP = "opsim.subjects"
STATION, SCENARIO = "station", "scenario"
"""Where the key of a subject stands: in each station that has it, or at the top of the file."""


def nothing(*_given: Any) -> tuple[()]:
    """What hangs into a layer where a subject has nothing to do."""
    return ()


@dataclass(frozen=True)
class Subject:
    """What a subject has in each layer. ``said`` is its blocks by station, or its one block where it stands at the top.

    words    : a class of ``opsim.scenario.tree.Block``, whose fields say type, unit, bounds and help once: reading,
               messages, the JSON Schema and completion follow from it
    help     : what the key is for, in the schema; example : its block as text, or ""
    plan     : (said, scenario, ``opsim.plan.Ranks``) -> what the plan keeps of it: frozen, and of numbers
    install  : (``Build`` of the floor, what the plan keeps): hangs in, as in DESIGN.md, The form of a rule of the floor
    where    : ``STATION`` or ``SCENARIO``
    mistakes : (said, scenario) -> (path in the scenario, message, hint) of what no block alone can see
    tasks    : (said) -> tasks that take servers for it, by a name with a colon in it, each as a scenario would say it
    laws     : (log, plan, what the plan keeps) -> complaints, by the sentence of each law
    kpis     : the figures that it has, as the catalogue declares them
    figures  : (log, plan, what the plan keeps) -> their values, see ``opsim.kpi.catalogue.figure``
    assumptions : (plan, what the plan keeps) -> (topic, what is assumed), lines of the assumption sheet
    sections : each (``Material`` of the report, what the plan keeps) -> ``opsim.report.page.Section``, or None
    """

    words: type[Any]
    help: str
    plan: Callable[[Any, Any, Any], Any]
    install: Callable[[Any, Any], None]
    where: str = STATION
    example: str = ""
    mistakes: Callable[[Any, Any], Iterable[tuple[tuple[str, ...], str, str]]] = nothing
    tasks: Callable[[Any], Mapping[str, Mapping[str, Any]]] = lambda _said: {}
    laws: Mapping[str, Callable[[Any, Any, Any], Iterable[str]]] = field(default_factory=dict)
    kpis: tuple[Kpi, ...] = ()
    figures: Callable[[Any, Any, Any], Iterable[Figure]] = nothing
    assumptions: Callable[[Any, Any], Iterable[tuple[str, str]]] = nothing
    sections: tuple[Callable[[Any, Any], Any], ...] = ()
