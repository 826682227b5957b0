"""The language with the words of subjects that others have installed: the same models, with more keys.

It is asked for only where our own language is not enough, as for a key that it does not know.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from functools import cache
from typing import Any, get_args

from pydantic import Field, create_model

from opsim.plugins.registry import installed
from opsim.plugins.subjects import STATION, Subject
from opsim.problems import Problem
from opsim.scenario.fields import Name
from opsim.scenario.schema.scenario import Scenario as OurScenario
from opsim.scenario.tree import Node, child, problem
from opsim.subjects.stations.words import Station as OurStation


@cache
def scenario_model() -> type[OurScenario]:
    """``Scenario`` with the keys of all subjects that are installed; itself where none is. Raises PluginError."""
    if not installed():
        return OurScenario
    of_station, of_scenario = ({}, {})  # type: tuple[dict[str, Any], dict[str, Any]]
    for key, subject in installed().items():
        said = Field(None, description=subject.help, examples=[subject.example] if subject.example else None)
        (of_station if subject.where == STATION else of_scenario)[key] = (subject.words | None, said)
    station: Any = create_model("Station", __base__=OurStation, __module__=__name__, **of_station)
    of_scenario["stations"] = (dict[Name, station], copy(OurScenario.model_fields["stations"]))
    return create_model("Scenario", __base__=OurScenario, __module__=__name__, **of_scenario)


def __getattr__(name: str) -> Any:
    """The two classes by their names, for a pickle that has come from another process."""
    if name == "Scenario":
        return scenario_model()
    if name == "Station":
        return get_args(scenario_model().model_fields["stations"].annotation)[1]
    raise AttributeError(f"{__name__} has no {name!r}")


def subjects_said(scenario: Any) -> Iterator[tuple[str, Subject, Any]]:
    """(key, subject, its blocks by station or its one block) of each subject that a scenario has a word of."""
    if type(scenario).__base__ is not OurScenario:
        return
    for key, subject in installed().items():
        if subject.where == STATION:
            blocks = {name: getattr(station, key) for name, station in scenario.stations.items()}
            said: Any = {name: block for name, block in blocks.items() if block is not None}
        else:
            said = getattr(scenario, key)
        if said:
            yield key, subject, said


def subject_problems(scenario: Any, tree: Node) -> Iterator[Problem]:
    """What subjects find wrong with a scenario that the schema has read."""
    for _, subject, said in subjects_said(scenario):
        for path, message, hint in subject.mistakes(said, scenario):
            node = child(tree, *path)
            yield problem(tree.place if node is None else node.name_place, path, message, hint)
