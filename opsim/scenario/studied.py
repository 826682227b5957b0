"""What is wrong with the studies of a scenario, as far as it can be known without a run."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from opsim.problems import MOST_FOUND, Problem, ScenarioError
from opsim.scenario.changes_checked import change_problems
from opsim.scenario.positions import entries
from opsim.scenario.study_keys import STUDIES, StudyKeys
from opsim.scenario.varied import Varied

MOST_TRIED = 20
"""Variants for which the studies of a file are checked."""


def check_study(varied: Varied, verb: str | None = None) -> None:
    """Raises ScenarioError with all that is wrong with a variant and one of its studies, or all of them."""
    base = _wrong_as_it_is(varied)
    if problems := {*base, *_found(varied, verb, base)}:
        raise ScenarioError(sorted(problems))


def study_problems(file: str | Path, names: Sequence[str] | None = None) -> list[Problem]:
    """What is wrong with the studies of a file for each of its variants (or those named): a study may be meant for one
    of them. Empty where the file cannot be read, or its variants are not there, which ``read_scenarios`` says.
    """
    try:
        first = Varied.read(file)
        variants = [first.of(name) for name in names or first.siblings if name in first.siblings]
    except ScenarioError:
        return []
    everywhere: set[Problem] | None = None
    for varied in variants[:MOST_TRIED]:
        found = _found(varied, None, _wrong_as_it_is(varied))
        everywhere = found if everywhere is None else everywhere & found
        if not everywhere:
            break
    return sorted(everywhere or ())


def _wrong_as_it_is(varied: Varied) -> frozenset[Problem]:
    return frozenset(change_problems(varied, {}))


def _found(varied: Varied, verb: str | None, base: frozenset[Problem]) -> set[Problem]:
    """What is wrong with studies and not with the variant itself."""
    asked = {name: node for name, node in entries(varied.tree, STUDIES).items() if verb in (None, name)}
    study = StudyKeys(varied, base)
    found = (one for name, node in asked.items() for one in study.block(node, (STUDIES, name)))
    return set(islice(found, MOST_FOUND))
